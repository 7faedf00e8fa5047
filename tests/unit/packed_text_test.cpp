#include "server/storage/packed_text.h"

#include <gtest/gtest.h>

#include "server/archive/sqlite_functions.h"
#include "server/jobs/store_errors.h"

namespace sheer::test::packed_text_test {
namespace {

TEST(PackedText, IsReadAgain) {
    for (const std::string& text :
         {std::string(), std::string("a"), std::string(100'000, 'x'), std::string("\0\xff", 2)})
        EXPECT_EQ(unpack_text(pack_text(text), 100'000), text);
}

TEST(PackedText, IsSmallerThanARepetitiveText) {
    EXPECT_LT(pack_text(std::string(100'000, 'x')).size(), 1000u);
}

TEST(PackedText, NumbersAreKeptAsTheyAreUnlessCompressingHalvesThem) {
    std::string hardly;
    for (std::uint32_t i = 0, state = 1; i < 4'000; ++i, state = state * 1664525 + 1013904223)
        hardly += static_cast<char>(state >> 24);
    const std::string packed = pack_numbers(hardly);
    EXPECT_NE(packed.find(hardly), std::string::npos);
    EXPECT_EQ(unpack_text(packed, 4'000), hardly);
    EXPECT_EQ(pack_numbers(std::string(4'000, '\0')), pack_text(std::string(4'000, '\0')));
    std::string flipped = packed;
    flipped[2'000] = static_cast<char>(flipped[2'000] ^ 1);
    EXPECT_THROW(unpack_text(flipped, 4'000), DamagedData);
}

TEST(PackedText, DamageIsNoticed) {
    const std::string packed = pack_text("a report, a report, a report");
    EXPECT_THROW(unpack_text("", 100), DamagedData);
    EXPECT_THROW(unpack_text(packed.substr(0, packed.size() - 1), 100), DamagedData);
    for (std::size_t at = 0; at < packed.size(); ++at) {
        std::string flipped = packed;
        flipped[at] = static_cast<char>(flipped[at] ^ 4);
        try {
            EXPECT_EQ(unpack_text(flipped, 100), "a report, a report, a report") << at;
        } catch (const DamagedData&) {
            continue;
        }
    }
    EXPECT_THROW(unpack_text(packed, 27), DamagedData);
    EXPECT_EQ(unpack_text(packed, 28).size(), 28u);
}

TEST(Places, GrowWithTheTimeInAnId) {
    // 0x0190'0000'0000 ms, count 0x123.
    EXPECT_EQ(place_of("01900000-0000-7123-8000-0123456789ab"), 0x0190'0000'0000'123);
    EXPECT_EQ(place_at(0x0190'0000'0000), 0x0190'0000'0000'000);
    EXPECT_LT(place_of("01900000-0000-7fff-8fff-ffffffffffff"), place_of("01900000-0001-7000-8000-000000000000"));
    EXPECT_EQ(place_of("not an id"), 0);
}

}  // namespace
}  // namespace sheer::test::packed_text_test
