#include "renderer/report/provenance.h"

#include <gmock/gmock.h>

#include <fstream>

#include "temporary_folder.h"

namespace sheer::provenance_test {
namespace {

using nlohmann::json;

TEST(Provenance, TheDriverFollowsTheVersion) {
    EXPECT_EQ(driver_of("4.5 (Core Profile) Mesa 22.3.6"), "Mesa 22.3.6");
    EXPECT_EQ(driver_of("4.6.0 NVIDIA 535.183.01"), "NVIDIA 535.183.01");
    EXPECT_EQ(driver_of("4.6"), "");
    EXPECT_EQ(driver_of("4.5 (Core Profile)"), "");
    EXPECT_EQ(driver_of(""), "");
}

struct Governor : testing::Test {
    test::TemporaryFolder folder;
    void set(const std::string& cpu, const std::string& name) {
        const auto place = folder.path() / cpu / "cpufreq";
        std::filesystem::create_directories(place);
        std::ofstream(place / "scaling_governor") << name << "\n";
    }
};

TEST_F(Governor, EachIsNamedOnce) {
    set("cpu0", "powersave");
    set("cpu1", "performance");
    set("cpu2", "powersave");
    std::filesystem::create_directories(folder.path() / "cpuidle");
    EXPECT_EQ(governor(folder.path()), json({{"governor", "performance, powersave"}}));
}

TEST_F(Governor, WithoutOneThereIsAReason) {
    std::filesystem::create_directories(folder.path() / "cpu0");
    for (const auto& place : {folder.path(), folder.path() / "nowhere"}) {
        const json found = governor(place);
        EXPECT_TRUE(found["governor"].is_null());
        EXPECT_THAT(found["governor_reason"].get<std::string>(), testing::HasSubstr(place.string()));
    }
}

TEST(Provenance, TheLoadIsThreeMeans) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "loadavg";
    std::ofstream(file) << "1.75 1.50 0.25 3/412 9876\n";
    EXPECT_EQ(load_average(file), json({1.75, 1.5, 0.25}));
    std::ofstream(file) << "1.75 1.50\n";
    EXPECT_TRUE(load_average(file).is_null());
    EXPECT_TRUE(load_average(folder.path() / "nowhere").is_null());
}

}  // namespace
}  // namespace sheer::provenance_test
