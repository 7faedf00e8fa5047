#pragma once
#include <map>
#include <string>

#include "server/http/limits.h"

namespace sheer::http {

/// Counts long-lived answers: streams of events, and requests that wait for a report. Each occupies a connection for as
/// long as its client likes, so each client gets only a few, and all together leave connections for others.
class LastingAnswers {
  public:
    explicit LastingAnswers(const Limits& limits);
    /// Whether one more may begin for this client; if so, `end` must follow.
    bool begin(const std::string& client);
    void end(const std::string& client);

  private:
    int m_max, m_max_per_client;
    int m_count = 0;
    std::map<std::string, int> m_by_client;
};

/// Counts a long-lived answer, if it is allowed.
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
