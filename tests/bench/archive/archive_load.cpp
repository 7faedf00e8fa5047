// Fills an archive through its own interface and measures how quickly it is searched. docs/results/store.md has its
// figures.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <random>
#include <thread>
#include <vector>

#include "renderer/core/clock.h"
#include "renderer/core/sha256.h"
#include "server/archive/sqlite_store.h"
#include "server/jobs/report_id.h"
#include "server/jobs/retention.h"

namespace sheer {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr const char* scenes[] = {"layers", "quads", "particles", "foliage", "volume", "gltf"};
constexpr const char* methods[] = {"b2f",   "f2b",   "f2bd", "f2bx",       "f2bh",
                                   "wboit", "mboit", "mlab", "stochastic", "unsorted"};
constexpr const char* devices[] = {"llvmpipe (LLVM 15.0.6, 256 bits)", "NVIDIA H100 80GB HBM3/PCIe/SSE2",
                                   "AMD Radeon PRO W7900 (radeonsi, navi31)", "Mesa Intel(R) Arc(tm) A770 Graphics"};
constexpr const char* verdicts[] = {"passed", "passed", "passed", "failed", "undecided", "none"};
constexpr int specs = 500, branches = 40;
constexpr std::int64_t minutes_apart_ms = 5 * 60'000;

double since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// What this thread has used, which other work on the machine changes less than the time that passes.
double processor_ms() {
    timespec used{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return static_cast<double>(used.tv_sec) * 1000 + static_cast<double>(used.tv_nsec) / 1e6;
}

class Load {
  public:
    explicit Load(const std::filesystem::path& data)
        : m_store(data, {}, [this] { return m_now_ms; }), m_ids([this] { return m_now_ms; }) {}

    void fill(int count) {
        const auto there = m_store.reports().list({.limit = 1}).count;
        const auto begin = Clock::now();
        for (auto i = static_cast<int>(there); i < count; ++i) add(i);
        if (there < count)
            fmt::print("{} reports made in {:.0f} s, {:.1f} ms each\n", count - there, since(begin),
                       since(begin) * 1000 / static_cast<double>(count - there));
        const StoreSize size = m_store.care().size();
        fmt::print("{} reports, database {:.0f} MB\n", size.reports, static_cast<double>(size.database_bytes) / 1e6);
    }

    void measure(int rounds) {
        fmt::print("\n| request | p50 ms | p99 ms | processor: p50 | p99 | count |\n|---|---|---|---|---|---|\n");
        for (const auto& [name, filter] : filters())
            measure_one(name, rounds, [&, &each = filter] { return list(each); });
        measure_one("get", rounds, [&] { return get(); });
    }

    void measure_beside_searches(int rounds) {
        std::atomic<bool> stop = false;
        std::vector<std::thread> searches;
        const auto all = filters();
        for (std::size_t i = 0; i < 4; ++i)
            searches.emplace_back([&, i] {
                for (std::size_t at = i; !stop; ++at) m_store.reports().list(all[at % all.size()].second);
            });
        fmt::print("\nBeside four searches without a pause:\n");
        measure(rounds);
        stop = true;
        for (std::thread& search : searches) search.join();
    }

    void care() {
        auto begin = Clock::now();
        const auto reports = m_store.care().stored_reports();
        const auto pruned =
            reports_to_prune(reports, {{.max_reports = static_cast<std::int64_t>(reports.size()) - 1000}}, m_now_ms);
        fmt::print("\nretention of {} reports decided in {:.2f} s", reports.size(), since(begin));
        begin = Clock::now();
        for (const PrunedReport& report : pruned) m_store.reports().remove(report.id);
        fmt::print(", {} removed in {:.1f} s\n", pruned.size(), since(begin));
        begin = Clock::now();
        m_store.care().collect_garbage();
        fmt::print("gc in {:.1f} s\n", since(begin));
        begin = Clock::now();
        const CheckResult check = m_store.care().check(false);
        fmt::print("fsck in {:.1f} s, {} findings\n", since(begin), check.findings.size());
    }

  private:
    std::size_t below(std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(m_random); }
    template <std::size_t count>
    std::string one_of(const char* const (&texts)[count]) {
        return texts[below(count)];
    }

    json spec_of(int i) {
        json chosen = json::array();
        for (std::size_t j = 0, first = below(std::size(methods)); j < 4; ++j)
            chosen.push_back({{"id", methods[(first + j) % std::size(methods)]}});
        return {{"title", fmt::format("Nightly {} of team {}", one_of(scenes), below(30))},
                {"scene", {{"type", one_of(scenes)}, {"seed", i % specs}}},
                {"methods", chosen},
                {"tags",
                 {{"branch", fmt::format("branch-{}", below(branches))},
                  {"commit", sha256_hex(std::to_string(i / 3)).substr(0, 12)}}}};
    }

    /// 16 KB, as of five methods at four points.
    json report_of(const std::string& id) {
        json runs = json::array();
        for (int run = 0; run < 4; ++run) {
            json results = json::array();
            for (int result = 0; result < 5; ++result) {
                json samples = json::array();
                for (int sample = 0; sample < 30; ++sample)
                    samples.push_back(static_cast<double>(below(1'000'000)) / 9973);
                results.push_back({{"method", methods[result]},
                                   {"status", "ok"},
                                   {"timing", {{"samples", samples}, {"median", samples[0]}}}});
            }
            runs.push_back({{"results", results}});
        }
        return {{"id", id}, {"verdict", one_of(verdicts)}, {"device", {{"renderer", one_of(devices)}}}, {"runs", runs}};
    }

    void add(int i) {
        m_now_ms += minutes_apart_ms;
        NewReport report{.id = m_ids.next(), .spec = spec_of(i).dump()};
        report.spec_sha256 = sha256_hex(std::to_string(i % specs));
        m_store.queue().submit(report, {10});
        const auto lease = m_store.queue().lease("load");
        m_store.queue().commit(*lease, {.report = report_of(lease->id), .finished_ms = m_now_ms + 60'000});
    }

    static std::vector<std::pair<std::string, ListFilter>> filters() {
        const std::int64_t middle_ms = 1'700'000'000'000 + 50'000 * minutes_apart_ms;
        const std::string device = "nvidia", hash = sha256_hex("7");
        return {{"list", {}},
                {"page 500", {.until_ms = middle_ms}},
                {"q, in every report", {.q = "nightly"}},
                {"q, a letter", {.q = "n"}},
                {"q, one in 30", {.q = "team 17"}},
                {"q, a commit", {.q = sha256_hex("777").substr(0, 12)}},
                {"q, nothing", {.q = "nightly nothing"}},
                {"tag", {.tags = {"branch:branch-7"}}},
                {"tag, any value", {.tags = {"branch"}}},
                {"method", {.methods = {"wboit"}}},
                {"scene", {.scene = "volume"}},
                {"device", {.device = device}},
                {"verdict", {.verdict = "failed"}},
                {"spec", {.spec_sha256 = hash}},
                {"status", {.status = Status::done}},
                {"status, none", {.status = Status::running}},
                {"since, until", {.since_ms = middle_ms, .until_ms = middle_ms + 1000 * minutes_apart_ms}},
                {"method, method", {.methods = {"wboit", "mlab"}}},
                {"method, method never together", {.methods = {"b2f", "mboit"}}},
                {"method, scene", {.methods = {"wboit"}, .scene = "volume"}},
                {"device, verdict", {.device = device, .verdict = "failed"}},
                {"q, method", {.q = "nightly", .methods = {"wboit"}}},
                {"q, device, verdict", {.q = "nightly vol", .device = device, .verdict = "failed"}},
                {"all",
                 {.q = "nightly",
                  .tags = {"branch:branch-7"},
                  .methods = {"wboit"},
                  .scene = "volume",
                  .device = device,
                  .verdict = "passed",
                  .status = Status::done,
                  .since_ms = 0,
                  .until_ms = middle_ms * 2}},
                {"nothing", {.tags = {"branch:none"}}}};
    }

    std::string list(const ListFilter& filter) {
        const ReportPage page = m_store.reports().list(filter);
        return fmt::format("{}{}", page.count_is_exact ? "" : "more than ", page.count);
    }

    std::string get() {
        const ReportPage page = m_store.reports().list(
            {.until_ms = 1'700'000'000'000 + static_cast<std::int64_t>(below(99'000)) * minutes_apart_ms, .limit = 1});
        if (!page.reports.empty()) m_store.reports().find(page.reports[0].id);
        return "1";
    }

    static void measure_one(const std::string& name, int rounds, const std::function<std::string()>& request) {
        std::vector<double> times, used;
        std::string answer;
        for (int round = 0; round < rounds; ++round) {
            const auto begin = Clock::now();
            const double used_before_ms = processor_ms();
            answer = request();
            used.push_back(processor_ms() - used_before_ms);
            times.push_back(since(begin) * 1000);
        }
        const auto at = [](std::vector<double>& all, double fraction) {
            std::ranges::sort(all);
            return all[static_cast<std::size_t>(fraction * static_cast<double>(all.size() - 1))];
        };
        fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {} |\n", name, at(times, 0.5), at(times, 0.99),
                   at(used, 0.5), at(used, 0.99), answer);
        std::fflush(stdout);
    }

    std::int64_t m_now_ms = 1'700'000'000'000;
    std::mt19937_64 m_random{1};
    SqliteStore m_store;
    ReportIds m_ids;
};

}  // namespace
}  // namespace sheer

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr, "archive_load FOLDER REPORTS [ROUNDS [care]]\n");
        return 2;
    }
    sheer::Load load(argv[1]);
    const int rounds = argc > 3 ? std::atoi(argv[3]) : 200;
    load.fill(std::atoi(argv[2]));
    load.measure(rounds);
    load.measure_beside_searches(rounds);
    if (argc > 4) load.care();
}
