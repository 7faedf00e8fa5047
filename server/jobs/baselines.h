#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace sheer {

/// A report that somebody accepted as one with which others are compared.
struct AcceptedReport {
    std::string name;  ///< of the baseline
    std::string report_id;
    std::int64_t accepted_ms = 0;
    std::string by;      ///< who accepted it; may be empty
    std::string reason;  ///< why; may be empty
};

/// Named sets of accepted reports. A set may have several, of one device or of many. Nothing is ever added by itself.
class Baselines {
  public:
    virtual ~Baselines() = default;

    enum class Acceptance { added, renewed, not_found, not_done };
    /// Accepts a done report, at the time of the store's clock; one that was accepted before gets the new text and
    /// time.
    virtual Acceptance accept(const AcceptedReport& accepted) = 0;
    /// Those of the baseline `name`, or of all baselines if it is "": by name, and those accepted last first.
    virtual std::vector<AcceptedReport> list(const std::string& name) = 0;
    /// Forgets one report of a baseline, or all if `report_id` is "". Returns how many were forgotten. The reports
    /// themselves stay.
    virtual std::size_t forget(const std::string& name, const std::string& report_id) = 0;
};

}  // namespace sheer
