#include <stdexcept>

#include "renderer/gl/context_kinds.h"
#include "tests/gl/fake_driver.h"
#include "tests/gl/gl_test.h"

// Which of several devices is chosen, on machines that this one is not.
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
    EXPECT_THAT(refusal({"egl", "osmesa:0", {}}, egl_with_gpus), HasSubstr("there is none of that name"));
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

}  // namespace
}  // namespace sheer::gl::create_context_test
