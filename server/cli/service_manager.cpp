#include "server/cli/service_manager.h"

#include <fmt/format.h>
#include <systemd/sd-daemon.h>
#include <time.h>

#include <cstdint>

namespace sheer::cli {

namespace {

// The children inherit the environment, but only this process speaks for the service.
constexpr int keep_environment = 0;

void tell_manager(const std::string& text) {
    sd_notify(keep_environment, text.c_str());
}

std::int64_t monotonic_us() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
}

}  // namespace

void ServiceManager::ready(const std::string& status) {
    tell_manager(fmt::format("READY=1\nSTATUS={}", status));
}

void ServiceManager::reloading(const std::function<void()>& work) {
    tell_manager(fmt::format("RELOADING=1\nMONOTONIC_USEC={}", monotonic_us()));
    work();
    tell_manager("READY=1");
}

void ServiceManager::stopping() {
    tell_manager("STOPPING=1");
}

std::chrono::milliseconds ServiceManager::watchdog_interval() {
    std::uint64_t interval_us = 0;
    if (sd_watchdog_enabled(keep_environment, &interval_us) <= 0) return {};
    return std::chrono::milliseconds(interval_us / 1000 / 2);
}

void ServiceManager::alive() {
    tell_manager("WATCHDOG=1");
}

}  // namespace sheer::cli
