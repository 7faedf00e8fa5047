#include "renderer/gl/context.h"

#include <nlohmann/json.hpp>

#include <algorithm>

#include "tests/gl/gl_test.h"

namespace sheer::gl::context_test {
namespace {

using testing::HasSubstr;

INSTANTIATE_TEST_SUITE_P(Gl, EachContext, every_context, context_name);

TEST_P(EachContext, IsOpenGl45Core) {
    GLint major = 0;
    GLint minor = 0;
    GLint profile = 0;
    gl().GetIntegerv(GL_MAJOR_VERSION, &major);
    gl().GetIntegerv(GL_MINOR_VERSION, &minor);
    gl().GetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    EXPECT_GE(major * 10 + minor, 45);
    EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT);
}

TEST_P(EachContext, HasWhatTheMethodsNeed) {
    const auto at_least = [&](GLenum limit, GLint needed) {
        GLint value = 0;
        gl().GetIntegerv(limit, &value);
        EXPECT_GE(value, needed) << "limit " << std::hex << limit;
    };
    at_least(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS, 4);
    at_least(GL_MAX_FRAGMENT_IMAGE_UNIFORMS, 4);
    at_least(GL_MAX_DRAW_BUFFERS, 8);
    at_least(GL_MAX_COLOR_ATTACHMENTS, 8);
    at_least(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, 32);
    GLint timer_bits = 0;
    gl().GetQueryiv(GL_TIME_ELAPSED, GL_QUERY_COUNTER_BITS, &timer_bits);
    EXPECT_GE(timer_bits, 30);
    gl().TextureBarrier();
    context().check("the needs of the methods");
}

TEST_P(EachContext, KnowsItsExtensions) {
    EXPECT_TRUE(context().has_extension("GL_KHR_debug"));
    EXPECT_TRUE(context().has_extension("GL_ARB_texture_barrier"));
    EXPECT_FALSE(context().has_extension("GL_ARB_texture_barrie"));
    EXPECT_FALSE(context().has_extension(""));
    GLint count = 0;
    gl().GetIntegerv(GL_NUM_EXTENSIONS, &count);
    EXPECT_EQ(context().device().extensions.size(), static_cast<std::size_t>(count));
}

TEST_P(EachContext, DescribesItsDevice) {
    const DeviceInfo& device = context().device();
    EXPECT_EQ(device.context, GetParam());
    EXPECT_EQ(device.name, std::string(GetParam()) + ":" + std::to_string(device.index));
    EXPECT_EQ(device.renderer, reinterpret_cast<const char*>(gl().GetString(GL_RENDERER)));
    EXPECT_EQ(device.vendor, reinterpret_cast<const char*>(gl().GetString(GL_VENDOR)));
    EXPECT_EQ(device.gl_version, reinterpret_cast<const char*>(gl().GetString(GL_VERSION)));
    EXPECT_EQ(device.glsl_version, reinterpret_cast<const char*>(gl().GetString(GL_SHADING_LANGUAGE_VERSION)));
    EXPECT_EQ(device.software, device.renderer.find("llvmpipe") != std::string::npos) << device.renderer;
}

TEST_P(EachContext, ClearsAndReadsBack) {
    const Target target(gl(), 8);
    target.clear({64, 128, 191, 255});
    EXPECT_EQ(target.read(0, 0), (Pixel{64, 128, 191, 255}));
    EXPECT_EQ(target.read(7, 7), (Pixel{64, 128, 191, 255}));
    context().check("clearing");
}

TEST_P(EachContext, CanBeMadeAgainAfterItIsGone) {
    for (int i = 0; i < 3; ++i) {
        m_context.reset();
        m_context = make_context();
        const Target target(gl(), 1);
        target.clear({1, 2, 3, 4});
        EXPECT_EQ(target.read(0, 0), (Pixel{1, 2, 3, 4}));
    }
}

/// Two contexts number their objects in the same way, so a call that reaches the wrong one shows the other color.
void expect_side_by_side(Context& first, Context& second) {
    first.make_current();
    const Target a(first.gl(), 1);
    a.clear({10, 20, 30, 40});
    second.make_current();
    {
        const Target b(second.gl(), 1);
        ASSERT_EQ(a.framebuffer.id(), b.framebuffer.id());
        b.clear({50, 60, 70, 80});
        first.make_current();
        EXPECT_EQ(a.read(0, 0), (Pixel{10, 20, 30, 40}));
        a.clear({11, 21, 31, 41});
        second.make_current();
        EXPECT_EQ(b.read(0, 0), (Pixel{50, 60, 70, 80}));
        second.check("the second context");
    }
    first.make_current();
    EXPECT_EQ(a.read(0, 0), (Pixel{11, 21, 31, 41}));
    first.check("the first context");
}

class EachPair : public testing::TestWithParam<std::tuple<const char*, const char*>> {
  protected:
    void SetUp() override {
        const auto [first, second] = GetParam();
        const bool needs_display = std::string_view(first) == "glfw" || std::string_view(second) == "glfw";
        if (needs_display && std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no DISPLAY";
        m_first = create_context({first, "", {}});
        m_second = create_context({second, "", {}});
    }

    std::unique_ptr<Context> m_first;
    std::unique_ptr<Context> m_second;
};

INSTANTIATE_TEST_SUITE_P(Gl, EachPair, testing::Combine(every_context, every_context),
                         [](const testing::TestParamInfo<EachPair::ParamType>& pair) {
                             return std::string(std::get<0>(pair.param)) + "_" + std::get<1>(pair.param);
                         });

TEST_P(EachPair, TakeTurns) {
    expect_side_by_side(*m_first, *m_second);
    expect_side_by_side(*m_second, *m_first);
}

TEST_P(EachPair, OneOutlivesTheOther) {
    m_first->make_current();
    const Target target(m_first->gl(), 1);
    target.clear({9, 8, 7, 6});
    m_second.reset();
    m_first->make_current();
    EXPECT_EQ(target.read(0, 0), (Pixel{9, 8, 7, 6}));
    m_first->check("after the other has gone");
}

/// Unsets DISPLAY while it exists.
class NoDisplay {
  public:
    NoDisplay() {
        if (const char* display = std::getenv("DISPLAY")) m_display = display;
        unsetenv("DISPLAY");
    }
    NoDisplay(const NoDisplay&) = delete;
    NoDisplay& operator=(const NoDisplay&) = delete;
    ~NoDisplay() {
        if (!m_display.empty()) setenv("DISPLAY", m_display.c_str(), 1);
    }

