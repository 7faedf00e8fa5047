#include "server/http/observer.h"

#include <fmt/format.h>
#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <random>
#include <tuple>

namespace sheer::http {

using nlohmann::json;
using Clock = std::chrono::steady_clock;
using Labels = std::map<std::string, std::string>;

namespace {

constexpr std::size_t longest_request_id = 100;
const std::vector<double> seconds_buckets = {0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30};

bool is_request_id(const std::string& text) {
    const auto is_allowed = [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.' || c == ':';
    };
    return !text.empty() && text.size() <= longest_request_id && std::ranges::all_of(text, is_allowed);
}

std::string new_request_id() {
    thread_local std::mt19937_64 random{std::random_device{}()};
    return fmt::format("{:016x}", random());
}

/// So that the lines of JSON have nothing else.
std::shared_ptr<spdlog::logger> json_logger() {
    auto logger = std::make_shared<spdlog::logger>("access", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    logger->set_pattern("%v");
    return logger;
}

void add_gauge(prometheus::Registry& registry, const std::string& name, const std::string& help, const Labels& labels,
               double value) {
    prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add(labels).Set(value);
}

void add_counter(prometheus::Registry& registry, const std::string& name, const std::string& help, const Labels& labels,
                 double value) {
    prometheus::BuildCounter().Name(name).Help(help).Register(registry).Add(labels).Increment(value);
}

/// What the store says at this moment.
void add_store(prometheus::Registry& registry, Store& store, std::int64_t now_ms) {
    const ActivityCounts counts = store.activity().counts();
    for (const auto& [status, reports] : counts.reports)
        add_gauge(registry, "sheer_reports", "Reports and jobs in the archive", {{"status", status}},
                  static_cast<double>(reports));
    const double age_s = counts.oldest_queued_ms ? static_cast<double>(now_ms - *counts.oldest_queued_ms) / 1000 : 0;
    add_gauge(registry, "sheer_queue_oldest_seconds", "How long the oldest queued job has been waiting", {}, age_s);
    for (const auto& [label, workers] : counts.workers)
        add_gauge(registry, "sheer_workers_busy", "Workers that run a job", {{"label", label}},
                  static_cast<double>(workers));
    for (const auto& [stage, seconds] : counts.stage_seconds)
        add_counter(registry, "sheer_job_seconds_total", "Seconds that jobs spent in a stage", {{"stage", stage}},
                    seconds);
    add_counter(registry, "sheer_leases_lost_total", "Jobs whose worker died or lost its lease", {},
                static_cast<double>(counts.lost_leases));
    const StoreSize size = store.care().size();
    const std::pair<const char*, std::uint64_t> parts[] = {
        {"database", size.database_bytes}, {"pictures", size.picture_bytes}, {"uploads", size.upload_bytes}};
    for (const auto& [part, bytes] : parts)
        add_gauge(registry, "sheer_archive_bytes", "Size of the archive", {{"part", part}}, static_cast<double>(bytes));
    const auto rendered_ms = store.readiness().last_rendered_ms();
    add_gauge(registry, "sheer_last_rendered_timestamp_seconds", "When a worker last rendered something", {},
              static_cast<double>(rendered_ms.value_or(0)) / 1000);
}

}  // namespace

struct Observer::Parts {
    /// What is counted of one kind of answers.
    struct Series {
        prometheus::Counter& requests;
        prometheus::Histogram& seconds;
    };

    Store* store;
    ClockMs clock;
    prometheus::Registry registry;
    prometheus::Family<prometheus::Counter>& requests =
        prometheus::BuildCounter().Name("sheer_http_requests_total").Help("Answered requests").Register(registry);
    prometheus::Family<prometheus::Histogram>& seconds =
        prometheus::BuildHistogram()
            .Name("sheer_http_request_seconds")
            .Help("Time until an answer is ready; requests that wait for a report are left out")
            .Register(registry);
    std::atomic<AccessLog> log = AccessLog::off;
    std::mutex mutex;  ///< guards known_series
    std::map<std::tuple<std::string, std::string, int>, Series, std::less<>> known_series;

