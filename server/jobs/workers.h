#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace sheer {

/// A worker as others see it.
struct SeenWorker {
    std::string name;
    std::string label;         ///< a spec's `device` asks for it
    std::string driver;        ///< the renderer of its device; empty until it is known
    std::int64_t seen_ms = 0;  ///< when it last gave a sign of life
    std::string job;           ///< id of the report that it renders; empty for none
};

/// The workers of a store, on all machines.
class Workers {
  public:
    virtual ~Workers() = default;
    /// A sign of life, now; `seen_ms` and `job` do not count. While a worker runs a job, its heartbeats are signs too.
    virtual void note(const SeenWorker& worker) = 0;
    /// Those that were seen within `age_ms`, by label and name.
    virtual std::vector<SeenWorker> list(std::int64_t age_ms) = 0;
};

}  // namespace sheer
