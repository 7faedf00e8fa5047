#pragma once
#include <map>
#include <string>

#include "server/http/limits.h"

namespace sheer::http {

/// Counts the answers that last: streams of events, and requests that wait for a report. Each holds a connection for as
/// long as its client likes, so one client gets some only, and all together leave connections for others.
class LastingAnswers {
  public:
    explicit LastingAnswers(const Limits& limits);
    /// Whether one more may begin for this client; `end` must follow if so.
    bool begin(const std::string& client);
    void end(const std::string& client);

  private:
    int m_max, m_max_per_client;
    int m_count = 0;
    std::map<std::string, int> m_by_client;
};

/// The count of an answer that lasts, if it may.
class Lasting {
  public:
    Lasting(LastingAnswers& answers, const std::string& client)
        : m_answers(answers), m_client(client), m_granted(answers.begin(client)) {}
    Lasting(const Lasting&) = delete;
    Lasting& operator=(const Lasting&) = delete;
    ~Lasting() {
        if (m_granted) m_answers.end(m_client);
    }
    bool is_granted() const { return m_granted; }

  private:
    LastingAnswers& m_answers;
    std::string m_client;
    bool m_granted;
};

}  // namespace sheer::http
