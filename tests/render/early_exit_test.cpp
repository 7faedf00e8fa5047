// What methods that stop early shade where stopping is hard, and that they stop nowhere too early.
#include <gtest/gtest.h>

#include "renderer/compare/compare.h"
#include "tests/render/early_exit.h"
#include "tests/render/litmus_drawing.h"

namespace sheer::test::early_exit_test {

namespace {

using nlohmann::json;

constexpr double threshold = 0.01;

double greatest_error(const Image& image, const LitmusScene& scene) {
    const Compositor truth = scene.truth();
    double error = 0;
    for (int y = 0; y < litmus_size_px; ++y)
        for (int x = 0; x < litmus_size_px; ++x) {
            const Color expected = truth.pixel(x, y, over_by_depth);
            for (std::size_t i = 0; i < 3; ++i)
                error = std::max(error, std::abs(expected[i] - double{image.pixel(x, y)[i]}));
        }
    return error;
}

/// The fragments until less than the threshold is left, in double precision.
std::uint64_t needed_in(const LitmusScene& scene) {
    const Compositor truth = scene.truth();
    std::uint64_t needed = 0;
    for (int y = 0; y < litmus_size_px; ++y)
        for (int x = 0; x < litmus_size_px; ++x) {
            double transmittance = 1;
            for (const Fragment& fragment : truth.stack(x, y).fragments) {
                if (transmittance < threshold) break;
                ++needed;
                transmittance *= 1 - fragment.alpha;
            }
        }
    return needed;
}

class EarlyExitTest : public testing::TestWithParam<const MethodRow*> {};

TEST_P(EarlyExitTest, ShadesAsItsRowSays) {
    const MethodRow& row = *GetParam();
    const auto context = make_context("egl");
    const bool software = context->device().software;
    for (const EarlyExit& entry : row.early_exit) {
        ASSERT_EQ(entry.most_shaded.size(), early_exit_scenes().size());
        for (std::size_t i = 0; i < early_exit_scenes().size(); ++i) {
            const LitmusScene& scene = early_exit_scenes()[i].scene;
            SCOPED_TRACE(method_json(row, entry.parameters).dump() + " on " + scene.id);
            Spec spec = litmus_spec(scene, method_json(row, entry.parameters), PixelFormat::rgba32f);
            spec.timing.rounds = 1;
            NoAssets assets;
            sheer::Run run;
            compare(
                spec, *context, assets, [](double, const std::string&) {}, [&](const sheer::Run& only) { run = only; });
            const MethodResult& result = run.results.at(0);
            if (result.status == report::ResultStatus::unsupported) GTEST_SKIP() << result.reason;
            ASSERT_EQ(result.status, report::ResultStatus::ok) << result.reason;
            EXPECT_LE(greatest_error(result.image, scene), threshold + 1e-4);
            ASSERT_TRUE(result.fragments.shaded && result.fragments.needed);
            const std::uint64_t needed = needed_in(scene);
            EXPECT_EQ(result.fragments.needed->total(), needed);
            const std::uint64_t shaded = result.fragments.shaded->total();
            EXPECT_GE(shaded, needed);
            if (!software) continue;
            EXPECT_LE(static_cast<double>(shaded), entry.most_shaded[i] * static_cast<double>(needed) + 0.5);
        }
    }
}

std::vector<const MethodRow*> rows_that_stop() {
    std::vector<const MethodRow*> rows;
    for (const MethodRow& row : all_method_rows())
        if (!row.early_exit.empty()) rows.push_back(&row);
    return rows;
}

INSTANTIATE_TEST_SUITE_P(All, EarlyExitTest, testing::ValuesIn(rows_that_stop()),
                         [](const auto& row) { return row.param->id; });

TEST(EarlyExitRows, AreThoseOfTheMethodsThatStopAndHaveAPicture) {
    for (const MethodRow& row : all_method_rows()) {
        const MethodInfo& method = *find_method(row.id);
        const bool stops = !method.saturation_parameter.empty() && method.no_metrics_reason.empty();
        EXPECT_EQ(!row.early_exit.empty(), stops) << row.id << ": its row's early_exit";
    }
}

}  // namespace

}  // namespace sheer::test::early_exit_test
