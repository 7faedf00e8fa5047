#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include "renderer/gl/context_kinds.h"
#include "renderer/gl/forked.h"
#include "tests/gl/fake_driver.h"
#include "tests/gl/gl_test.h"

// Which of several devices is chosen, on simulated machines.
namespace sheer::gl::create_context_test {
namespace {

using testing::HasSubstr;

struct Llvmpipe {
    static constexpr GLint major = 4, minor = 5;
    static constexpr const char* renderer = "llvmpipe (LLVM 15.0.6, 256 bits)";
};
struct Nvidia {
    static constexpr GLint major = 4, minor = 6;
    static constexpr const char* renderer = "NVIDIA H200/PCIe/SSE2";
};
struct Radeon {
    static constexpr GLint major = 4, minor = 6;
    static constexpr const char* renderer = "AMD Radeon Pro W7900";
};
struct Old {
    static constexpr GLint major = 3, minor = 3;
    static constexpr const char* renderer = "Old GPU";
};

template <typename Device>
class FakeContext final : public Context {
  public:
    FakeContext(const DeviceInfo& info, const ContextRequest& request) {
        initialize(&FakeDriver<Device>::resolve, info, request);
    }
    void make_current() override {}
};

DeviceInfo info(std::string context, int index) {
    DeviceInfo device;
    device.name = context + ":" + std::to_string(index);
    device.context = std::move(context);
    device.index = index;
    return device;
}

template <typename Device>
Candidate fake(std::string context, int index, Expectation expectation) {
    return {info(std::move(context), index), expectation, [](const DeviceInfo& device, const ContextRequest& request) {
                return std::make_unique<FakeContext<Device>>(device, request);
            }};
}

Candidate broken(std::string context, int index, Expectation expectation) {
    return {info(std::move(context), index), expectation,
            [](const DeviceInfo&, const ContextRequest&) -> std::unique_ptr<Context> {
                throw Unsupported("permission denied");
            }};
}

/// A machine whose EGL lists the software device first, as glvnd does when Mesa's file sorts before NVIDIA's.
std::vector<Candidate> egl_with_gpus() {
    return {fake<Llvmpipe>("egl", 0, Expectation::software), broken("egl", 1, Expectation::gpu),
            fake<Llvmpipe>("egl", 2, Expectation::gpu),      fake<Nvidia>("egl", 3, Expectation::gpu),
            fake<Radeon>("egl", 4, Expectation::gpu),        fake<Llvmpipe>("egl", 5, Expectation::last_resort)};
}
std::vector<Candidate> egl_with_locked_gpu() {
    return {broken("egl", 0, Expectation::gpu), fake<Llvmpipe>("egl", 1, Expectation::software),
            broken("egl", 2, Expectation::last_resort)};
}
std::vector<Candidate> egl_without_devices() {
    return {fake<Llvmpipe>("egl", 0, Expectation::last_resort)};
}
std::vector<Candidate> egl_too_old() {
    return {fake<Old>("egl", 0, Expectation::gpu)};
}
std::vector<Candidate> osmesa() {
    return {fake<Llvmpipe>("osmesa", 0, Expectation::software)};
}
std::vector<Candidate> glfw() {
    return {fake<Radeon>("glfw", 0, Expectation::gpu)};
}

struct Row {
    const char* title;
    std::vector<Candidate> (*egl)();
    ContextRequest request;
    const char* chosen;
};

class ChooseDevice : public testing::TestWithParam<Row> {};

INSTANTIATE_TEST_SUITE_P(
    Gl, ChooseDevice,
    testing::Values(Row{"AutoPrefersAGpu", egl_with_gpus, {"auto", "", {}}, "egl:3"},
                    Row{"EglPrefersAGpu", egl_with_gpus, {"egl", "", {}}, "egl:3"},
                    Row{"ByIndex", egl_with_gpus, {"egl", "4", {}}, "egl:4"},
                    Row{"ByIndexOfSoftware", egl_with_gpus, {"egl", "5", {}}, "egl:5"},
                    Row{"ByName", egl_with_gpus, {"auto", "egl:0", {}}, "egl:0"},
                    Row{"ByNameOfAnotherKind", egl_with_gpus, {"auto", "OSMesa:0", {}}, "osmesa:0"},
                    Row{"ByPartOfTheRenderer", egl_with_gpus, {"auto", "radeon", {}}, "egl:4"},
                    Row{"ByPartOfTheRendererInCapitals", egl_with_gpus, {"egl", "H200", {}}, "egl:3"},
                    Row{"SoftwareByPartOfTheRenderer", egl_with_gpus, {"osmesa", "llvmpipe", {}}, "osmesa:0"},
                    Row{"SoftwareIfTheGpuFails", egl_with_locked_gpu, {"auto", "", {}}, "egl:1"},
                    Row{"SurfacelessIfThereIsNoDevice", egl_without_devices, {"auto", "", {}}, "egl:0"},
                    Row{"OsmesaIfEglFails", egl_too_old, {"auto", "", {}}, "osmesa:0"},
                    Row{"GlfwOnlyIfAskedFor", egl_too_old, {"glfw", "", {}}, "glfw:0"}),
    [](const testing::TestParamInfo<Row>& row) { return row.param.title; });

TEST_P(ChooseDevice, AsExpected) {
    const std::array kinds{Kind{"egl", GetParam().egl, true}, Kind{"osmesa", osmesa, true}, Kind{"glfw", glfw, false}};
    EXPECT_EQ(create_context(GetParam().request, kinds)->device().name, GetParam().chosen);
}

std::string refusal(const ContextRequest& request, std::vector<Candidate> (*egl)()) {
    const std::array kinds{Kind{"egl", egl, true}, Kind{"osmesa", osmesa, true}};
    return message_of<Unsupported>([&] { create_context(request, kinds); });
}

TEST(ChooseDevice, RefusalsGiveEachReason) {
    EXPECT_THAT(refusal({"egl", "", {}}, egl_too_old), HasSubstr("egl:0 (): the driver has OpenGL 3.3"));
    EXPECT_THAT(refusal({"egl", "1", {}}, egl_with_gpus), HasSubstr("egl:1 (): permission denied"));
    EXPECT_THAT(refusal({"egl", "9", {}}, egl_with_gpus), HasSubstr("'9'"));
    EXPECT_THAT(refusal({"egl", "osmesa:0", {}}, egl_with_gpus), HasSubstr("there is none with that name"));
    const std::string none = refusal({"auto", "GeForce", {}}, egl_with_gpus);
    for (const char* reason :
         {"'GeForce'", "egl:1 (): permission denied", "egl:3 is NVIDIA H200/PCIe/SSE2", "osmesa:0 is llvmpipe"}) {
        EXPECT_THAT(none, HasSubstr(reason));
    }
}

TEST(ChooseDevice, WrongNamesAreTheCallersMistake) {
    EXPECT_THAT(message_of<std::invalid_argument>([] {
                    create_context({"vulkan", "", {}});
                }),
                testing::AllOf(HasSubstr("'vulkan'"), HasSubstr("auto, egl, osmesa, glfw")));
    EXPECT_THAT(message_of<std::invalid_argument>([] {
                    create_context({"auto", "", {"flush-timer"}});
                }),
                HasSubstr("'flush-timer'"));
}

TEST(ChooseDevice, SoftwareIsToldFromAGpu) {
    EXPECT_TRUE(FakeContext<Llvmpipe>({}, {}).device().software);
    EXPECT_FALSE(FakeContext<Nvidia>({}, {}).device().software);
}

/// A driver that crashes the process, or never answers.
Candidate fatal(std::string context, int index, Expectation expectation, void (*how)()) {
    return {info(std::move(context), index), expectation,
            [how](const DeviceInfo&, const ContextRequest&) -> std::unique_ptr<Context> {
                how();
                throw Unsupported("still alive");
            }};
}
void crash() {
    std::raise(SIGSEGV);
}
void leave() {
    _exit(0);
}
void hang() {
    while (true) pause();
}

std::vector<Candidate> egl_that_crashes() {
    return {fatal("egl", 0, Expectation::gpu, crash), fake<Nvidia>("egl", 1, Expectation::gpu)};
}
std::vector<Candidate> egl_that_crashes_in_all_ways() {
    return {fatal("egl", 0, Expectation::gpu, crash), fatal("egl", 1, Expectation::gpu, std::abort),
            fatal("egl", 2, Expectation::software, hang)};
}

using namespace std::chrono_literals;

TEST(OpenDevice, GoesOnWhereADriverCrashes) {
    const std::array kinds{Kind{"egl", egl_that_crashes, true}, Kind{"osmesa", osmesa, true}};
    EXPECT_EQ(open_device({"auto", "", {}}, kinds)->device().name, "egl:1");
    EXPECT_EQ(open_device({"osmesa", "", {}}, kinds)->device().name, "osmesa:0");
    const std::string refusal = message_of<Unsupported>([&] { open_device({"egl", "0", {}}, kinds); });
    EXPECT_THAT(refusal, HasSubstr("egl:0 (): its driver crashed (signal 11)"));
}

TEST(OpenDevice, GoesOnFromCrashToAbortToHangToTheNextKind) {
    const std::array kinds{Kind{"egl", egl_that_crashes_in_all_ways, true}, Kind{"osmesa", osmesa, true}};
    EXPECT_EQ(open_device({"auto", "", {}}, kinds, 500ms)->device().name, "osmesa:0");
    const std::array only{Kind{"egl", egl_that_crashes_in_all_ways, true}};
    const std::string refusal = message_of<Unsupported>([&] { open_device({"auto", "", {}}, only, 500ms); });
    for (const char* reason : {"egl:0 (): its driver crashed (signal 11)", "egl:1 (): its driver crashed (signal 6)",
                               "egl:2 (): its driver gave no answer within 500 ms"})
        EXPECT_THAT(refusal, HasSubstr(reason));
}

TEST(OpenDevice, ChoosesAsCreateContextDoes) {
    const std::array kinds{Kind{"egl", egl_with_gpus, true}, Kind{"osmesa", osmesa, true}};
    for (const ContextRequest& request :
         {ContextRequest{"auto", "", {}}, ContextRequest{"egl", "4", {}}, ContextRequest{"auto", "radeon", {}}})
        EXPECT_EQ(open_device(request, kinds)->device().name, create_context(request, kinds)->device().name);
    EXPECT_EQ(message_of<Unsupported>([&] {
                  open_device({"auto", "GeForce", {}}, kinds);
              }),
              message_of<Unsupported>([&] {
                  create_context({"auto", "GeForce", {}}, kinds);
              }));
    EXPECT_THROW(open_device({"vulkan", "", {}}, kinds), std::invalid_argument);
}

TEST(OpenDevice, AWindowsDriverMustBeSound) {
    const std::array crashing{Kind{"egl", egl_that_crashes, true}};
    EXPECT_THAT(message_of<Unsupported>([&] {
                    require_sound({"egl", "", {}}, crashing);
                }),
                HasSubstr("egl:0: its driver crashed"));
    const std::array sound{Kind{"osmesa", osmesa, true}};
    EXPECT_NO_THROW(require_sound({"osmesa", "", {}}, sound));
}

TEST(ListDevices, ACrashIsThatDevicesLine) {
    const std::array kinds{Kind{"egl", egl_that_crashes, true}, Kind{"broken", egl_with_locked_gpu, true},
                           Kind{"osmesa", osmesa, true}};
    const std::vector<ListedDevice> all = list_devices(kinds);
    ASSERT_EQ(all.size(), 6u);
    EXPECT_EQ(all[0].info.name, "egl:0");
    EXPECT_EQ(all[0].error, "its driver crashed (signal 11)");
    EXPECT_EQ(all[1].info.renderer, Nvidia::renderer);
    EXPECT_FALSE(all[1].error.has_value());
    EXPECT_FALSE(all[1].info.software);
    EXPECT_EQ(all[2].error, "permission denied");
    EXPECT_TRUE(all[3].info.software);
    EXPECT_EQ(all[5].info.name, "osmesa:0");
    EXPECT_EQ(all[5].info.gl_version, "4.5");
}

TEST(ListDevices, ADriverThatHangsIsStopped) {
    const std::array kinds{Kind{"egl", egl_that_crashes_in_all_ways, true}, Kind{"osmesa", osmesa, true}};
    const std::vector<ListedDevice> all = list_devices(kinds, 500ms);
    ASSERT_EQ(all.size(), 4u);
    EXPECT_EQ(all[1].error, "its driver crashed (signal 6)");
    EXPECT_EQ(all[2].error, "its driver gave no answer within 500 ms");
    EXPECT_EQ(all[3].info.renderer, Llvmpipe::renderer);
}

TEST(RunForked, TellsHowItEnded) {
    const auto greet = [](const Say& say) { say("hello"); };
    EXPECT_EQ(run_forked(greet, 10s).lines, std::vector<std::string>{"hello"});
    EXPECT_EQ(run_forked(greet, 10s).trouble, "");
    EXPECT_EQ(run_forked([](const Say&) { leave(); }, 10s).trouble, "");
    EXPECT_EQ(run_forked([](const Say&) { throw std::runtime_error("x"); }, 10s).trouble,
              "ended the process (exit code 1)");
    const ForkedRun late = run_forked(
        [](const Say& say) {
            say("before");
            hang();
        },
        300ms);
    EXPECT_EQ(late.lines, std::vector<std::string>{"before"});
    EXPECT_EQ(late.trouble, "gave no answer within 300 ms");
}

}  // namespace
}  // namespace sheer::gl::create_context_test
