#include "server/children/shading_check.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "renderer/core/exit_codes.h"
#include "renderer/core/sha256.h"

namespace sheer {

std::string ShadingCheck::messages(const std::string& glsl) {
    const std::string key = sha256_hex(glsl);
    const auto known = [&]() -> std::optional<std::string> {
        const std::lock_guard lock(m_mutex);
        const auto found = std::ranges::find(m_known, key, &std::pair<std::string, std::string>::first);
        if (found == m_known.end()) return std::nullopt;
        m_known.splice(m_known.begin(), m_known, found);
        return found->second;
    };
    if (const auto answer = known()) return *answer;
    const std::unique_lock child(m_child, m_options.longest_wait);
    if (!child) return "";
    // Another request may have asked the same meanwhile.
    if (const auto answer = known()) return *answer;
    return compile(glsl, key);
}

std::size_t ShadingCheck::compiled() {
    const std::lock_guard lock(m_mutex);
    return m_compiled;
}

std::string ShadingCheck::compile(const std::string& glsl, const std::string& key) {
    {
        const std::lock_guard lock(m_mutex);
        ++m_compiled;
    }
    try {
        const ChildReply reply = ask_child({"check-shading"}, glsl, m_options.child);
        if (!reply.timed_out && reply.status.code == exit_ok) {
            const std::string answer = nlohmann::json::parse(reply.line).at("messages");
            remember(key, answer);
            return answer;
        }
        spdlog::warn("a shading could not be checked: {}{}", ending_text("check-shading", reply.status),
                     reply.timed_out ? ", as it took too long" : "");
    } catch (const std::exception& error) {
        spdlog::warn("a shading could not be checked: {}", error.what());
    }
    return "";
}

void ShadingCheck::remember(const std::string& key, const std::string& answer) {
    const std::lock_guard lock(m_mutex);
    m_known.emplace_front(key, answer);
    if (m_known.size() > m_options.kept) m_known.pop_back();
}

}  // namespace sheer