    /// Looked up here, since a registry makes new ones to look them up.
    Series series(const std::string& route, const std::string& method, int status) {
        const std::lock_guard lock(mutex);
        const auto known = known_series.find(std::tie(route, method, status));
        if (known != known_series.end()) return known->second;
        const Series made{requests.Add({{"method", method}, {"route", route}, {"status", std::to_string(status)}}),
                          seconds.Add({{"route", route}}, seconds_buckets)};
        known_series.emplace(std::tuple(route, method, status), made);
        return made;
    }
    const std::shared_ptr<spdlog::logger> json_lines = json_logger();
};

/// A request without its body.
struct Observer::Observed {
    std::string id, method, target, route;
    Clock::time_point begin = Clock::now();
    bool is_waiting = false;
};

Observer::Observer(Store* store, ClockMs clock) : m_parts(std::make_unique<Parts>(store, std::move(clock))) {}
Observer::~Observer() = default;

void Observer::log(AccessLog log) {
    m_parts->log = log;
}

void Observer::ended(const Observed& observed, Response& response) {
    response.headers.set("X-Request-Id", observed.id);
    const double seconds = std::chrono::duration<double>(Clock::now() - observed.begin).count();
    const Parts::Series series = m_parts->series(observed.route, observed.method, response.status);
    series.requests.Increment();
    if (!observed.is_waiting) series.seconds.Observe(seconds);
    switch (m_parts->log.load()) {
        case AccessLog::off:
            break;
        case AccessLog::text:
            spdlog::info("{} {} {} {:.3f} s {}", observed.method, observed.target, response.status, seconds,
                         observed.id);
            break;
        case AccessLog::json_lines:
            m_parts->json_lines->info(json{
                {"time", utc_text(m_parts->clock())},
                {"request_id", observed.id},
                {"method", observed.method},
                {"target", observed.target},
                {"route", observed.route},
                {"status", response.status},
                {"seconds", seconds}}.dump(-1, ' ', true, json::error_handler_t::replace));
    }
}

Observer::Observed Observer::seen(const Application& application, const Request& request) {
    Observed observed{.id = request.headers.find("X-Request-Id").value_or(""),
                      .method = request.method,
                      .target = request.target,
                      .route = application.pattern_of(request.method, request.target)};
    // Otherwise a client could make up any number of series.
    if (observed.route.empty()) observed.method = observed.route = "other";
    if (!is_request_id(observed.id)) observed.id = new_request_id();
    return observed;
}

std::optional<Response> Observer::known(const Application& application, const Request& request) {
    const Observed observed = seen(application, request);
    std::optional<Response> response = application.known(request);
    if (response) ended(observed, *response);
    return response;
}

Answer Observer::answer(const Application& application, Request request) {
    Observed observed = seen(application, request);
    Answer answer = application.answer(std::move(request));
    if (auto* response = std::get_if<Response>(&answer)) ended(observed, *response);
    if (auto* stream = std::get_if<EventStream>(&answer)) ended(observed, stream->head);
    if (auto* waiting = std::get_if<Waiting>(&answer)) {
        observed.is_waiting = true;
        waiting->ready = [this, observed, ready = std::move(waiting->ready)] {
            auto response = ready();
            if (response) ended(observed, *response);
            return response;
        };
        waiting->otherwise = [this, observed, otherwise = std::move(waiting->otherwise)] {
            Response response = otherwise();
            ended(observed, response);
            return response;
        };
    }
    return answer;
}

std::string Observer::metrics() {
    const prometheus::TextSerializer serializer;
    std::string text = serializer.Serialize(m_parts->registry.Collect());
    if (m_parts->store == nullptr) return text;
    prometheus::Registry now;
    add_store(now, *m_parts->store, m_parts->clock());
    return text + serializer.Serialize(now.Collect());
}

}  // namespace sheer::http
