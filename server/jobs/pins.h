#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace sheer {

/// A report that somebody wants to keep.
struct Pin {
    std::string report_id;
    std::int64_t pinned_ms = 0;
    std::string by;      ///< may be empty
    std::string reason;  ///< may be empty
};

/// Pinned reports are neither deleted nor pruned.
class Pins {
  public:
    virtual ~Pins() = default;

    enum class Pinning { added, renewed, not_found, not_final };
    /// Pins a report that has ended, at the time of the store's clock; one that was pinned before gets the new text and
    /// time.
    virtual Pinning pin(const Pin& pin) = 0;
    virtual std::optional<Pin> find(const std::string& report_id) = 0;
    /// Returns whether it was pinned.
    virtual bool unpin(const std::string& report_id) = 0;
};

}  // namespace sheer
