// How early discarding may change the picture, and when it synchronises.
#include "renderer/core/random.h"
#include "renderer/passes/overdraw.h"
#include "tests/render/render_test.h"

namespace sheer::test::discarding_test {

namespace {

constexpr int size_px = 64;

nlohmann::json quads(int count, const std::string& shading = "4x4-textures") {
    return {{"type", "quads"}, {"count", count}, {"shading", shading}, {"texture", {{"image", "leaf"}, {"size", 64}}}};
}

/// Calls that a method made.
struct Calls {
    int barriers = 0, unbinds = 0, flushes = 0, finishes = 0;
};

/// The functions of a context, of which four are counted. One at a time: GL functions carry no user data.
class CountedFunctions {
  public:
    explicit CountedFunctions(const gl::Functions& real) : m_functions(real) {
        s_real = &real;
        s_calls = &m_calls;
        m_functions.TextureBarrier = [] {
            ++s_calls->barriers;
            s_real->TextureBarrier();
        };
        m_functions.BindFramebuffer = [](GLenum target, GLuint id) {
            if (id == 0) ++s_calls->unbinds;
            s_real->BindFramebuffer(target, id);
        };
        m_functions.Flush = [] {
            ++s_calls->flushes;
            s_real->Flush();
        };
        m_functions.Finish = [] {
            ++s_calls->finishes;
            s_real->Finish();
        };
    }
    const gl::Functions& functions() const { return m_functions; }
    const Calls& calls() const { return m_calls; }

