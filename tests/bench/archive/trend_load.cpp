// How long a trend of 10,000 reports takes. docs/results/store.md has its figures.
#include <fmt/format.h>
#include <time.h>

#include <chrono>
#include <cmath>

#include "renderer/core/random.h"
#include "renderer/core/sha256.h"
#include "renderer/files/trend_values.h"
#include "server/archive/sqlite_store.h"
#include "server/http/application.h"
#include "server/http/service.h"

namespace sheer {
namespace {

using nlohmann::json;

constexpr std::int64_t hour_ms = 3'600'000;
const std::string renderer = "llvmpipe (LLVM 15.0.6, 256 bits)";

/// What this thread has used, which other work on the machine changes less than the time that passes.
double processor_s() {
    timespec used{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) / 1e9;
}

class TrendLoad {
  public:
    explicit TrendLoad(const std::filesystem::path& data) : m_store(data, {}, [this] { return m_now_ms; }) {}

    void fill(int count) {
        for (int i = static_cast<int>(m_store.reports().list({.limit = 1}).count); i < count; ++i) {
            m_now_ms += hour_ms;
            m_store.queue().submit({.id = m_ids.next(), .spec = m_spec, .spec_sha256 = sha256_hex(m_spec)}, {10});
            const auto lease = m_store.queue().lease("load");
            const TrendValues values = values_of(i);
            m_store.queue().commit(*lease, {.report = {{"id", lease->id}, {"device", {{"renderer", renderer}}}},
                                            .finished_ms = m_now_ms,
                                            .numbers = {trend_names_text(values), trend_numbers(values)}});
        }
    }

    void measure(int rounds) {
        http::Service service{.store = m_store, .ids = m_ids, .clock = [this] { return m_now_ms; }, .list_devices = {}};
        const http::Application application(http::make_guard(true, {}), http::make_router(service));
        for (const char* metric : {"timing.median", "flip.mean"})
            for (int round = 0; round < rounds; ++round) {
                http::Request request{.method = "GET", .headers = {}, .body = {}, .path_values = {}};
                request.target = fmt::format("/api/v1/trends?spec_sha256={}&metric={}", sha256_hex(m_spec), metric);
                request.headers.add("Host", "localhost");
                const auto begin = std::chrono::steady_clock::now();
                const double used_before_s = processor_s();
                const auto answer = std::get<http::Response>(application.answer(std::move(request)));
                const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
                const double used_s = processor_s() - used_before_s;
                const json trend = json::parse(std::get<std::string>(answer.body));
                fmt::print("{}: status {}, {} values, {} changes in {:.2f} s, {:.2f} s of a processor\n", metric,
                           answer.status, trend.value("values", json::array()).size(),
                           trend.value("change_points", json::array()).size(), time.count(), used_s);
            }
    }

  private:
    /// Five methods; the level of each number changes three times.
    TrendValues values_of(int i) {
        TrendValues all;
        const double level = 10 + i / 2500;
        for (const char* method : {"b2f", "f2b", "f2bd", "f2bx", "wboit"})
            for (const Quantity& quantity : all_quantities()) {
                const double value = level + 0.2 * m_random.unit();
                all.names.push_back({"{}", method, quantity.name});
                all.values.push_back({value, value - 0.1, value + 0.1});
            }
        return all;
    }

    std::int64_t m_now_ms = 1'700'000'000'000;
    const std::string m_spec = json{{"title", "followed"}, {"scene", {{"type", "quads"}}}}.dump();
    Random m_random{1};
    SqliteStore m_store;
    ReportIds m_ids{[this] { return m_now_ms; }};
};

}  // namespace
}  // namespace sheer

int main(int argc, char** argv) {
    if (argc != 3) {
        fmt::print(stderr, "trend_load FOLDER REPORTS\n");
        return 2;
    }
    sheer::TrendLoad load(argv[1]);
    load.fill(std::atoi(argv[2]));
    load.measure(5);
}
