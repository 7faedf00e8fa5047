#include "server/http/zip.h"

#include <gtest/gtest.h>

namespace sheer::zip_test {

namespace {

std::string part(const ContentPtr& content, std::uint64_t offset, std::size_t count) {
    std::string bytes(count, '\0');
    content->read(offset, bytes);
    return bytes;
}

/// The file that Info-ZIP's zip 3.0 makes of one file "a" with "123456789" is the same up to its times: the CRC of
/// these digits is 0xcbf43926 (the check value of CRC-32 in the catalogue of parametrised CRC algorithms).
TEST(Zip, OfOneFileIsAsTheFormatSays) {
    const ContentPtr zip = http::zip_of({{"a", http::content_of("123456789")}});
    const std::string facts("\x14\0\0\x08\0\0\0\0\x21\0\x26\x39\xf4\xcb\x09\0\0\0\x09\0\0\0\x01\0\0\0", 26);
    const std::string header = std::string("PK\x03\x04", 4) + facts + "a";
    const std::string directory =
        std::string("PK\x01\x02\x14\0", 6) + facts + std::string("\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 14) + "a";
    const std::string end =
        std::string("PK\x05\x06\0\0\0\0\x01\0\x01\0", 12) + std::string("\x2f\0\0\0\x28\0\0\0\0\0", 10);
    const std::string whole = header + "123456789" + directory + end;
    ASSERT_EQ(zip->size_bytes(), whole.size());
    EXPECT_EQ(read_all(*zip, 1000), whole);
    for (std::size_t begin = 0; begin < whole.size(); begin += 7)
        for (std::size_t count = 0; begin + count <= whole.size(); count += 5)
            EXPECT_EQ(part(zip, begin, count), whole.substr(begin, count)) << begin << " " << count;
}

TEST(Zip, MayHaveEmptyFilesAndNone) {
    EXPECT_EQ(http::zip_of({})->size_bytes(), 22u);
    const ContentPtr zip = http::zip_of({{"empty", http::content_of("")}, {"b", http::content_of("b")}});
    EXPECT_EQ(read_all(*zip, 1000).size(), 22u + 2 * (30 + 46) + 2 * 6 + 1);
}

}  // namespace

}  // namespace sheer::zip_test
