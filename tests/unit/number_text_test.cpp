#include "renderer/core/number_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace sheer::number_text_test {
namespace {

TEST(NumberText, HasThreeDigitsAndNoExponent) {
    EXPECT_EQ(number_text(0.01736245740856606), "0.0174");
    EXPECT_EQ(number_text(1600), "1600");
    EXPECT_EQ(number_text(1612.7), "1613");
    EXPECT_EQ(number_text(123456789), "123456789");
    EXPECT_EQ(number_text(165.58), "166");
    EXPECT_EQ(number_text(18.07), "18.1");
    EXPECT_EQ(number_text(1.4), "1.4");
    EXPECT_EQ(number_text(2), "2");
    EXPECT_EQ(number_text(-0.5), "-0.5");
    EXPECT_EQ(number_text(0), "0");
    EXPECT_EQ(number_text(0.00001234), "0.0000123");
    EXPECT_EQ(number_text(0.9999), "1");
    EXPECT_EQ(number_text(0.0093, 2), "0.0093");
    EXPECT_EQ(number_text(99.97), "100");
    // Too small to be read as a row of zeros.
    EXPECT_EQ(number_text(1.234e-12), "1.23e-12");
    EXPECT_EQ(number_text(1.234e20), "1.23e+20");
    EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "inf");
}

TEST(NumberText, NearALimitHasEnoughDigitsToDistinguishThem) {
    EXPECT_EQ(number_text_beside(0.0174, 0.05), "0.0174");
    EXPECT_EQ(number_text_beside(0.05003, 0.05), "0.05003");
    EXPECT_EQ(number_text_beside(0.049996, 0.05), "0.049996");
    EXPECT_EQ(number_text_beside(1.1999999, 1.2), "1.1999999");
    EXPECT_EQ(number_text_beside(0.05, 0.05), "0.05");
    EXPECT_EQ(number_text_beside(std::nextafter(0.05, 1), 0.05), "0.05000000000000001");
    std::mt19937 random(3);
    std::uniform_real_distribution<double> limits(0.001, 5000), shares(-12, 0);
    for (int i = 0; i < 2000; ++i) {
        const double limit = limits(random), value = limit * (1 + (i % 2 ? 1 : -1) * std::pow(10, shares(random)));
        const double shown = std::stod(number_text_beside(value, limit));
        EXPECT_EQ(shown < limit, value < limit) << value << " compared with " << limit;
        EXPECT_EQ(shown > limit, value > limit) << value << " compared with " << limit;
    }
}

TEST(NumberText, InFullRoundTrips) {
    EXPECT_EQ(full_number_text(1000000), "1000000");
    EXPECT_EQ(full_number_text(0.0000001), "0.0000001");
    EXPECT_EQ(full_number_text(0.1), "0.1");
    std::mt19937 random(5);
    std::uniform_real_distribution<double> exponents(-20, 20);
    for (int i = 0; i < 1000; ++i) {
        const double value = std::pow(10, exponents(random));
        EXPECT_EQ(std::stod(full_number_text(value)), value);
    }
}

}  // namespace
}  // namespace sheer::number_text_test
