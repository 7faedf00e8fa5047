#include "renderer/core/files.h"

#include <gmock/gmock.h>

#include "renderer/core/errors.h"
#include "temporary_folder.h"

namespace sheer::test::files_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class FilesTest : public testing::Test {
  protected:
    TemporaryFolder m_folder;
    const std::filesystem::path m_file = m_folder.path() / "file";
};

TEST_F(FilesTest, WrittenFilesCanBeRead) {
    for (const std::string& bytes : {std::string(), std::string("a\0\n\r", 4), std::string(200'000, 'x')}) {
        write_file(m_file, bytes);
        EXPECT_EQ(read_file(m_file), bytes);
        EXPECT_EQ(read_file(m_file, bytes.size()), bytes);
    }
    EXPECT_THAT([this] { read_file(m_file, 199'999); },
                ThrowsMessage<std::runtime_error>(HasSubstr(m_file.string() + " has more than 199999 bytes")));
}

TEST_F(FilesTest, AnUnreadableFileIsNamed) {
    EXPECT_THAT([this] { read_file(m_file); }, ThrowsMessage<std::runtime_error>(HasSubstr(m_file.string())));
    EXPECT_THAT([this] { read_file(m_folder.path()); }, ThrowsMessage<std::system_error>(HasSubstr("Is a directory")));
}

TEST_F(FilesTest, AFailedWriteSaysWhy) {
    EXPECT_THAT([this] { write_file(m_folder.path() / "none" / "file", "x"); },
                ThrowsMessage<WriteError>(HasSubstr("No such file or directory")));
    try {
        write_file("/dev/full", "x");
        FAIL() << "the room is unlimited";
    } catch (const WriteError& error) {
        EXPECT_TRUE(error.is_full());
    }
}

}  // namespace
}  // namespace sheer::test::files_test
