// The cost of our parts of a frame besides drawing: sorting the primitives, resolving the lists.
#include <benchmark/benchmark.h>

#include "../render/render_test.h"

namespace sheer::test {
namespace {

Spec quads(int count, const std::string& shading) {
    return make_spec({{"type", "quads"}, {"distribution", "random"}, {"count", count}, {"shading", shading}},
                     {"b2f", {{"id", "exact"}, {"form", "lists"}}}, 256, "rgba32f");
}

/// Geometry to buffers: the three orders and the upload.
void sort_and_upload(benchmark::State& state) {
    const auto context = make_context("egl");
    NoAssets assets;
    const Spec spec = quads(int(state.range(0)), "constant");
    const Geometry geometry = build_geometry(spec.scene, spec.image, assets);
    for (auto _ : state) {
        const Scene scene(context->gl(), geometry, spec.scene);
        context->gl().Finish();
    }
}

/// The time of a frame, or of some of its passes.
void frame(benchmark::State& state, const std::string& method, const std::vector<std::string>& passes) {
    const auto context = make_context("egl");
    const Spec spec = quads(int(state.range(0)), "4x4-textures");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    const auto found = std::ranges::find(spec.methods, method, &MethodSpec::id);
    const auto instance = stage.make(*found);
    stage.frame(*instance);
    for (auto _ : state) {
        const gl::FrameSample sample = stage.frame(*instance, true);
        double sum_ms = 0;
        for (const gl::PassSample& pass : sample.passes)
            if (passes.empty() || std::ranges::find(passes, pass.name) != passes.end()) sum_ms += pass.gpu_ms;
        state.SetIterationTime(sum_ms / 1000);
    }
}

void counts(benchmark::internal::Benchmark* benchmark) {
    benchmark->Arg(64)->Arg(512)->Unit(benchmark::kMillisecond);
}

BENCHMARK(sort_and_upload)->Apply(counts)->Arg(16384)->UseRealTime();
BENCHMARK_CAPTURE(frame, b2f, "b2f", {})->Apply(counts)->UseManualTime();
BENCHMARK_CAPTURE(frame, exact, "exact", {})->Apply(counts)->UseManualTime();
BENCHMARK_CAPTURE(frame, list_resolve, "exact", {"resolve"})->Apply(counts)->UseManualTime();

}  // namespace
}  // namespace sheer::test
