#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "renderer/results/report.h"

namespace sheer {

/// "model name" of /proc/cpuinfo, or "unknown".
std::string cpu_name();

/// The driver's name and version, which follow the version of OpenGL in GL_VERSION ("4.5 (Core Profile) Mesa 22.3.6"
/// gives "Mesa 22.3.6"). "" if nothing follows.
std::string driver_of(const std::string& gl_version);

/// What controls the clock of the CPUs, such as "performance"; several are joined by ", ".
OrReason<std::string> governor(const std::filesystem::path& cpus = "/sys/devices/system/cpu");

/// Mean numbers of runnable processes over the last 1, 5 and 15 minutes. None if `file` does not have them.
std::optional<report::LoadAverage> load_average(const std::filesystem::path& file = "/proc/loadavg");

/// What the numbers of the pictures mean: which values are blended, and how each metric interprets them.
report::ColorSpace color_space();

}  // namespace sheer
