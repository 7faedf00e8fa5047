#include "server/archive/disk_room.h"

#include <gmock/gmock.h>

#include "temporary_folder.h"

namespace sheer::test::disk_room_test {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kib = 1024, mib = 1024 * kib;

TEST(DiskRoomTest, ADiskIsFullBeforeItsLastByte) {
    const auto lack = [](std::uint64_t total, std::uint64_t free) {
        return lack_of_room(DiskSpace{.total_bytes = total, .free_bytes = free});
    };
    EXPECT_EQ(lack(mib, 256 * kib), "");
    EXPECT_THAT(lack(mib, 256 * kib - 1), HasSubstr("255 KiB left but needs 256 KiB"));
    EXPECT_EQ(lack(100 * 1024 * mib, 32 * mib), "");
    EXPECT_NE(lack(100 * 1024 * mib, 32 * mib - 1), "");
    EXPECT_NE(lack(64 * mib, 0), "");
}

TEST(DiskRoomTest, SoIsOneWithoutInodes) {
    const auto lack = [](std::uint64_t total, std::uint64_t free) {
        return lack_of_room(
            DiskSpace{.total_bytes = mib, .free_bytes = mib, .total_inodes = total, .free_inodes = free});
    };
    EXPECT_EQ(lack(80, 10), "");
    EXPECT_THAT(lack(80, 9), HasSubstr("inodes"));
    EXPECT_NE(lack(1'000'000, 63), "");
    EXPECT_EQ(lack(1'000'000, 64), "");
    EXPECT_EQ(lack(0, 0), "");  // a file system that does not count inodes
}

TEST(DiskRoomTest, TheReserveIsMadeAndReleased) {
    const TemporaryFolder folder;
    DiskRoom room(DataFolder{folder.path()});
    room.restore_reserve();
    const auto reserve = DataFolder{folder.path()}.reserve();
    ASSERT_TRUE(std::filesystem::exists(reserve));
    EXPECT_GE(std::filesystem::file_size(reserve), 96 * kib);
    EXPECT_TRUE(room.give_up_reserve());
    EXPECT_FALSE(std::filesystem::exists(reserve));
    EXPECT_FALSE(room.give_up_reserve());
    room.restore_reserve();
    EXPECT_TRUE(std::filesystem::exists(reserve));
}

}  // namespace
}  // namespace sheer::test::disk_room_test
