#pragma once
#include <vector>

#include "renderer/errors.h"
#include "renderer/files/diff.h"

namespace sheer {

/// A field whose value is not the same in two reports.
struct Difference {
    std::string pointer;     ///< in the first report; in the second one where only that has it
    nlohmann::json a, b;     ///< null where it is absent
    bool is_in_both = true;  ///< else only one of the two has it
};

/// Fields of spec, device and provenance that differ, and files that the reports drew from, each as a whole entry of
/// `files`; methods are matched by label.
std::vector<Difference> report_differences(const nlohmann::json& a, const nlohmann::json& b);

/// Why these are no reports of one spec; empty if they are. A field that only one spec has, such as a parameter that is
/// newer than the other report, is no reason.
std::vector<FieldError> spec_conflicts(const nlohmann::json& a, const nlohmann::json& b,
                                       const std::vector<Difference>& differences);

/// Whether both were rendered by the same renderer on the same kind of processor.
bool is_same_device(const nlohmann::json& a, const nlohmann::json& b);

/// A run that both reports have.
struct RunPair {
    const nlohmann::json &a, &b;
    std::string baseline_a, baseline_b;
    bool same_device = true;
    std::size_t compared = 1;  ///< methods that ran in both
};

/// What became of the time of a method that ran in both; both results have `timing`.
nlohmann::json time_diff(const RunPair& run, const nlohmann::json& result_a, const nlohmann::json& result_b);

/// Holds pictures of two reports against each other.
class PictureDiff {
  public:
    /// References outlive it.
    PictureDiff(const DiffSide& a, const DiffSide& b, const DiffOptions& options)
        : m_a(a), m_b(b), m_sink(options.pictures), m_pixels_left(options.max_pixels) {}
    /// `a` and `b` are the `images` of one method in the two reports; `name` is for the file of the FLIP map.
    nlohmann::json compare(const nlohmann::json& a, const nlohmann::json& b, int width_px, int height_px,
                           const std::string& name);

  private:
    nlohmann::json examine(const nlohmann::json& a, const nlohmann::json& b, int width_px, int height_px,
                           const std::string& name);

    const DiffSide& m_a;
    const DiffSide& m_b;
    BlobSink* m_sink;
    std::uint64_t m_pixels_left;
};

}  // namespace sheer
