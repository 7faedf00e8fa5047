// A driver that has only the functions that the build found in the sources is enough for every method.
#include "used_gl_functions.h"

#define EGL_NO_X11
#include <EGL/egl.h>

#include <algorithm>

#include "renderer/compare/compare.h"
#include "tests/render/render_test.h"

namespace sheer::test::used_functions_test {

namespace {

void* resolve_used(const char* name) {
    const bool used = std::ranges::find(gl::used_functions, std::string_view(name)) != std::end(gl::used_functions);
    return used ? reinterpret_cast<void*>(eglGetProcAddress(name)) : nullptr;
}

std::vector<MethodResult> compare_all_methods(gl::Context& context) {
    nlohmann::json methods;
    for (const MethodInfo& method : all_methods()) methods.push_back(method.id);
    const Spec spec = make_spec({{"type", "quads"}, {"count", 6}, {"shading", "4x4-textures"}}, methods, 24);
    NoAssets assets;
    std::vector<MethodResult> results;
    compare(
        spec, context, assets, [](double, const std::string&) {},
        [&](const sheer::Run& run) { results = run.results; });
    return results;
}

TEST(UsedFunctions, AreAllThatAComparisonCalls) {
    const auto context = make_context("egl");
    const std::vector<MethodResult> expected = compare_all_methods(*context);
    const_cast<gl::Functions&>(context->gl()) = gl::load_functions(resolve_used);
    const std::vector<MethodResult> results = compare_all_methods(*context);
    ASSERT_EQ(results.size(), all_methods().size());
    for (std::size_t i = 0; i < results.size(); ++i) {
        EXPECT_EQ(results[i].status, expected[i].status) << results[i].method.label << ": " << results[i].reason;
        EXPECT_EQ(results[i].image.rgba, expected[i].image.rgba) << results[i].method.label;
    }
}

}  // namespace
}  // namespace sheer::test::used_functions_test
