#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace sheer {

/// Whether a report that is requested now is likely to be rendered.
class Readiness {
  public:
    virtual ~Readiness() = default;
    /// Notes that a worker has just rendered something.
    virtual void note_rendered() = 0;
    virtual std::optional<std::int64_t> last_rendered_ms() = 0;
    /// Why no report could be stored at present, as a message; empty if there is room.
    virtual std::string lack_of_room() = 0;
};

}  // namespace sheer
