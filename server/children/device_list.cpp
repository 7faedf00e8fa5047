#include "server/children/device_list.h"

#include <fmt/format.h>

#include <stdexcept>

#include "renderer/core/exit_codes.h"
#include "server/process/run_child.h"

namespace sheer {

using nlohmann::json;

namespace {

/// Longer than the wait for one driver that hangs (gl::look_time_limit).
constexpr std::chrono::seconds time_limit{45};

}  // namespace

DeviceList::DeviceList(std::chrono::milliseconds keep, std::string program)
    : m_keep(keep), m_program(std::move(program)) {}

json DeviceList::get() {
    const std::lock_guard lock(m_mutex);
    const auto now = std::chrono::steady_clock::now();
    if (!m_known || now - m_known_since > m_keep) {
        m_known = ask();
        m_known_since = now;
    }
    return *m_known;
}

json DeviceList::ask() const {
    std::string text;
    ChildRun run;
    run.options.program = m_program;
    run.options.arguments = {"devices", "--json"};
    run.time_limit = time_limit;
    run.on_line = [&text](const std::string& line) { text += line + "\n"; };
    const ChildResult result = run_child(run);
    if (result.timed_out) throw std::runtime_error("sheer devices took too long");
    if (result.status.code != exit_ok)
        throw std::runtime_error(
            fmt::format("sheer devices ended with exit code {}, signal {}", result.status.code, result.status.signal));
    return json::parse(text);
}

}  // namespace sheer
