#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/compare.h"
#include "renderer/report/picture_sink.h"
#include "renderer/sha256.h"

namespace sheer {

/// Makes the report of contract.md, status "done", without id, from the runs of a comparison as they come.
class ReportMaker {
  public:
    /// Without `pictures` the report has none. `created_at` is UTC, RFC 3339. References and pointer outlive it.
    ReportMaker(const Spec& spec, const Device& device, PictureSink* pictures, const std::string& created_at);
    void add(const Run& run);
    /// Once, after the last run.
    nlohmann::json finish();
    /// Instead, once, where not every point was rendered: the report of those that were. Its verdict is "failed",
    /// whatever its checks say, lest what was not looked at passes. `status` is "failed" or "cancelled".
    nlohmann::json finish_early(const std::string& status, const std::string& title, const std::string& detail);
    std::size_t runs() const { return m_report["runs"].size(); }

  private:
    const Spec& m_spec;
    bool m_software;
    PictureSink* m_pictures;
    nlohmann::json m_report;
};

/// What the command line needs to render on this device again, with a space before it; "" where it has no name.
std::string context_arguments(const Device& device);

/// What the names of the pictures begin with that the report of this spec will have, up to the first ".".
std::vector<std::string> picture_stems(const Spec& spec);

/// A table for the terminal: a line a method.
std::string report_table(const nlohmann::json& report);
/// JUnit XML: a test case for each check and one for the rendering of each method. A report that is not done has one
/// with an <error>; it need not have more than `status`, `error`, and the title in its spec. The text is well-formed
/// whatever stands in titles, labels and reasons.
std::string report_junit(const nlohmann::json& report);

/// Now in UTC, RFC 3339 with milliseconds.
std::string utc_now();

}  // namespace sheer
