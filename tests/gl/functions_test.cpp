#include "renderer/gl/functions.h"

#include <algorithm>
#include <string_view>

#include "tests/gl/fake_driver.h"
#include "tests/gl/gl_test.h"
#include "used_gl_functions.h"

namespace sheer::gl::functions_test {
namespace {

struct Device {
    static constexpr GLint major = 4, minor = 5;
    static constexpr const char* renderer = "a driver that lacks a function";
};

void* resolve(const char* name) {
    return FakeDriver<Device>::resolve(name);
}

Resolver without(std::string_view lacking) {
    return [lacking](const char* name) { return name == lacking ? nullptr : resolve(name); };
}

bool is_used(std::string_view name) {
    return std::ranges::find(used_functions, name) != std::end(used_functions);
}

TEST(LoadFunctions, NamesTheMissingOne) {
    EXPECT_THAT(message_of<RenderError>([] { load_functions(without("glTextureBarrier")); }),
                testing::HasSubstr("lacks glTextureBarrier,"));
}

/// Whichever function a driver lacks, the error names it, even if glad itself needs it to load the others.
TEST(LoadFunctions, RefusesToBeWithoutAnyThatSheerCalls) {
    for (const char* name : used_functions) {
        EXPECT_THAT(message_of<RenderError>([&] { load_functions(without(name)); }),
                    testing::HasSubstr(std::string("lacks ") + name + ","));
    }
}

TEST(LoadFunctions, DoesWithoutThoseThatSheerNeverCalls) {
    for (const char* name : {"glTexImage1D", "glDispatchComputeIndirect", "glCreateShaderProgramv"}) {
        ASSERT_FALSE(is_used(name));
        EXPECT_NO_THROW(load_functions(without(name)));
    }
    const Functions gl = load_functions([](const char* name) { return is_used(name) ? resolve(name) : nullptr; });
    EXPECT_NE(gl.Enable, nullptr);
    EXPECT_EQ(gl.TexImage1D, nullptr);
}

/// One of each way to name a function: gl.Name(...), m_gl->Name(...), m_gl.Name(...), gl.Name as an argument and
/// &Functions::Name.
TEST(UsedFunctions, AreFoundHoweverTheyAreNamed) {
    for (const char* name :
         {"glDebugMessageControl", "glProgramUniform1f", "glTextureBarrier", "glGetShaderInfoLog", "glIsVertexArray"}) {
        EXPECT_TRUE(is_used(name)) << name;
    }
}

}  // namespace
}  // namespace sheer::gl::functions_test
