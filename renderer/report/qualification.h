#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/results/report.h"

namespace sheer {

/// How far the verdicts on times can be trusted on a device: how often a change of nothing is called a change, and
/// which slowdowns are found. One method is drawn many times in one report: with the same shading, and with shadings
/// that do a known share more work. Many such reports are counted.

/// The spec of one of these reports, for a picture of `size_px` squared. Its method has its own shading, a loop.
nlohmann::json qualification_spec(int size_px, int rounds);

class QualificationTally {
  public:
    /// Counts the verdicts of a report of qualification_spec().
    void add(const report::Report& report);
    int reports() const { return m_reports; }
    /// `at` is UTC, RFC 3339. Throws std::runtime_error without any reports.
    report::Qualification result(const std::string& at) const;

  private:
    struct Count {
        int trials = 0, found = 0;
        std::vector<double> slowdowns;  ///< of the single reports
    };

    int m_reports = 0;
    Count m_same;
    std::vector<std::pair<double, Count>> m_slower;  ///< by the share of more work, the smallest first
    std::optional<report::Device> m_device;
};

/// The limits within which the true rate lies with 95 %, if `found` of `trials` were found (Wilson 1927).
report::Interval wilson_interval(int found, int trials);

/// A table for the terminal.
std::string qualification_table(const report::Qualification& qualification);

/// Where qualifications are kept: in $SHEER_STATE, which a service sets to its data folder, or in the user's state
/// folder of the XDG specification. Empty if there is neither.
std::filesystem::path qualifications_file();

/// The last qualification of this device, or nothing; also if the file cannot be read.
std::optional<report::Qualification> last_qualification(const std::filesystem::path& file,
                                                        const report::Device& device);
/// Replaces that of the same device. Throws std::runtime_error, WriteError.
void keep_qualification(const std::filesystem::path& file, const report::Qualification& qualification);

}  // namespace sheer
