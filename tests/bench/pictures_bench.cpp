// The cost of comparing and encoding pictures.
#include <benchmark/benchmark.h>

#include <cmath>

#include "../unit/metric_pictures.h"
#include "renderer/pictures/picture_file.h"

namespace sheer::test {
namespace {

struct Pair {
    explicit Pair(const benchmark::State& state)
        : reference(picture(int(state.range(0)), int(state.range(1)), busy)),
          test(picture(int(state.range(0)), int(state.range(1)), busy_distorted)) {}
    Image reference, test;
};

/// Reads each value of both pictures once: the lower bound of the cost of any metric.
void read_both(benchmark::State& state) {
    const Pair pair(state);
    for (auto _ : state) {
        float sum = 0;
        for (std::size_t i = 0; i < pair.test.rgba.size(); ++i)
            sum += std::abs(pair.reference.rgba[i] - pair.test.rgba[i]);
        benchmark::DoNotOptimize(sum);
    }
}

void metric(benchmark::State& state, const std::string& id) {
    const Pair pair(state);
    const ImagePair images(pair.reference, pair.test);
    const auto& metrics = all_metrics();
    const auto found = std::ranges::find(metrics, id, &MetricInfo::id);
    for (auto _ : state) benchmark::DoNotOptimize(found->compute(images));
}

void every_metric(benchmark::State& state) {
    const Pair pair(state);
    for (auto _ : state) benchmark::DoNotOptimize(compute_metrics(pair.reference, pair.test));
}

void png(benchmark::State& state) {
    const Image8 image = quantize(Pair(state).test);
    for (auto _ : state) benchmark::DoNotOptimize(encode_png(image));
}

void exr(benchmark::State& state) {
    const Image image = Pair(state).test;
    for (auto _ : state) benchmark::DoNotOptimize(encode_exr(image));
}

void sizes(benchmark::internal::Benchmark* benchmark) {
    benchmark->Args({512, 512})->Args({1920, 1080})->UseRealTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK(read_both)->Apply(sizes);
BENCHMARK_CAPTURE(metric, flip, std::string("flip"))->Apply(sizes);
BENCHMARK_CAPTURE(metric, ssim, std::string("ssim"))->Apply(sizes);
BENCHMARK(every_metric)->Apply(sizes);
BENCHMARK(png)->Apply(sizes);
BENCHMARK(exr)->Apply(sizes);

}  // namespace
}  // namespace sheer::test
