#include "renderer/gl/workarounds.h"

#include <set>
#include <stdexcept>

#include "tests/gl/gl_test.h"

namespace sheer::gl::workarounds_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

DeviceInfo device(std::string renderer) {
    DeviceInfo info;
    info.name = "egl:0";
    info.renderer = std::move(renderer);
    return info;
}

TEST(Workarounds, EachHasANameOfItsOwnAndAParagraph) {
    std::set<std::string_view> names;
    for (const Workaround& workaround : known_workarounds()) {
        EXPECT_TRUE(names.insert(workaround.name).second) << workaround.name;
        EXPECT_GT(workaround.paragraph.size(), 80) << workaround.name;
        EXPECT_TRUE(workaround.paragraph.ends_with(".")) << workaround.name;
    }
    EXPECT_TRUE(names.contains("flush-timer-queries"));
}

TEST(Workarounds, TimerQueriesAreFlushedOnLlvmpipeOnly) {
    EXPECT_THAT(Workarounds(device("llvmpipe (LLVM 15.0.6, 256 bits)"), {}).names(),
                ElementsAre("flush-timer-queries"));
    EXPECT_THAT(Workarounds(device("AMD Radeon Graphics"), {}).names(), ElementsAre());
}

TEST(Workarounds, ProgramsAreKeptOnNvidiaOnly) {
    DeviceInfo nvidia = device("NVIDIA H100 80GB HBM3/PCIe/SSE2");
    nvidia.vendor = "NVIDIA Corporation";
    EXPECT_THAT(Workarounds(nvidia, {}).names(), ElementsAre("keep-programs"));
    EXPECT_THAT(Workarounds(device("AMD Radeon Graphics"), {}).names(), ElementsAre());
}

TEST(Workarounds, OneInUseIsLogged) {
    const LogCapture log;
    const Workarounds in_use(device("llvmpipe (LLVM 15.0.6, 256 bits)"), {});
    EXPECT_TRUE(in_use.has("flush-timer-queries"));
    EXPECT_FALSE(in_use.has("flush-timer"));
    EXPECT_THAT(log.text(), HasSubstr("info egl:0: workaround flush-timer-queries in use"));
}

TEST(Workarounds, OneThatIsOffIsNotInUse) {
    const LogCapture log;
    const std::vector<std::string> disabled{"flush-timer-queries"};
    EXPECT_FALSE(Workarounds(device("llvmpipe"), disabled).has("flush-timer-queries"));
    EXPECT_THAT(log.text(), HasSubstr("flush-timer-queries applies but is off"));
}

TEST(Workarounds, AnUnknownNameIsRefusedWithTheKnownOnes) {
    const std::vector<std::string> disabled{"flush-timer-querys"};
    EXPECT_THAT(message_of<std::invalid_argument>([&] { Workarounds(device("llvmpipe"), disabled); }),
                testing::AllOf(HasSubstr("'flush-timer-querys'"), HasSubstr("flush-timer-queries")));
}

}  // namespace
}  // namespace sheer::gl::workarounds_test
