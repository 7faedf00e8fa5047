// NVML by dlopen, since it comes with the driver: https://docs.nvidia.com/deploy/nvml-api/. Its functions are declared
// here, as few machines have its header.
#include "renderer/compare/gpu_clock.h"

#include <dlfcn.h>

#include <array>
#include <utility>

namespace sheer {

namespace {

using NvmlDevice = void*;
constexpr int nvml_success = 0, nvml_clock_sm = 1;

/// nvmlClocksThrottleReason*: those that mean that frames take longer than they could.
constexpr std::array<std::pair<unsigned long long, const char*>, 5> lowering_reasons{{
    {0x04, "power limit"},
    {0x08, "hardware slowdown"},
    {0x20, "heat"},
    {0x40, "heat, by hardware"},
    {0x80, "power brake"},
}};

/// The loaded library. Functions that it lacks are null.
class Nvml {
  public:
    Nvml() : m_library(dlopen("libnvidia-ml.so.1", RTLD_NOW | RTLD_LOCAL)) {
        if (m_library == nullptr) return;
        find(m_init, "nvmlInit_v2");
        find(m_shutdown, "nvmlShutdown");
        find(m_count, "nvmlDeviceGetCount_v2");
        find(m_handle, "nvmlDeviceGetHandleByIndex_v2");
        find(m_name, "nvmlDeviceGetName");
        find(m_clock, "nvmlDeviceGetClockInfo");
        find(m_reasons, "nvmlDeviceGetCurrentClocksThrottleReasons");
        const bool is_complete = m_init && m_shutdown && m_count && m_handle && m_name && m_clock && m_reasons;
        m_is_ready = is_complete && m_init() == nvml_success;
    }
    Nvml(const Nvml&) = delete;
    Nvml& operator=(const Nvml&) = delete;
    ~Nvml() {
        if (m_is_ready) m_shutdown();
        if (m_library != nullptr) dlclose(m_library);
    }

    /// Null if no GPU's name is part of `renderer`.
    NvmlDevice device_in(const std::string& renderer) const {
        unsigned count = 0;
        if (!m_is_ready || m_count(&count) != nvml_success) return nullptr;
        for (unsigned index = 0; index < count; ++index) {
            NvmlDevice device = nullptr;
            std::array<char, 96> name{};
            if (m_handle(index, &device) == nvml_success && m_name(device, name.data(), name.size()) == nvml_success &&
                name[0] != '\0' && renderer.find(name.data()) != std::string::npos)
                return device;
        }
        return nullptr;
    }

    ClockReading read(NvmlDevice device) const {
        ClockReading reading;
        unsigned long long reasons = 0;
        if (m_clock(device, nvml_clock_sm, &reading.sm_mhz) != nvml_success) reading.sm_mhz = 0;
        if (m_reasons(device, &reasons) != nvml_success) return reading;
        for (const auto& [bit, reason] : lowering_reasons)
            if ((reasons & bit) != 0) reading.lowered_by.emplace_back(reason);
        return reading;
    }

  private:
    template <typename Function>
    void find(Function& function, const char* name) {
        function = reinterpret_cast<Function>(dlsym(m_library, name));
    }

    void* m_library;
    bool m_is_ready = false;
    int (*m_init)() = nullptr;
    int (*m_shutdown)() = nullptr;
    int (*m_count)(unsigned*) = nullptr;
    int (*m_handle)(unsigned, NvmlDevice*) = nullptr;
    int (*m_name)(NvmlDevice, char*, unsigned) = nullptr;
    int (*m_clock)(NvmlDevice, int, unsigned*) = nullptr;
    int (*m_reasons)(NvmlDevice, unsigned long long*) = nullptr;
};

class NvmlClock : public GpuClock {
  public:
    explicit NvmlClock(const std::string& renderer) : m_device(m_nvml.device_in(renderer)) {}
    bool is_there() const { return m_device != nullptr; }
    ClockReading read() override { return m_nvml.read(m_device); }

  private:
    Nvml m_nvml;
    NvmlDevice m_device;
};

}  // namespace

std::unique_ptr<GpuClock> open_gpu_clock(const std::string& renderer) {
    auto clock = std::make_unique<NvmlClock>(renderer);
    if (!clock->is_there()) return nullptr;
    return clock;
}

}  // namespace sheer
