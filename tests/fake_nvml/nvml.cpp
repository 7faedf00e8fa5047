// Takes the place of NVIDIA's management library: a GPU named $FAKE_NVML_NAME whose clock is lowered by heat at every
// $FAKE_NVML_LOWERED_EVERY-th reading, never if that is 0.
#include <cstdio>
#include <cstdlib>

namespace {

int g_readings = 0;

int lowered_every() {
    const char* text = std::getenv("FAKE_NVML_LOWERED_EVERY");
    return text == nullptr ? 0 : std::atoi(text);
}

}  // namespace

extern "C" {

int nvmlInit_v2() {
    return 0;
}

int nvmlShutdown() {
    return 0;
}

int nvmlDeviceGetCount_v2(unsigned* count) {
    *count = 1;
    return 0;
}

int nvmlDeviceGetHandleByIndex_v2(unsigned, void** device) {
    *device = &g_readings;
    return 0;
}

int nvmlDeviceGetName(void*, char* name, unsigned bytes) {
    const char* text = std::getenv("FAKE_NVML_NAME");
    std::snprintf(name, bytes, "%s", text == nullptr ? "" : text);
    return 0;
}

int nvmlDeviceGetClockInfo(void*, int, unsigned* mhz) {
    ++g_readings;
    *mhz = 1980;
    return 0;
}

int nvmlDeviceGetCurrentClocksThrottleReasons(void*, unsigned long long* reasons) {
    const int every = lowered_every();
    *reasons = every > 0 && g_readings % every == 0 ? 0x20 : 0x01;
    return 0;
}
}
