#include "server/http/body_cache.h"

namespace sheer::http {

BodyCache::Body BodyCache::find(const std::string& key) {
    const std::lock_guard lock(m_mutex);
    const auto found = m_by_key.find(key);
    if (found == m_by_key.end()) return nullptr;
    m_entries.splice(m_entries.begin(), m_entries, found->second);
    return found->second->body;
}

void BodyCache::keep(const std::string& key, const std::string& body) {
    if (body.size() > m_max_bytes) return;
    auto copy = std::make_shared<const std::string>(body);
    const std::lock_guard lock(m_mutex);
    if (m_by_key.contains(key)) return;
    m_entries.push_front({key, std::move(copy)});
    m_by_key[key] = m_entries.begin();
    for (m_bytes += body.size(); m_bytes > m_max_bytes; m_entries.pop_back()) {
        m_bytes -= m_entries.back().body->size();
        m_by_key.erase(m_entries.back().key);
    }
}

}  // namespace sheer::http
