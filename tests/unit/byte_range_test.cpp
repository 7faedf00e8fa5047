#include "server/http/byte_range.h"

#include <gtest/gtest.h>

#include "server/http/zip.h"

namespace sheer::byte_range_test {

namespace {

using http::byte_range, http::ByteRange;

/// The examples of RFC 9110, 14.1.2, of 10000 bytes.
TEST(ByteRanges, AreReadAsTheRfcSays) {
    EXPECT_EQ(byte_range("bytes=0-499", 10000), (ByteRange{0, 500}));
    EXPECT_EQ(byte_range("bytes=500-999", 10000), (ByteRange{500, 1000}));
    EXPECT_EQ(byte_range("bytes=-500", 10000), (ByteRange{9500, 10000}));
    EXPECT_EQ(byte_range("bytes=9500-", 10000), (ByteRange{9500, 10000}));
    EXPECT_EQ(byte_range("bytes=9500-20000", 10000), (ByteRange{9500, 10000}));
    EXPECT_EQ(byte_range("bytes=-20000", 10000), (ByteRange{0, 10000}));
}

TEST(ByteRanges, ThatDoNotExistAreEmptyAndOthersAreIgnored) {
    EXPECT_EQ(byte_range("bytes=10000-", 10000), ByteRange{});
    EXPECT_EQ(byte_range("bytes=0-", 0), ByteRange{});
    for (const char* field : {"", "bytes", "bytes=", "bytes=-", "bytes=2-1", "bytes=a-b", "bytes=0-1,5-6", "lines=0-1",
                              "bytes=0-1x", "bytes=99999999999999999999999-"})
        EXPECT_FALSE(byte_range(field, 10)) << field;
}

TEST(ByteRanges, ASliceHasTheBytesOfItsRange) {
    const ContentPtr slice = http::slice_of(http::content_of("0123456789"), {3, 7});
    EXPECT_EQ(read_all(*slice, 10), "3456");
    std::string part(2, '\0');
    slice->read(1, part);
    EXPECT_EQ(part, "45");
}

}  // namespace

}  // namespace sheer::byte_range_test
