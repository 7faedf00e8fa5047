// The two references compared with each other, and with themselves under difficult conditions.
#include <gmock/gmock.h>

#include "renderer/core/errors.h"
#include "renderer/core/random.h"
#include "renderer/passes/overdraw.h"
#include "tests/render/formulas.h"
#include "tests/render/render_test.h"

namespace sheer::test::references_test {

namespace {

nlohmann::json quads(int count) {
    return {{"type", "quads"},
            {"count", count},
            {"shading", "4x4-textures-math"},
            {"texture", {{"image", "smoke"}, {"size", 64}}}};
}

/// Float roundings of some dozens of layers, in different orders of the same sums.
constexpr double float_tolerance = 2e-6;

TEST(References, AgreeOnQuads) {
    const auto context = make_context("egl");
    const Spec spec = make_spec(
        quads(120), {{{"id", "exact"}, {"form", "lists"}}, {{"id", "exact"}, {"form", "sorted"}}, "depth_peeling"}, 64,
        "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    const Image lists = stage.picture(spec.methods[0]);
    EXPECT_LE(greatest_difference(lists, stage.picture(spec.methods[1])), float_tolerance);
    EXPECT_LE(greatest_difference(lists, stage.picture(spec.methods[2])), float_tolerance);
}

double greatest_difference_to(const Compositor& compositor, const Image& image) {
    double greatest = 0;
    for (int y = 0; y < image.height_px; ++y)
        for (int x = 0; x < image.width_px; ++x) {
            const Color color = compositor.pixel(x, y, over_by_depth);
            for (std::size_t i = 0; i < 3; ++i)
                greatest = std::max(greatest, std::abs(color[i] - double{image.pixel(x, y)[i]}));
        }
    return greatest;
}

/// 60 rectangles, some opaque, all overlapping in the middle: three programs that share only the scene's code, and the
/// compositor of the tests, which shares nothing.
TEST(References, AgreeWithEachOtherAndWithDoublePrecision) {
    constexpr int size_px = 32;
    Random random(5);
    nlohmann::json layers = nlohmann::json::array();
    for (int i = 0; i < 60; ++i) {
        const auto edge = [&](double from) { return from + static_cast<double>(random.below(14)) / size_px; };
        layers.push_back({{"rect", {edge(0), edge(0), edge(0.5), edge(0.5)}},
                          {"depth", random.between(0.05, 0.95)},
                          {"color", {random.unit(), random.unit(), random.unit()}},
                          {"alpha", 0.3 * random.unit()},
                          {"opaque", i % 20 == 11}});
    }
    const Spec spec =
        make_spec({{"type", "layers"}, {"layers", layers}},
                  {{{"id", "exact"}, {"form", "lists"}}, {{"id", "exact"}, {"form", "sorted"}}, "depth_peeling"},
                  size_px, "rgba32f");
    const Compositor compositor(spec.scene, size_px, {0.2, 0.4, 0.6});
    const auto context = make_context("egl");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    std::vector<Image> pictures;
    for (const MethodSpec& method : spec.methods) {
        pictures.push_back(stage.picture(method));
        EXPECT_LE(greatest_difference_to(compositor, pictures.back()), float_tolerance) << method.label;
        EXPECT_LE(greatest_difference(pictures.front(), pictures.back()), float_tolerance) << method.label;
    }
    EXPECT_GT(greatest_difference_to(Compositor(spec.scene, size_px, {0.3, 0.4, 0.6}), pictures[0]), 0.05);
}

/// The context's functions, but the count of fragments in the lists is read back as one too many.
class OneFragmentMore {
  public:
    explicit OneFragmentMore(const gl::Functions& real) : m_functions(real) {
        s_real = &real;
        m_functions.GetNamedBufferSubData = [](GLuint buffer, GLintptr offset, GLsizeiptr size, void* data) {
            s_real->GetNamedBufferSubData(buffer, offset, size, data);
            ++*static_cast<std::uint32_t*>(data);
        };
    }
    const gl::Functions& functions() const { return m_functions; }

  private:
    static inline const gl::Functions* s_real = nullptr;
    gl::Functions m_functions;
};

/// A fragment that was not counted has no room in the lists: there is no picture, rather than one without it.
TEST(References, AFragmentThatWasNotCountedEndsIt) {
    const auto context = make_context("egl");
    const Spec spec = make_spec(quads(5), {{{"id", "exact"}, {"form", "lists"}}}, 16, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    const OneFragmentMore faulty(context->gl());
    const auto method = stage.make(spec.methods[0], &faulty.functions());
    try {
        stage.frame(*method);
        FAIL();
    } catch (const RenderError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("some would be lost"));
    }
}

/// 1 MiB holds 37,449 fragments; this scene has over ten times as many.
TEST(References, ListsInTilesGiveTheSamePicture) {
    const auto context = make_context("egl");
    const Spec spec = make_spec(quads(2000),
                                {{{"id", "exact"}, {"form", "lists"}, {"memory_mib", 1}},
                                 {{"id", "exact"}, {"form", "lists"}, {"memory_mib", 1024}}},
                                64, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    gl::FrameTimer timer(*context);
    gl::FrameTimer::Frame frame = timer.frame(false);
    const PixelCounts overdraw = count_overdraw(context->gl(), stage.scene(), stage.target(), timer);
    frame.end();
    ASSERT_GT(overdraw.total(), 374490u);
    const auto small = stage.make(spec.methods[0]);
    stage.frame(*small);
    const Image tiled = stage.target().read();
    constexpr std::int64_t opaque_bytes = 64 * 64 * 16;
    EXPECT_LE(small->memory_bytes(), (1 << 20) + 64 * 64 * 4 + 4 + opaque_bytes);
    stage.frame(*small);
    const nlohmann::json lists = small->findings(timer)["lists"];
    EXPECT_EQ(lists["fragments"], overdraw.total());
    EXPECT_EQ(lists["kept"], overdraw.total());
    EXPECT_GT(lists["tiles"], 10);
    EXPECT_EQ(lists["memory_bytes"], small->memory_bytes() - opaque_bytes);
    EXPECT_EQ(greatest_difference(tiled, stage.picture(spec.methods[1])), 0);
}

/// 300 layers of one pixel's depth order reversed by submission: the sort has to turn the whole list around.
TEST(References, LongListsAreSorted) {
    const auto context = make_context("egl");
    nlohmann::json layers = nlohmann::json::array();
    for (int i = 0; i < 300; ++i)
        layers.push_back({{"rect", {0, 0, 1, 1}},
                          {"depth", 0.001 + 0.003 * ((i * 7) % 300)},
                          {"color", {(i % 7) / 7.0, (i % 11) / 11.0, (i % 13) / 13.0}},
                          {"alpha", 0.02}});
    const Spec spec =
        make_spec({{"type", "layers"}, {"layers", layers}},
                  {{{"id", "exact"}, {"form", "lists"}}, {{"id", "exact"}, {"form", "sorted"}}}, 8, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    EXPECT_LE(greatest_difference(stage.picture(spec.methods[0]), stage.picture(spec.methods[1])), 300 * 1e-7);
}

/// Four layers at one depth: none may be lost, and the one submitted later counts as nearer, so blending in submission
/// order is correct.
TEST(References, EqualDepthsKeepTheirFragments) {
    const auto context = make_context("egl");
    nlohmann::json layers = nlohmann::json::array();
    for (const auto& color : {std::array{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}})
        layers.push_back({{"rect", {0, 0, 1, 1}}, {"depth", 0.5}, {"color", color}, {"alpha", 0.5}});
    const Spec spec = make_spec({{"type", "layers"}, {"layers", layers}},
                                {"unsorted",
                                 {{"id", "exact"}, {"form", "lists"}},
                                 {{"id", "exact"}, {"form", "sorted"}},
                                 "depth_peeling",
                                 "b2f",
                                 "f2b"},
                                8, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    const Image expected = stage.picture(spec.methods[0]);
    for (const MethodSpec& method : spec.methods)
        EXPECT_LE(greatest_difference(expected, stage.picture(method)), float_tolerance) << method.label;
}

/// A rectangle of 3 x 2 pixels, one of 2 x 2 inside it, and an opaque one that hides a column of the first.
TEST(Overdraw, CountsVisibleFragments) {
    const auto context = make_context("egl");
    const nlohmann::json scene = {
        {"type", "layers"},
        {"layers",
         {{{"rect", {0, 0, 0.75, 0.5}}, {"depth", 0.6}, {"color", {1, 1, 1}}, {"alpha", 0}},
          {{"rect", {0, 0, 0.5, 0.5}}, {"depth", 0.3}, {"color", {1, 1, 1}}, {"alpha", 1}},
          {{"rect", {0.5, 0, 0.75, 1}}, {"depth", 0.4}, {"color", {1, 1, 1}}, {"alpha", 1}, {"opaque", true}}}}};
    const Spec spec = make_spec(scene, {"b2f"}, 4);
    Stage stage(*context, spec, PixelFormat::rgba8);
    gl::FrameTimer timer(*context);
    gl::FrameTimer::Frame frame = timer.frame(false);
    const PixelCounts overdraw = count_overdraw(context->gl(), stage.scene(), stage.target(), timer);
    frame.end();
    const std::vector<std::uint32_t> expected = {2, 2, 0, 0, 2, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(overdraw.counts, expected);
    EXPECT_EQ(overdraw.total(), 8u);
    EXPECT_EQ(overdraw.greatest(), 2u);
    EXPECT_EQ(overdraw.total_in(1, 0, 3, 2), 4u);
}

}  // namespace

}  // namespace sheer::test::references_test
