#include "server/storage/content_folder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "renderer/core/sha256.h"
#include "temporary_folder.h"

namespace sheer::test::content_folder_test {
namespace {

namespace fs = std::filesystem;

/// While it exists, no file of this process can grow past `bytes`, as on a full disk.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) {
        m_handler = std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &m_before);
        const rlimit limit{bytes, m_before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &m_before);
        std::signal(SIGXFSZ, m_handler);
    }

  private:
    rlimit m_before{};
    void (*m_handler)(int) = nullptr;
};

class ContentFolderTest : public testing::Test {
  protected:
    int count() const { return TemporaryFolder::count_files(m_folder.path()); }

    TemporaryFolder m_folder;
    ContentFolder m_blobs{m_folder.path() / "blobs"};
    // The hash of "abc" in FIPS 180-2, appendix B.1.
    const std::string m_abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
};

TEST_F(ContentFolderTest, KeepsBytesUnderTheirHash) {
    EXPECT_FALSE(m_blobs.find(m_abc));
    m_blobs.put(m_abc, "abc");
    ASSERT_TRUE(m_blobs.find(m_abc));
    EXPECT_EQ(*m_blobs.find(m_abc), m_folder.path() / "blobs" / "ba" / m_abc);
    EXPECT_EQ(read_all(*m_blobs.open(m_abc), 3), "abc");
    m_blobs.put(m_abc, "abc");
    EXPECT_EQ(count(), 1);
    m_blobs.remove(m_abc);
    m_blobs.remove(m_abc);
    EXPECT_FALSE(m_blobs.find(m_abc));
    // Nothing is left that takes an inode, and it can be stored again.
    EXPECT_TRUE(fs::is_empty(m_folder.path() / "blobs"));
    m_blobs.put(m_abc, "abc");
    EXPECT_TRUE(m_blobs.find(m_abc));
}

TEST_F(ContentFolderTest, RefusesBytesWithAnotherHash) {
    EXPECT_THROW(m_blobs.put(m_abc, "abd"), StoreError);
    EXPECT_EQ(count(), 0);
}

TEST_F(ContentFolderTest, AWriteThatFailsLeavesNothing) {
    const std::string bytes(100'000, 'x');
    const std::string sha256 = sha256_hex(bytes);
    {
        const FileSizeLimit full(50'000);
        EXPECT_THROW(m_blobs.put(sha256, bytes), StoreError);
    }
    EXPECT_FALSE(m_blobs.find(sha256));
    EXPECT_EQ(count(), 0);
    m_blobs.put(sha256, bytes);
    EXPECT_EQ(read_all(*m_blobs.open(sha256), bytes.size()), bytes);
}

TEST_F(ContentFolderTest, ATakenPlaceIsAnError) {
    fs::create_directories(m_folder.path() / "blobs");
    m_folder.file("blobs/ba", "a file where the folder should be");
    EXPECT_THROW(m_blobs.put(m_abc, "abc"), StoreError);
    EXPECT_FALSE(m_blobs.find(m_abc));
}

TEST_F(ContentFolderTest, NamesThatAreNotHashesFindNothing) {
    EXPECT_FALSE(m_blobs.find("../../etc/passwd"));
    EXPECT_FALSE(m_blobs.find(""));
    std::string upper = m_abc;
    upper[0] = 'B';
    EXPECT_FALSE(m_blobs.find(upper));
}

TEST_F(ContentFolderTest, LeftoversOfKilledWritersAreRemoved) {
    m_blobs.put(m_abc, "abc");
    m_folder.file("blobs/ba/" + m_abc + ".tmp-Ab12Cd", "ab");
    m_blobs.remove_leftovers(std::chrono::hours(1));
    EXPECT_EQ(count(), 2);  // it may still be written
    m_blobs.remove_leftovers(std::chrono::seconds(-1));
    EXPECT_EQ(count(), 1);
    EXPECT_TRUE(m_blobs.find(m_abc));
}

TEST_F(ContentFolderTest, AnOpenFileIsReadInPiecesAndSurvivesItsRemoval) {
    m_blobs.put(m_abc, "abc");
    const ContentPtr open = m_blobs.open(m_abc);
    m_blobs.remove(m_abc);
    EXPECT_EQ(open->size_bytes(), 3u);
    std::string piece(2, ' ');
    open->read(1, piece);
    EXPECT_EQ(piece, "bc");
    EXPECT_THROW(open->read(2, piece), StoreError);
    EXPECT_THROW(m_blobs.open(m_abc), DamagedData);
}

}  // namespace
}  // namespace sheer::test::content_folder_test
