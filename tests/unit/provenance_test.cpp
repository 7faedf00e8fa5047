#include "renderer/report/provenance.h"

#include <gmock/gmock.h>

#include <fstream>

#include "temporary_folder.h"

namespace sheer::provenance_test {
namespace {

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
    EXPECT_EQ(governor(folder.path()).value, "performance, powersave");
}

TEST_F(Governor, WithoutOneThereIsAReason) {
    std::filesystem::create_directories(folder.path() / "cpu0");
    for (const auto& place : {folder.path(), folder.path() / "nowhere"}) {
        const auto found = governor(place);
        EXPECT_FALSE(found);
        EXPECT_THAT(found.reason, testing::HasSubstr(place.string()));
    }
}

TEST(Provenance, TheLoadIsThreeMeans) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "loadavg";
    std::ofstream(file) << "1.75 1.50 0.25 3/412 9876\n";
    EXPECT_EQ(load_average(file), (report::LoadAverage{1.75, 1.5, 0.25}));
    std::ofstream(file) << "1.75 1.50\n";
    EXPECT_FALSE(load_average(file));
    EXPECT_FALSE(load_average(folder.path() / "nowhere"));
}

}  // namespace
}  // namespace sheer::provenance_test
