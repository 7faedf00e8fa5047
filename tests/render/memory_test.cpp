// The memory that methods say they need, against what they allocate.
#include <fmt/format.h>

#include "tests/render/method_row.h"
#include "tests/render/render_test.h"

namespace sheer::test::memory_test {

namespace {

using nlohmann::json;

constexpr int size_px = 64;

int pixel_bytes(PixelFormat format) {
    return format == PixelFormat::rgba8 ? 4 : format == PixelFormat::rgba16f ? 8 : 16;
}

class Memory : public testing::TestWithParam<std::string> {
  protected:
    /// Per pixel, in a scene without opaque geometry.
    void expect_as_allocated(const json& method, const std::string& format) {
        const json layer = {{"rect", {0, 0, 1, 1}}, {"depth", 0.5}, {"color", {1, 1, 1}}, {"alpha", 0.5}};
        const Spec spec = make_spec({{"type", "layers"}, {"layers", {layer}}}, json::array({method}), size_px, format);
        const MethodSpec& given = spec.methods[0];
        const auto expected = find_method(given.id)->bytes_per_px(given.parameters, pixel_bytes(spec.image.format));
        if (!expected) return;
        Stage stage(*m_context, spec, spec.image.format);
        try {
            const double allocated = static_cast<double>(stage.make(given)->memory_bytes()) / (size_px * size_px);
            EXPECT_DOUBLE_EQ(allocated, *expected) << method.dump() << " in " << format;
        } catch (const Unsupported& unsupported) {
            GTEST_SKIP() << unsupported.what();
        }
    }

    const std::unique_ptr<gl::Context> m_context = make_context("egl");
};

TEST_P(Memory, IsWhatTheFormulaSays) {
    const MethodRow& row = method_row(GetParam());
    for (const char* format : {"rgba8", "rgba16f", "rgba32f"}) {
        expect_as_allocated({{"id", row.id}}, format);
        for (const MethodVariant& variant : row.variants)
            expect_as_allocated(method_json(row, variant.parameters), format);
    }
}

std::vector<std::string> ids() {
    std::vector<std::string> all;
    for (const MethodRow& row : all_method_rows()) all.push_back(row.id);
    return all;
}

INSTANTIATE_TEST_SUITE_P(All, Memory, testing::ValuesIn(ids()), [](const auto& id) { return id.param; });

/// Those whose memory depends on the scene are known, so that no formula is forgotten.
TEST(MemoryFormulas, AreMissingOnlyWhereTheSceneDecides) {
    std::vector<std::string> without;
    for (const MethodRow& row : all_method_rows()) {
        const Spec spec = make_spec({{"type", "quads"}, {"count", 1}}, json::array({json{{"id", row.id}}}));
        if (!find_method(row.id)->bytes_per_px(spec.methods[0].parameters, 4)) without.push_back(row.id);
    }
    EXPECT_EQ(without, (std::vector<std::string>{"exact", "f2bg", "f2bh"}));
}

}  // namespace

}  // namespace sheer::test::memory_test
