#include "server/http/lasting.h"

#include <algorithm>

namespace sheer::http {

LastingAnswers::LastingAnswers(const Limits& limits)
    : m_max(std::max(1, limits.max_connections * 3 / 4)), m_max_per_client(limits.max_streams_per_client) {}

bool LastingAnswers::begin(const std::string& client) {
    const auto known = m_by_client.find(client);
    if (m_count >= m_max || (known != m_by_client.end() && known->second >= m_max_per_client)) return false;
    ++m_count;
    ++m_by_client[client];
    return true;
}

void LastingAnswers::end(const std::string& client) {
    --m_count;
    if (--m_by_client[client] == 0) m_by_client.erase(client);
}

}  // namespace sheer::http
