#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace sheer {

/// "model name" of /proc/cpuinfo, "unknown" where there is none.
std::string cpu_name();

/// The driver's name and version, which follow the version of OpenGL in GL_VERSION ("4.5 (Core Profile) Mesa 22.3.6"
/// gives "Mesa 22.3.6"). "" where nothing follows.
std::string driver_of(const std::string& gl_version);

/// {"governor": "performance"}: what sets the clock of the CPUs, several joined by ", ". Where `cpus` does not say,
/// {"governor": null, "governor_reason": "..."}.
nlohmann::json governor(const std::filesystem::path& cpus = "/sys/devices/system/cpu");

/// [1.5, 1.2, 0.9]: mean numbers of runnable processes over the last 1, 5 and 15 minutes. Null where `file` does not
/// say.
nlohmann::json load_average(const std::filesystem::path& file = "/proc/loadavg");

/// What the numbers of the pictures mean: which values are blended, and what each metric takes them for.
nlohmann::json color_space();

}  // namespace sheer