  private:
    std::string m_display;
};

TEST(CreateContext, WithoutDisplayGlfwSaysSo) {
    const NoDisplay no_display;
    EXPECT_THAT(message_of<Unsupported>([] { create_context({"glfw", "", {}}); }), HasSubstr("DISPLAY"));
}

TEST(CreateContext, WithoutDisplayAutoStillWorks) {
    const NoDisplay no_display;
    EXPECT_EQ(create_context({})->device().context, "egl");
}

TEST(ListDevices, NamesWhatCreateContextTakes) {
    const NoDisplay no_display;
    bool osmesa = false;
    for (const ListedDevice& listed : list_devices()) {
        if (listed.info.context == "glfw") {
            ASSERT_TRUE(listed.error.has_value());
            EXPECT_THAT(*listed.error, HasSubstr("DISPLAY"));
            EXPECT_EQ(listed.info.renderer, "");
            continue;
        }
        if (listed.error) continue;
        osmesa = osmesa || listed.info.context == "osmesa";
        const auto context = create_context({"auto", listed.info.name, {}});
        EXPECT_EQ(to_json(context->device()), to_json(listed.info));
    }
    EXPECT_TRUE(osmesa);
}

TEST(DeviceInfo, ToJson) {
    const DeviceInfo info{"egl", 1, "egl:1", "R", "V", "4.5", "4.50", "EGL device", true, {"GL_KHR_debug"}};
    EXPECT_EQ(to_json(info), nlohmann::json::parse(R"({"context": "egl", "index": 1, "name": "egl:1", "renderer": "R",
        "vendor": "V", "gl_version": "4.5", "glsl_version": "4.50", "platform": "EGL device", "software": true})"));
}

}  // namespace
}  // namespace sheer::gl::context_test
