#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <string>

namespace sheer::cli {

/// Tells systemd about the service, if it runs as a unit with Type=notify. Without systemd nothing happens.
class ServiceManager {
  public:
    /// It is ready; `status` is shown by systemctl.
    static void ready(const std::string& status);
    /// It reloads its configuration, and is ready again after `work`.
    static void reloading(const std::function<void()>& work);
    static void stopping();
    /// The watchdog of the unit, half of WatchdogSec; 0 for none. Call alive() so often.
    static std::chrono::milliseconds watchdog_interval();
    static void alive();
};

}  // namespace sheer::cli