  private:
    static inline const gl::Functions* s_real = nullptr;
    static inline Calls* s_calls = nullptr;
    gl::Functions m_functions;
    Calls m_calls;
};

Calls calls_of(const nlohmann::json& method, int count) {
    const auto context = make_context("egl");
    const Spec spec = make_spec(quads(count), nlohmann::json::array({method}), size_px);
    Stage stage(*context, spec, PixelFormat::rgba8);
    const CountedFunctions counted(context->gl());
    const auto made = stage.make(spec.methods[0], &counted.functions());
    stage.frame(*made);
    return counted.calls();
}

TEST(Discarding, SynchronisesAfterTheClear) {
    EXPECT_EQ(calls_of({{"id", "f2bd"}}, 10).barriers, 1);
    EXPECT_EQ(calls_of({{"id", "f2bd"}}, 10).unbinds, 0);
}

TEST(Discarding, SynchronisesBetweenBatches) {
    // 10 primitives in batches of 4: after the clear, and before the second and the third batch.
    EXPECT_EQ(calls_of({{"id", "f2bd"}, {"batch", 4}}, 10).barriers, 3);
    EXPECT_EQ(calls_of({{"id", "f2bd"}, {"batch", 10}}, 10).barriers, 1);
    EXPECT_EQ(calls_of({{"id", "f2bx"}, {"batch", 1}}, 10).barriers, 10);
}

TEST(Discarding, RebindsOrDoesNothingWhenTold) {
    const Calls rebind = calls_of({{"id", "f2bd"}, {"sync", "rebind"}, {"batch", 4}}, 10);
    EXPECT_EQ(rebind.barriers, 0);
    EXPECT_EQ(rebind.unbinds, 3);
    const Calls none = calls_of({{"id", "f2bd"}, {"sync", "none"}, {"batch", 4}}, 10);
    EXPECT_EQ(none.barriers + none.unbinds, 0);
    const Calls flush = calls_of({{"id", "f2bd"}, {"sync", "flush"}, {"batch", 4}}, 10);
    EXPECT_EQ(flush.flushes - none.flushes, 3);
    EXPECT_EQ(flush.barriers + flush.unbinds + flush.finishes - none.finishes, 0);
    const Calls finish = calls_of({{"id", "f2bd"}, {"sync", "finish"}, {"batch", 4}}, 10);
    EXPECT_EQ(finish.finishes - none.finishes, 3);
    EXPECT_EQ(finish.barriers + finish.unbinds + finish.flushes - none.flushes, 0);
}

/// In front of what is left out, less than the threshold of transmittance is left, and no color is over 1.
TEST(Discarding, ErrorIsAtMostTheThreshold) {
    const auto context = make_context("egl");
    for (const double threshold : {0.01, 0.1, 0.5}) {
        const Spec spec =
            make_spec(quads(200), {"f2b", {{"id", "f2bd"}, {"threshold", threshold}}}, size_px, "rgba32f");
        Stage stage(*context, spec, PixelFormat::rgba32f);
        const double difference = greatest_difference(stage.picture(spec.methods[0]), stage.picture(spec.methods[1]));
        EXPECT_LE(difference, threshold + 1e-5) << threshold;
        EXPECT_GT(difference, 0) << "nothing was discarded";
    }
}

bool can_fetch(const gl::Context& context) {
    return context.has_extension("GL_EXT_shader_framebuffer_fetch");
}

TEST(Discarding, EveryWayOfReadingTheAlphaGivesOnePicture) {
    const auto context = make_context("egl");
    nlohmann::json ways = {{{"id", "f2bd"}},
                           {{"id", "f2bd"}, {"alpha_target", "separate"}},
                           {{"id", "f2bd"}, {"feedback", "framebuffer_fetch"}},
                           {{"id", "f2bd"}, {"feedback", "framebuffer_fetch"}, {"alpha_target", "separate"}},
                           {{"id", "f2bd"}, {"form", "if_discard"}},
                           {{"id", "f2bd"}, {"alpha_factors", "dst_alpha_zero"}}};
    for (nlohmann::json& way : ways) way["batch"] = exact_batch(*context);
    ways.push_back({{"id", "f2bd"}, {"sync", "rebind"}, {"batch", context->device().software ? 7 : 1}});
    const Spec spec = make_spec(quads(200), ways, size_px);
    Stage stage(*context, spec, PixelFormat::rgba8);
    const Image first = stage.picture(spec.methods[0]);
    for (const MethodSpec& method : spec.methods) {
        if (!can_fetch(*context) && method.parameters["feedback"] == "framebuffer_fetch") continue;
        EXPECT_EQ(greatest_difference(first, stage.picture(method)), 0) << method.parameters;
    }
}

/// The opacity instead of the transmittance: the same picture and the same fragments except for rounding.
TEST(Discarding, KeepingTheOpacityGivesThePicture) {
    const auto context = make_context("egl");
    nlohmann::json methods = nlohmann::json::array({{{"id", "f2bd"}, {"threshold", 0.05}}});
    for (const std::string alpha_target : {"shared", "separate"})
        for (const std::string factors : {"zero_src_alpha", "dst_alpha_zero"})
            for (const std::string feedback : {"texture", "framebuffer_fetch"})
                if (feedback == "texture" || can_fetch(*context))
                    methods.push_back({{"id", "f2bd"},
                                       {"threshold", 0.05},
                                       {"inverted", false},
                                       {"alpha_target", alpha_target},
                                       {"alpha_factors", factors},
                                       {"feedback", feedback}});
    for (nlohmann::json& method : methods) method["batch"] = exact_batch(*context);
    const Spec spec = make_spec(quads(200), methods, size_px, "rgba32f");
    Stage stage(*context, spec, PixelFormat::rgba32f);
    const Image first = stage.picture(spec.methods[0]);
    // A fragment that just passes the threshold on one side of the rounding adds less than that.
    for (const MethodSpec& method : spec.methods)
        EXPECT_LE(greatest_difference(first, stage.picture(method)), 0.05 + 1e-5) << method.parameters;
    int alike = 0;
    for (const MethodSpec& method : spec.methods)
        alike += greatest_difference(first, stage.picture(method)) < 1e-4 ? 1 : 0;
    EXPECT_GT(alike, static_cast<int>(spec.methods.size()) / 2);
}

/// Without the extension the method is unsupported, with the extension's name as the reason.
TEST(Discarding, FramebufferFetchNeedsItsExtension) {
    const auto context = make_context("egl");
    const Spec spec =
        make_spec(quads(1), nlohmann::json::array({{{"id", "f2bd"}, {"feedback", "framebuffer_fetch"}}}), size_px);
    Stage stage(*context, spec, PixelFormat::rgba8);
    if (context->has_extension("GL_EXT_shader_framebuffer_fetch")) {
        EXPECT_NO_THROW(stage.picture(spec.methods[0]));
    } else {
        EXPECT_THROW(stage.picture(spec.methods[0]), Unsupported);
    }
}

/// F2BD must shade exactly the fragments that come before the transmittance falls under the threshold: three layers of
/// alpha 0.5 leave 0.5, 0.25 and 0.125, so of five layers a threshold of 0.2 lets three through. Counted by the samples
/// that pass; the clear counts none and the composite adds one for each pixel.
TEST(Discarding, ShadesWhatIsNeeded) {
    const auto context = make_context("egl");
    nlohmann::json layers = nlohmann::json::array();
    for (int i = 0; i < 5; ++i)
        layers.push_back({{"rect", {0, 0, 1, 1}}, {"depth", 0.1 + 0.1 * i}, {"color", {1, 1, 1}}, {"alpha", 0.5}});
    const Spec spec =
        make_spec({{"type", "layers"}, {"layers", layers}}, {"f2b", {{"id", "f2bd"}, {"threshold", 0.2}}}, 16);
    Stage stage(*context, spec, PixelFormat::rgba8);
    const gl::Functions& gl = context->gl();
    const gl::Query query = gl::make_query(gl, "samples", GL_SAMPLES_PASSED);
    const auto layers_shaded = [&](const MethodSpec& spec_of_method) {
        const auto method = stage.make(spec_of_method);
        stage.frame(*method);
        gl.BeginQuery(GL_SAMPLES_PASSED, query.id());
        stage.frame(*method);
        gl.EndQuery(GL_SAMPLES_PASSED);
        GLuint samples = 0;
        gl.GetQueryObjectuiv(query.id(), GL_QUERY_RESULT, &samples);
        return static_cast<int>(samples / (16 * 16)) - 1;
    };
    EXPECT_EQ(layers_shaded(spec.methods[0]), 5);
    // Hardware may read an older transmittance and shade more, never less.
    if (context->device().software) {
        EXPECT_EQ(layers_shaded(spec.methods[1]), 3);
    } else {
        EXPECT_GE(layers_shaded(spec.methods[1]), 3);
    }
}

}  // namespace

}  // namespace sheer::test::discarding_test
