#pragma once
#include <string>
#include <vector>

#include "renderer/compare/compare.h"
#include "renderer/report/picture_sink.h"
#include "renderer/results/report.h"

namespace sheer {

/// Makes the report, with status done and without id, from the runs of a comparison as they are finished.
class ReportMaker {
  public:
    /// Without `pictures` the report has none. `created_at` is UTC, RFC 3339. References and pointer must outlive it.
    ReportMaker(const Spec& spec, const Device& device, PictureSink* pictures, const std::string& created_at);
    void add(const Run& run);
    /// For compare(): whether the spec's checks on times are undecided in a run. Null if it has no such checks.
    UndecidedFunction undecided() const;
    /// Once, after the last run.
    report::Report finish();
    /// Instead, once, if not every point was rendered: the report of those that were. Its verdict is "failed", whatever
    /// its checks say, so that points which were not checked do not pass. `status` is failed or cancelled.
    report::Report finish_early(report::Status status, const std::string& title, const std::string& detail);
    std::size_t runs() const { return m_report.runs.size(); }

  private:
    const Spec& m_spec;
    bool m_software;
    PictureSink* m_pictures;
    report::Report m_report;
};

/// Sets a report's verdict and its reason by its checks and results. A result that could not be rendered is a failure,
/// whether or not a check needs it.
void judge(report::Report& report);

/// For a gate: without any checks, adds one that fails, and judges the report again.
void require_checks(report::Report& report);

/// The command line's options for rendering on this device again, preceded by a space; "" if it has no name.
std::string context_arguments(const Device& device);

/// The names, up to the first ".", of the pictures that the report of this spec will have.
std::vector<std::string> picture_stems(const Spec& spec);

/// A table for the terminal, with a line for each method.
std::string report_table(const report::Report& report);
/// JUnit XML: a test case for each check and one for the rendering of each method. A report that is not done gives one
/// with an <error>; it needs only `status`, `error`, and the title in its spec. The text is well-formed whatever
/// titles, labels and reasons contain.
std::string report_junit(const report::Report& report);

}  // namespace sheer
