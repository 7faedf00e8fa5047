#pragma once
#include <memory>
#include <string>
#include <vector>

namespace sheer {

/// The clock of a GPU at some time.
struct ClockReading {
    unsigned sm_mhz = 0;                  ///< of its shader cores
    std::vector<std::string> lowered_by;  ///< why it is lower than it could be, such as "heat"; empty if it is not
};

/// The clock of one of NVIDIA's GPUs, from its management library NVML.
class GpuClock {
  public:
    virtual ~GpuClock() = default;
    /// Takes some tens of microseconds. Zero and no reasons if the library does not say.
    virtual ClockReading read() = 0;
};

/// Of the first GPU whose name is part of `renderer`, which is GL_RENDERER. Null if there is none, or no NVML.
std::unique_ptr<GpuClock> open_gpu_clock(const std::string& renderer);

}  // namespace sheer
