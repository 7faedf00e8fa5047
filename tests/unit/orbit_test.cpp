#include "server/view/orbit.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace sheer::view::orbit_test {

namespace {

using nlohmann::json;

const json camera = {{"eye", {1, 2, 7}}, {"target", {1, 2, 3}}, {"up", {0, 2, 0}}, {"fov_y_deg", 40}};
constexpr double right_angle = std::numbers::pi / 2;

void expect_eye(const json& moved, const std::array<double, 3>& eye) {
    const auto actual = moved.at("eye").get<std::array<double, 3>>();
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], eye[i], 1e-12) << moved;
    EXPECT_EQ(moved.at("target"), json({1.0, 2.0, 3.0}));
    EXPECT_EQ(moved.at("fov_y_deg"), 40);
}

/// Four in front of the target, and after a right angle four to its right.
TEST(Orbit, TurnsAboutTheUpAxis) {
    expect_eye(orbited(camera, 0, 0), {1, 2, 7});
    expect_eye(orbited(camera, right_angle, 0), {5, 2, 3});
    expect_eye(orbited(camera, -right_angle, 0), {-3, 2, 3});
}

TEST(Orbit, RisesButNotOverTheTop) {
    const double half = 4 * std::sqrt(0.5);
    expect_eye(orbited(camera, 0, right_angle / 2), {1, 2 + half, 3 + half});
    const double angle = 89 * right_angle / 90;
    expect_eye(orbited(camera, 0, 10), {1, 2 + 4 * std::sin(angle), 3 + 4 * std::cos(angle)});
    expect_eye(orbited(camera, 0, -10), {1, 2 - 4 * std::sin(angle), 3 + 4 * std::cos(angle)});
}

TEST(Orbit, KeepsItsDistanceUntilItIsMovedAway) {
    expect_eye(moved_away(camera, 0.5), {1, 2, 5});
    // It comes no nearer than a billionth of the target's distance from the origin.
    expect_eye(moved_away(camera, 1e-30), {1, 2, 3 + 1e-9 * std::sqrt(14.0)});
    expect_eye(moved_away(orbited(camera, right_angle, 0), 2), {9, 2, 3});
}

}  // namespace

}  // namespace sheer::view::orbit_test
