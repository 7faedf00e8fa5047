// What alpha testing keeps and drops.
#include "tests/render/render_test.h"

namespace sheer::test::alpha_test_test {

namespace {

/// One full layer of this alpha, white, over the background (0.2, 0.4, 0.6).
float red_of(const nlohmann::json& method, double alpha, bool opaque_in_front = false) {
    nlohmann::json layers = {
        {{"rect", {0, 0, 1, 1}}, {"depth", 0.5}, {"color", {1, 1, 1}}, {"alpha", alpha}},
        {{"rect", {0, 0, 1, 1}}, {"depth", opaque_in_front ? 0.4 : 0.6}, {"color", {0, 0, 0}}, {"opaque", true}}};
    const auto context = make_context("egl");
    const Spec spec = make_spec({{"type", "layers"}, {"layers", layers}}, nlohmann::json::array({method}), 4);
    Stage stage(*context, spec, PixelFormat::rgba8);
    return stage.picture(spec.methods[0]).pixel(1, 2)[0];
}

TEST(AlphaTest, DropsWhatIsUnderTheReference) {
    EXPECT_EQ(red_of({{"id", "alpha_test"}}, 0.49), 0);
    EXPECT_EQ(red_of({{"id", "alpha_test"}}, 0.51), 1);
    EXPECT_EQ(red_of({{"id", "alpha_test"}, {"reference", 0.25}}, 0.24), 0);
    EXPECT_EQ(red_of({{"id", "alpha_test"}, {"reference", 0.25}}, 0.26), 1);
}

TEST(AlphaTest, EndsOfTheRange) {
    EXPECT_EQ(red_of({{"id", "alpha_test"}, {"reference", 0}}, 0), 1) << "at reference 0 everything is drawn";
    EXPECT_EQ(red_of({{"id", "alpha_test"}, {"reference", 1}}, 0.99), 0);
    EXPECT_EQ(red_of({{"id", "alpha_test"}, {"reference", 1}}, 1), 1);
}

TEST(AlphaTest, OpaqueInFrontHides) {
    EXPECT_EQ(red_of({{"id", "alpha_test"}}, 1, true), 0);
}

/// A near fragment that is dropped must leave no depth behind, wherever it was submitted.
TEST(AlphaTest, SubmissionDoesNotMatter) {
    const nlohmann::json dropped = {{"rect", {0, 0, 1, 1}}, {"depth", 0.1}, {"color", {1, 0, 0}}, {"alpha", 0.2}};
    const nlohmann::json middle = {{"rect", {0, 0, 1, 1}}, {"depth", 0.3}, {"color", {0, 1, 0}}, {"alpha", 0.6}};
    const nlohmann::json last = {{"rect", {0, 0, 1, 1}}, {"depth", 0.7}, {"color", {0, 0, 1}}, {"alpha", 0.9}};
    const auto context = make_context("egl");
    std::vector<nlohmann::json> order = {dropped, last, middle};
    std::ranges::sort(order);
    do {
        const Spec spec = make_spec({{"type", "layers"}, {"layers", order}}, nlohmann::json::array({"alpha_test"}), 4);
        Stage stage(*context, spec, PixelFormat::rgba8);
        const Image image = stage.picture(spec.methods[0]);
        EXPECT_EQ((std::vector(image.pixel(1, 1), image.pixel(1, 1) + 4)), (std::vector<float>{0, 1, 0, 1}));
    } while (std::ranges::next_permutation(order).found);
}

}  // namespace

}  // namespace sheer::test::alpha_test_test
