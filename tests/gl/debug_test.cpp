#include "renderer/gl/timer.h"
#include "tests/gl/gl_test.h"

namespace sheer::gl::debug_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class EachDebugContext : public EachContext {
  protected:
    void say(GLenum type, GLenum severity, std::string_view text) {
        gl().DebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, type, 7, severity, static_cast<GLsizei>(text.size()),
                                text.data());
    }
    std::string error() {
        return message_of<RenderError>([&] { context().check("drawing the leaves"); });
    }
};

INSTANTIATE_TEST_SUITE_P(Gl, EachDebugContext, every_context, context_name);

TEST_P(EachDebugContext, AnInvalidEnumIsThrownOnce) {
    gl().Enable(0xDEAD);
    EXPECT_THAT(error(), AllOf(HasSubstr("drawing the leaves: "), HasSubstr("INVALID_ENUM")));
    context().check("the error is forgotten");
}

TEST_P(EachDebugContext, EveryErrorIsInTheText) {
    gl().Enable(0xDEAD);
    gl().Viewport(0, 0, -1, 1);
    EXPECT_THAT(error(), AllOf(HasSubstr("INVALID_ENUM"), HasSubstr("INVALID_VALUE")));
}

TEST_P(EachDebugContext, AnErrorIsThrownThoughDebugOutputIsOff) {
    gl().Disable(GL_DEBUG_OUTPUT);
    gl().Enable(0xDEAD);
    EXPECT_EQ(error(), "drawing the leaves: GL_INVALID_ENUM");
    context().check("the error is forgotten");
}

TEST_P(EachDebugContext, ThePassIsNamed) {
    FrameTimer timer(context());
    FrameTimer::Frame frame = timer.frame(false);
    {
        const auto pass = timer.pass("tidy the fragments", Phase::finalization);
        gl().Enable(0xDEAD);
    }
    frame.end();
    gl().Enable(0xDEAE);
    const std::string text = error();
    EXPECT_THAT(text, HasSubstr("tidy the fragments: GL_INVALID_ENUM"));
    EXPECT_EQ(text.find("tidy the fragments"), text.rfind("tidy the fragments")) << text;
}

TEST_P(EachDebugContext, LabelsStandBesideNumbers) {
    const Target target(gl(), 1);
    const std::string texture = "texture " + std::to_string(target.color.id());
    const std::string other = "buffer 4711";
    say(GL_DEBUG_TYPE_OTHER, GL_DEBUG_SEVERITY_HIGH, texture + " and " + other + " are at odds");
    EXPECT_THAT(error(), HasSubstr(texture + " 'target' and " + other + " are at odds"));
}

TEST_P(EachDebugContext, ADriversErrorNamesTheLabelledProgram) {
    if (context().device().renderer.find("llvmpipe") == std::string::npos) GTEST_SKIP() << "Mesa's wording";
    const Object<ProgramKind> program(gl(), gl().CreateProgram(), "half-made");
    gl().UseProgram(program.id());
    EXPECT_THAT(error(), HasSubstr("'half-made'"));
}

TEST_P(EachDebugContext, SeverityDecidesWhatIsKeptAndWhereItIsLogged) {
    const LogCapture log;
    say(GL_DEBUG_TYPE_OTHER, GL_DEBUG_SEVERITY_NOTIFICATION, "a notification");
    say(GL_DEBUG_TYPE_OTHER, GL_DEBUG_SEVERITY_LOW, "a low one");
    say(GL_DEBUG_TYPE_PORTABILITY, GL_DEBUG_SEVERITY_MEDIUM, "a medium one");
    say(GL_DEBUG_TYPE_PERFORMANCE, GL_DEBUG_SEVERITY_MEDIUM, "a slow path");
    context().check("none of these is kept");
    say(GL_DEBUG_TYPE_OTHER, GL_DEBUG_SEVERITY_HIGH, "a high one");
    EXPECT_THAT(error(), HasSubstr("a high one"));
    say(GL_DEBUG_TYPE_ERROR, GL_DEBUG_SEVERITY_LOW, "a low error");
    EXPECT_THAT(error(), AllOf(HasSubstr("a low error"), Not(HasSubstr("a high one"))));
    const std::string name = context().device().name;
    EXPECT_THAT(log.text(), Not(HasSubstr("a notification")));
    EXPECT_THAT(log.text(), HasSubstr("debug " + name + ": a low one"));
    EXPECT_THAT(log.text(), HasSubstr("warning " + name + ": a medium one"));
    EXPECT_THAT(log.text(), HasSubstr("debug " + name + ": a slow path"));
    EXPECT_THAT(log.text(), HasSubstr("error " + name + ": a high one"));
    EXPECT_THAT(log.text(), HasSubstr("error " + name + ": a low error"));
}

TEST_P(EachDebugContext, ALoopOfErrorsDoesNotFillTheMemory) {
    const LogCapture quiet;
    for (int i = 0; i < 1000; ++i) gl().Enable(0xDEAD);
    EXPECT_LT(error().size(), 16 * 256);
}

}  // namespace
}  // namespace sheer::gl::debug_test
