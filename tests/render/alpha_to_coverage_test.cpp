// Alpha to coverage: its levels, what they do to layers, and the alpha test before them.
#include <cmath>

#include "tests/render/render_test.h"

namespace sheer::test::alpha_to_coverage_test {

namespace {

using nlohmann::json;

json layer(double depth, double gray, double alpha, bool opaque = false) {
    return {
        {"rect", {0, 0, 1, 1}}, {"depth", depth}, {"color", {gray, gray, gray}}, {"alpha", alpha}, {"opaque", opaque}};
}

json coverage(int samples = 4, double reference = 0) {
    return {{"id", "alpha_to_coverage"}, {"samples", samples}, {"reference", reference}};
}

class AlphaToCoverage : public testing::Test {
  protected:
    Image picture(const std::vector<json>& layers, const json& method = coverage(),
                  const std::string& format = "rgba32f", int size_px = 4) {
        const Spec spec = make_spec({{"type", "layers"}, {"layers", layers}}, json::array({method}), size_px, format);
        Stage stage(*m_context, spec, spec.image.format);
        return stage.picture(spec.methods[0]);
    }
    float gray_of(const std::vector<json>& layers, const json& method = coverage()) {
        return picture(layers, method).pixel(2, 1)[0];
    }
    /// The device decides how alpha becomes a number of samples; llvmpipe's rule is known: sample i of n from i/n up.
    bool rule_is_known() const { return m_context->device().software; }
    gl::Context& context() { return *m_context; }

  private:
    std::unique_ptr<gl::Context> m_context = make_context("egl");
};

/// White over black shows the share of covered samples: ceil(4 alpha) / 4, which is up to a quarter too high.
TEST_F(AlphaToCoverage, HasFourLevels) {
    float last = 0;
    for (const double alpha : {0.0, 0.02, 0.24, 0.26, 0.49, 0.51, 0.74, 0.76, 0.99, 1.0}) {
        const float gray = gray_of({layer(0.9, 0, 1, true), layer(0.5, 1, alpha)});
        EXPECT_EQ(gray * 4, std::round(gray * 4)) << alpha;
        EXPECT_GE(gray, last) << alpha;
        EXPECT_NEAR(gray, alpha, 0.25) << alpha;
        if (rule_is_known()) {
            EXPECT_EQ(gray, std::ceil(4 * alpha) / 4) << alpha;
        }
        last = gray;
    }
    EXPECT_EQ(gray_of({layer(0.9, 0, 1, true), layer(0.5, 1, 0)}), 0);
    EXPECT_EQ(last, 1);
}

/// By llvmpipe's rule both layers cover the same half of the samples, so the far one vanishes; blending would give
/// 0.5 * 1 + 0.25 * 0.8 + 0.25 * 0 = 0.7.
TEST_F(AlphaToCoverage, LikeAlphasHideEachOther) {
    if (!rule_is_known()) GTEST_SKIP() << "not on llvmpipe";
    EXPECT_EQ(gray_of({layer(0.9, 0, 1, true), layer(0.3, 1, 0.5), layer(0.6, 0.8, 0.5)}), 0.5f);
    // A far layer that covers three samples shows in the one that the near one leaves it.
    EXPECT_NEAR(gray_of({layer(0.9, 0, 1, true), layer(0.3, 1, 0.5), layer(0.6, 0.8, 0.75)}), 0.7, 1e-6);
}

TEST_F(AlphaToCoverage, ReferenceDropsFirst) {
    const std::vector<json> layers = {layer(0.9, 0, 1, true), layer(0.5, 1, 0.4)};
    EXPECT_GT(gray_of(layers, coverage(4, 0.39)), 0);
    EXPECT_EQ(gray_of(layers, coverage(4, 0.39)), gray_of(layers));
    EXPECT_EQ(gray_of(layers, coverage(4, 0.41)), 0);
    // A dropped fragment leaves no depth behind.
    std::vector<json> with_far = layers;
    with_far.push_back(layer(0.7, 0.6, 1));
    EXPECT_NEAR(gray_of(with_far, coverage(4, 0.41)), 0.6, 1e-6);
}

/// Either exactly two samples or unsupported: more would give a different picture.
TEST_F(AlphaToCoverage, TwoSamplesOrUnsupported) {
    const std::vector<json> layers = {layer(0.9, 0, 1, true), layer(0.5, 1, 0.3)};
    try {
        const float gray = gray_of(layers, coverage(2));
        EXPECT_EQ(gray * 2, std::round(gray * 2));
    } catch (const Unsupported& unsupported) {
        EXPECT_EQ(std::string(unsupported.what()), "samples 2: this device has 4 samples per pixel at least");
    }
    EXPECT_THROW(gray_of(layers, coverage(3)), SpecError);
}

TEST_F(AlphaToCoverage, OpaqueInFrontBehindBetween) {
    EXPECT_NEAR(gray_of({layer(0.1, 0.3, 1, true), layer(0.5, 1, 1)}), 0.3, 1e-6);
    EXPECT_EQ(gray_of({layer(0.9, 0.3, 1, true), layer(0.5, 1, 1)}), 1);
    const float between = gray_of({layer(0.4, 0, 1, true), layer(0.2, 1, 0.5), layer(0.6, 1, 1)});
    EXPECT_EQ(between, gray_of({layer(0.4, 0, 1, true), layer(0.2, 1, 0.5)}));
    EXPECT_GT(between, 0);
    EXPECT_LT(between, 1);
}

/// An edge at 3.45 pixels covers half of the samples of pixel 3, of opaque and of transparent rectangles alike.
TEST_F(AlphaToCoverage, EdgesAreSmooth) {
    for (const bool opaque : {true, false}) {
        json half = layer(0.5, 1, 1, opaque);
        half["rect"] = {0, 0, 3.45 / 8, 1};
        const Image image = picture({layer(0.9, 0, 1, true), half}, coverage(), "rgba32f", 8);
        EXPECT_EQ(image.pixel(2, 4)[0], 1);
        EXPECT_EQ(image.pixel(3, 4)[0], 0.5f);
        EXPECT_EQ(image.pixel(4, 4)[0], 0);
    }
}

TEST_F(AlphaToCoverage, SubmissionDoesNotMatter) {
    std::vector<json> layers = {layer(0.8, 0.1, 1, true), layer(0.2, 0.9, 0.2), layer(0.4, 0.4, 0.6),
                                layer(0.6, 0.7, 0.9)};
    const float expected = gray_of(layers);
    std::ranges::sort(layers);
    do {
        EXPECT_EQ(gray_of(layers), expected) << json(layers);
    } while (std::ranges::next_permutation(layers).found);
}

/// Alpha decides the coverage and must not reach the picture; nor may the state affect other methods.
TEST_F(AlphaToCoverage, LeavesNothingBehind) {
    for (const std::string format : {"rgba8", "rgba16f", "rgba32f"})
        EXPECT_EQ(picture({layer(0.5, 1, 0.6)}, coverage(), format).pixel(0, 0)[3], 1) << format;
    EXPECT_EQ(context().gl().IsEnabled(GL_SAMPLE_ALPHA_TO_COVERAGE), GL_FALSE);
    const Spec spec = make_spec({{"type", "layers"}, {"layers", {layer(0.5, 1, 0.5)}}}, json::array({coverage()}), 8);
    Stage stage(context(), spec, PixelFormat::rgba8);
    EXPECT_EQ(stage.make(spec.methods[0])->memory_bytes(), 8 * 8 * 4 * (4 + 4));
}

}  // namespace

}  // namespace sheer::test::alpha_to_coverage_test
