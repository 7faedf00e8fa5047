#include "renderer/gl/functions.h"

#include <set>

#include "tests/gl/gl_test.h"

namespace sheer::gl::functions_test {
namespace {

void* some_address() {
    static int place = 0;
    return &place;
}

TEST(LoadFunctions, NamesTheMissingOne) {
    const auto resolve = [](const char* name) {
        return std::string_view(name) == "glTextureBarrier" ? nullptr : some_address();
    };
    EXPECT_THAT(message_of<RenderError>([&] { load_functions(resolve); }),
                testing::HasSubstr("lacks glTextureBarrier,"));
}

TEST(LoadFunctions, LeavesOptionalOnesNull) {
    const std::set<std::string_view> absent{"glSpecializeShader", "glMultiDrawElementsIndirectCount",
                                            "glFramebufferFetchBarrierEXT"};
    const Functions gl =
        load_functions([&](const char* name) { return absent.contains(name) ? nullptr : some_address(); });
    EXPECT_EQ(gl.SpecializeShader, nullptr);
    EXPECT_EQ(gl.FramebufferFetchBarrierEXT, nullptr);
    EXPECT_NE(gl.BlendBarrierKHR, nullptr);
    EXPECT_NE(gl.Clear, nullptr);
}

TEST(LoadFunctions, AsksForEachNameOnce) {
    std::multiset<std::string> asked;
    load_functions([&](const char* name) {
        asked.insert(name);
        return some_address();
    });
    EXPECT_EQ(asked.count("glClear"), 1);
    EXPECT_EQ(asked.size(), std::set<std::string>(asked.begin(), asked.end()).size());
    for (const std::string& name : asked) EXPECT_TRUE(name.starts_with("gl")) << name;
}

}  // namespace
}  // namespace sheer::gl::functions_test
