// A whole job as the service runs it, and the share of it that is not rendering.
#include <benchmark/benchmark.h>

#include <chrono>

#include "../render/render_test.h"
#include "../unit/temporary_folder.h"
#include "renderer/compare/compare.h"
#include "renderer/core/clock.h"
#include "renderer/core/sha256.h"
#include "renderer/params/json_text.h"
#include "renderer/pictures/blob_sink.h"
#include "renderer/report/report.h"
#include "server/archive/sqlite_store.h"
#include "server/worker/report_folder.h"

namespace sheer::test {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds up the times for which it runs.
class Stopwatch {
  public:
    void run(bool on) {
        const auto now = Clock::now();
        if (m_on) m_sum_s += std::chrono::duration<double>(now - m_since).count();
        m_since = now;
        m_on = on;
    }
    double sum_s() const { return m_sum_s; }

  private:
    Clock::time_point m_since;
    bool m_on = false;
    double m_sum_s = 0;
};

/// Four methods at 384x384 that are timed for `range` seconds, up to the committed report.
void job(benchmark::State& state) {
    for (auto _ : state) {
        const TemporaryFolder folder;
        SqliteStore store(folder.path() / "data", {}, system_now_ms);
        const auto begin = Clock::now();
        Stopwatch rendering;
        const Spec spec = parse_spec(
            {{"scene", {{"type", "quads"}, {"distribution", "random"}, {"count", 256}, {"shading", "4x4-textures"}}},
             {"image", {{"width", 384}, {"height", 384}}},
             {"methods", {"b2f", "f2b", "f2bd", "f2bx"}},
             {"timing", {{"warmup", 1}, {"rounds", 1000}, {"max_seconds", state.range(0)}}}});
        store.queue().submit({.id = "1",
                              .spec = spec.canonical_text(),
                              .spec_sha256 = sha256_hex(spec.canonical_text()),
                              .idempotency = {}},
                             {1});
        const auto lease = store.queue().lease("bench");
        rendering.run(true);
        const auto context = make_context("egl");
        rendering.run(false);
        NoAssets assets;
        std::filesystem::create_directory(folder.path() / "out");
        ContentSink sink(folder.path() / "out", "/pictures");
        ReportMaker maker(spec, describe_device(*context), &sink, utc_now());
        compare(
            spec, *context, assets,
            [&](double, const std::string& stage) { rendering.run(!stage.starts_with("measuring")); },
            [&](const sheer::Run& run) {
                rendering.run(false);
                maker.add(run);
            });
        std::ofstream(folder.path() / "out" / "report.json") << json_line(to_document(maker.finish()));
        store.queue().commit(*lease, read_report_folder(folder.path() / "out", *lease, system_now_ms()));
        const double all_s = std::chrono::duration<double>(Clock::now() - begin).count();
        state.counters["not_rendering_percent"] = 100 * (all_s - rendering.sum_s()) / all_s;
    }
}

BENCHMARK(job)->Arg(3)->Iterations(1)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sheer::test
