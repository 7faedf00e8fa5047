#include "server/http/body_cache.h"

namespace sheer::http {

BodyCache::KeptPtr BodyCache::find(const std::string& key) {
    const std::lock_guard lock(m_mutex);
    const auto found = m_by_key.find(key);
    if (found == m_by_key.end()) return nullptr;
    m_entries.splice(m_entries.begin(), m_entries, found->second);
    return found->second->kept;
}

void BodyCache::keep(const std::string& key, Kept kept) {
    const std::size_t bytes = kept.body.size();
    if (bytes > m_max_bytes) return;
    auto entry = std::make_shared<const Kept>(std::move(kept));
    const std::lock_guard lock(m_mutex);
    if (const auto known = m_by_key.find(key); known != m_by_key.end()) forget(known->second);
    m_entries.push_front({key, std::move(entry)});
    m_by_key[key] = m_entries.begin();
    for (m_bytes += bytes; m_bytes > m_max_bytes;) forget(std::prev(m_entries.end()));
}

void BodyCache::forget(std::list<Entry>::iterator entry) {
    m_bytes -= entry->kept->body.size();
    m_by_key.erase(entry->key);
    m_entries.erase(entry);
}

}  // namespace sheer::http
