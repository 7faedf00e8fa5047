#pragma once
#include <functional>
#include <memory>
#include <string>

#include "renderer/core/clock.h"
#include "server/http/application.h"
#include "server/jobs/store.h"

namespace sheer::http {

enum class AccessLog { off, text, json_lines };

/// Looks at every request and its answer: gives it an id, counts it, logs it. Thread-safe.
class Observer {
  public:
    /// Without `store` the metrics have only requests.
    explicit Observer(Store* store, ClockMs clock = system_now_ms);
    Observer(const Observer&) = delete;
    Observer& operator=(const Observer&) = delete;
    ~Observer();

    /// The application's answer, with X-Request-Id: the request's, if it has 1 to 100 letters, digits and -_.:, or a
    /// new one.
    Answer answer(const Application& application, Request request);
    /// The same if the application knows it.
    std::optional<Response> known(const Application& application, const Request& request);
    /// Takes effect for the next request.
    void log(AccessLog log);
    /// In the text format of Prometheus. Throws StoreError.
    std::string metrics();

  private:
    struct Parts;
    struct Observed;
    static Observed seen(const Application& application, const Request& request);
    void ended(const Observed& observed, Response& response);

    std::unique_ptr<Parts> m_parts;
};

}  // namespace sheer::http
