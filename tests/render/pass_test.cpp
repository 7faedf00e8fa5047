// A pass restores whatever was set in it, even if an exception is thrown.
#include "renderer/passes/pass.h"

#include <functional>
#include <map>
#include <optional>

#include "tests/render/render_test.h"

namespace sheer::test::pass_test {
namespace {

using State = std::map<std::string, std::vector<double>>;

/// Every piece of state that a pass can set.
State state_of(const gl::Functions& gl) {
    State state;
    for (const auto& [name, capability] :
         {std::pair{"depth test", GL_DEPTH_TEST}, std::pair{"stencil test", GL_STENCIL_TEST},
          std::pair{"blend", GL_BLEND}, std::pair{"scissor", GL_SCISSOR_TEST},
          std::pair{"polygon offset", GL_POLYGON_OFFSET_FILL}, std::pair{"cull", GL_CULL_FACE},
          std::pair{"alpha to coverage", GL_SAMPLE_ALPHA_TO_COVERAGE}})
        state[name] = {double(gl.IsEnabled(GLenum(capability)))};
    const auto ask = [&](const std::string& name, GLenum what, int count) {
        std::vector<double> values(static_cast<std::size_t>(count));
        gl.GetDoublev(what, values.data());
        state[name] = values;
    };
    ask("depth function", GL_DEPTH_FUNC, 1);
    ask("depth write", GL_DEPTH_WRITEMASK, 1);
    ask("depth range", GL_DEPTH_RANGE, 2);
    ask("offset factor", GL_POLYGON_OFFSET_FACTOR, 1);
    ask("offset units", GL_POLYGON_OFFSET_UNITS, 1);
    ask("color mask", GL_COLOR_WRITEMASK, 4);
    ask("blend color source", GL_BLEND_SRC_RGB, 1);
    ask("blend color target", GL_BLEND_DST_RGB, 1);
    ask("blend alpha source", GL_BLEND_SRC_ALPHA, 1);
    ask("blend alpha target", GL_BLEND_DST_ALPHA, 1);
    ask("blend equation", GL_BLEND_EQUATION_RGB, 1);
    ask("blend equation of alpha", GL_BLEND_EQUATION_ALPHA, 1);
    ask("stencil function", GL_STENCIL_FUNC, 1);
    ask("stencil reference", GL_STENCIL_REF, 1);
    ask("stencil fails", GL_STENCIL_FAIL, 1);
    ask("stencil depth fails", GL_STENCIL_PASS_DEPTH_FAIL, 1);
    ask("stencil passes", GL_STENCIL_PASS_DEPTH_PASS, 1);
    ask("stencil mask", GL_STENCIL_WRITEMASK, 1);
    ask("culled face", GL_CULL_FACE_MODE, 1);
    GLint source = 0;
    gl.GetIntegeri_v(GL_BLEND_SRC_RGB, 1, &source);
    state["blend color source of output 1"] = {double(source)};
    return state;
}

struct Setter {
    const char* name;
    std::function<void(Pass&)> set;
};

const std::vector<Setter> setters = {
    {"depth_test", [](Pass& pass) { pass.depth_test(GL_GEQUAL); }},
    {"depth_write", [](Pass& pass) { pass.depth_write(false); }},
    {"transparent_depth", [](Pass& pass) { pass.transparent_depth(); }},
    {"depth_range", [](Pass& pass) { pass.depth_range(0.25, 0.5); }},
    {"polygon_offset", [](Pass& pass) { pass.polygon_offset(1, 2); }},
    {"color_mask", [](Pass& pass) { pass.color_mask(true, false, true, false); }},
    {"no_color", [](Pass& pass) { pass.no_color(); }},
    {"blend", [](Pass& pass) { pass.blend(GL_DST_ALPHA, GL_ONE, GL_ZERO, GL_SRC_ALPHA); }},
    {"blend_output", [](Pass& pass) { pass.blend_output(1, GL_DST_COLOR, GL_ZERO, GL_ONE, GL_ONE); }},
    {"blend_equation", [](Pass& pass) { pass.blend_equation(GL_MAX, GL_MIN); }},
    {"alpha_to_coverage", [](Pass& pass) { pass.alpha_to_coverage(); }},
    {"stencil", [](Pass& pass) { pass.stencil(GL_EQUAL, 3, GL_INCR, GL_DECR, GL_INVERT); }},
    {"stencil_mask", [](Pass& pass) { pass.stencil_mask(0x0f); }},
    {"scissor", [](Pass& pass) { pass.scissor(1, 1, 1, 1); }},
    {"cull", [](Pass& pass) { pass.cull(GL_FRONT); }},
};

class PassTest : public testing::Test {
  protected:
    PassTest() : m_context(make_context("egl")), m_target(m_context->gl(), image(), PixelFormat::rgba8) {
        const Pass common(gl(), m_target);
        m_common = state_of(gl());
    }
    static ImageSpec image() {
        ImageSpec image;
        image.width_px = image.height_px = 4;
        return image;
    }
    const gl::Functions& gl() const { return m_context->gl(); }

    std::unique_ptr<gl::Context> m_context;
    Target m_target;
    State m_common;
};

TEST_F(PassTest, PutsBackEachPieceOfState) {
    for (const Setter& setter : setters) {
        SCOPED_TRACE(setter.name);
        {
            Pass pass(gl(), m_target);
            setter.set(pass);
            EXPECT_NE(state_of(gl()), m_common);
        }
        EXPECT_EQ(state_of(gl()), m_common);
    }
    m_context->check("setting state");
}

TEST_F(PassTest, PutsBackAllOfItWhenSomethingIsThrown) {
    try {
        Pass pass(gl(), m_target);
        for (const Setter& setter : setters) setter.set(pass);
        throw RenderError("in the middle");
    } catch (const RenderError&) {
    }
    EXPECT_EQ(state_of(gl()), m_common);
}

TEST_F(PassTest, PutsBackOnceWhenItIsMoved) {
    std::optional<Pass> kept;
    {
        Pass pass(gl(), m_target);
        pass.polygon_offset(1, 0);
        kept.emplace(std::move(pass));
    }
    EXPECT_TRUE(gl().IsEnabled(GL_POLYGON_OFFSET_FILL));
    kept.reset();
    EXPECT_EQ(state_of(gl()), m_common);
}

TEST_F(PassTest, ReliesOnNothingThatOthersLeft) {
    gl().Enable(GL_CULL_FACE);
    gl().Enable(GL_SCISSOR_TEST);
    gl().Enable(GL_POLYGON_OFFSET_FILL);
    gl().ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    gl().StencilMask(0);
    gl().BlendEquation(GL_MAX);
    const Pass pass(gl(), m_target);
    EXPECT_EQ(state_of(gl()), m_common);
    pass.clear_color({0, 1, 0, 1});
    EXPECT_EQ(m_target.read().rgba[1], 1);
}

}  // namespace
}  // namespace sheer::test::pass_test
