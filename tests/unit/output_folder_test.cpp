// Reports are written into a folder completely or not at all, and the user's files there are never changed.
#include "server/cli/output_folder.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <fstream>
#include <map>

#include "renderer/command/command.h"
#include "renderer/core/files.h"
#include "tests/unit/temporary_folder.h"

namespace sheer::cli::output_folder_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

using Files = std::map<std::string, std::string>;

void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
}

/// Every file below a folder with its text; links with their targets.
Files files_below(const fs::path& folder) {
    Files files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = fs::relative(entry.path(), folder).generic_string();
        if (entry.is_symlink()) {
            files[name] = "-> " + fs::read_symlink(entry.path()).string();
        } else if (entry.is_regular_file()) {
            files[name] = read_file(entry.path());
        }
    }
    return files;
}

class OutputFolderTest : public testing::Test {
  protected:
    static OutputNames names() { return {"report.json", {"report.html"}, {"1-b2f", "overdraw"}}; }

    void fill(const OutputFolder& folder, const Files& files) {
        for (const auto& [name, text] : files) write(folder.partial() / name, text);
    }
    /// Writes a complete report with these files.
    void make(const Files& files, bool complete = true) {
        OutputFolder folder(m_out, names());
        fill(folder, files);
        folder.commit(complete);
    }
    /// The contents of the folder except the manifest.
    Files found() const {
        Files files = files_below(m_out);
        EXPECT_EQ(files.erase(Manifest::file_name), 1u);
        return files;
    }
    std::string refusal(const OutputNames& of = names()) const {
        try {
            const OutputFolder folder(m_out, of);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    }
    /// Expects a refusal with this in the message, and unchanged files.
    void expect_refusal(const std::string& message) const {
        const Files before = files_below(m_root.path());
        EXPECT_THAT(refusal(), HasSubstr(message));
        EXPECT_EQ(files_below(m_root.path()), before);
    }

    const test::TemporaryFolder m_root;
    const fs::path m_out = m_root.path() / "out";
};

const Files first = {
    {"report.json", "1"}, {"report.html", "one"}, {"images/1-b2f.color.png", "a"}, {"images/overdraw.png", "b"}};
const Files second = {{"report.json", "2"}, {"report.html", "two"}, {"images/1-b2f.color.png", "c"}};

TEST_F(OutputFolderTest, AReportReplacesAnOlderOneAndNothingElse) {
    make(first);
    EXPECT_EQ(found(), first);
    write(m_out / "notes.txt", "mine");
    write(m_out / ".git/HEAD", "ref");
    write(m_out / "images/holiday.png", "sun");
    make(second);
    Files expected = second;
    expected.merge(Files{{"notes.txt", "mine"}, {".git/HEAD", "ref"}, {"images/holiday.png", "sun"}});
    EXPECT_EQ(found(), expected) << "overdraw.png belonged to the older report and is removed";
}

TEST_F(OutputFolderTest, MissingFoldersAreMadeAndRemovedAgainIfUnused) {
    const fs::path deep = m_root.path() / "a/b/../b/c/";
    { const OutputFolder folder(deep, names()); }
    EXPECT_FALSE(fs::exists(m_root.path() / "a"));
    {
        OutputFolder folder(deep, names());
        fill(folder, second);
        EXPECT_EQ(fs::weakly_canonical(folder.commit()), fs::weakly_canonical(m_root.path() / "a/b/c"));
    }
    EXPECT_TRUE(fs::exists(m_root.path() / "a/b/c/report.json"));
    EXPECT_FALSE(fs::exists(m_root.path() / "a/b/c/.sheer-partial"));
}

TEST_F(OutputFolderTest, FilesOfTheUserAreRefusedBeforeAnythingIsDone) {
    for (const char* name : {"report.json", "report.html", "images/1-b2f.color.png", "images/overdraw.png", "images",
                             ".sheer-manifest.json", ".sheer-partial", ".sheer-partial/new/mine"}) {
        write(m_out / "src/main.c", "int main;");
        write(m_out / name, "{}");
        expect_refusal(std::string(name).substr(0, 14));
        fs::remove_all(m_out);
    }
    write(m_out / "images/1-b2f2.png", "another name");
    write(m_out / "report.json.bak", "another name");
    EXPECT_EQ(refusal(), "");
}

TEST_F(OutputFolderTest, ChangedFilesBelongToTheUser) {
    make(first);
    write(m_out / "report.json", "edited");
    expect_refusal("report.json already exists");
    write(m_out / "report.json", first.at("report.json"));
    write(m_out / "images/overdraw.png", "painted over");
    // The next report has no picture with this name, so it is not in the way.
    OutputFolder folder(m_out, {"report.json", {"report.html"}, {"1-b2f"}});
    fill(folder, second);
    folder.commit();
    Files expected = second;
    expected.merge(Files{{"images/overdraw.png", "painted over"}});
    EXPECT_EQ(found(), expected);
}

TEST_F(OutputFolderTest, LinksAreNeverFollowed) {
    const fs::path elsewhere = m_root.path() / "elsewhere";
    make(first);
    write(elsewhere / "report.json", first.at("report.json"));
    fs::remove(m_out / "report.json");
    fs::create_symlink(elsewhere / "report.json", m_out / "report.json");
    expect_refusal("report.json already exists");
    fs::remove(m_out / "report.json");
    fs::rename(m_out / "images", elsewhere / "images");
    fs::create_directory_symlink(elsewhere / "images", m_out / "images");
    expect_refusal("images already exists");
    fs::remove(m_out / "images");
    make(second);
    EXPECT_EQ(found(), second);
    EXPECT_TRUE(fs::exists(elsewhere / "images/overdraw.png"));
    // The folder itself may be a link.
    fs::create_directory_symlink(m_out, m_root.path() / "link");
    OutputFolder folder(m_root.path() / "link", names());
    fill(folder, first);
    folder.commit();
    EXPECT_EQ(found(), first);
}

TEST_F(OutputFolderTest, AManifestIsTrustedOnlyWithinItsFolder) {
    write(m_root.path() / "precious", "p");
    write(m_out / "a/b/c", "c");
    json files = json::array();
    for (const std::string name : {"../precious", "/etc/hostname", "a/b/c", ".", "", "images/../../precious"})
        files.push_back(
            {{"name", name}, {"sha256", "148de9c5a7a44d19e56cd9ae1a554bf67847afb0c58f6e12fa29ac7ddfca9940"}});
    write(m_out / Manifest::file_name, json({{"main", "report.json"}, {"complete", true}, {"files", files}}).dump());
    EXPECT_TRUE(Manifest::read(m_out).is_empty());
    make(second);
    EXPECT_TRUE(fs::exists(m_root.path() / "precious"));
    EXPECT_TRUE(fs::exists(m_out / "a/b/c"));
    for (const char* text : {"", "{", "[]", "{}", R"({"main": 1, "complete": true, "files": []})"}) {
        write(m_out / Manifest::file_name, text);
        expect_refusal("is not a manifest");
    }
}

TEST_F(OutputFolderTest, AReportIsNotReplacedByADiff) {
    make(first);
    EXPECT_THAT(refusal({"diff.json", {}, {}}), HasSubstr("contains a report.json of Sheer's"));
    EXPECT_EQ(found(), first);
}

TEST_F(OutputFolderTest, AnUnfinishedReportLeavesTheOlderOne) {
    make(first);
    {
        OutputFolder folder(m_out, names());
        fill(folder, second);
        EXPECT_TRUE(fs::exists(m_out / ".sheer-partial"));
        folder.discard();
        EXPECT_EQ(found(), first);
        folder.discard();
    }
    EXPECT_EQ(found(), first);
}

TEST_F(OutputFolderTest, ALateCollisionOverwritesNothing) {
    make(first);
    OutputFolder folder(m_out, names());
    fill(folder, second);
    write(folder.partial() / "images/late.png", "ours");
    write(m_out / "images/late.png", "theirs");
    EXPECT_THROW(folder.commit(), UsageError);
    folder.discard();
    Files expected = first;
    expected.merge(Files{{"images/late.png", "theirs"}});
    EXPECT_EQ(found(), expected);
    EXPECT_EQ(Manifest::read(m_out).entries().size(), 4u);
}

TEST_F(OutputFolderTest, AFailedMoveIsUndone) {
    make(first);
    OutputFolder folder(m_out, names());
    fill(folder, second);
    write(folder.partial() / "extra/x", "1");
    // There is a file with the name of the new file's folder.
    write(m_out / "extra", "theirs");
    EXPECT_THROW(folder.commit(), std::exception);
    folder.discard();
    Files expected = first;
    expected.merge(Files{{"extra", "theirs"}});
    EXPECT_EQ(found(), expected);
    EXPECT_EQ(refusal(), "") << "the manifest is that of the older report again";
}

TEST_F(OutputFolderTest, AnIncompleteReportDoesNotReplaceACompleteOne) {
    make(first, false);
    make(second, false);
    EXPECT_EQ(found(), second) << "neither is complete";
    make(first);
    EXPECT_EQ(found(), first);
    {
        OutputFolder folder(m_out, names());
        fill(folder, second);
        EXPECT_EQ(folder.commit(false), m_out / "incomplete");
    }
    EXPECT_TRUE(Manifest::read(m_out).is_complete());
    Files both = first;
    for (const auto& [name, text] : second) both["incomplete/" + name] = text;
    Files now = found();
    EXPECT_EQ(now.erase("incomplete/" + std::string(Manifest::file_name)), 1u);
    EXPECT_EQ(now, both);
    write(m_out / "incomplete/mine", "m");
    make(second);
    Files expected = second;
    expected["incomplete/mine"] = "m";
    EXPECT_EQ(found(), expected) << "a complete one replaces the incomplete one";
}

TEST_F(OutputFolderTest, LeftoversOfDeadProcessesAreRemovedAndLivingOnesAreLeftAlone) {
    write(m_out / ".sheer-partial/lock", "");
    write(m_out / ".sheer-partial/new/images/half.png", "h");
    write(m_out / ".sheer-partial/old/report.json", "o");
    make(second);
    EXPECT_EQ(found(), second);
    EXPECT_FALSE(fs::exists(m_out / ".sheer-partial"));

    write(m_out / ".sheer-partial/lock", "");
    write(m_out / ".sheer-partial/new/report.json", "the other one's");
    const int lock = open((m_out / ".sheer-partial/lock").c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_EQ(flock(lock, LOCK_EX | LOCK_NB), 0);
    expect_refusal("another Sheer process is writing into");
    close(lock);
    EXPECT_EQ(refusal(), "");
}

TEST_F(OutputFolderTest, AFileOrAnUnwritableFolderIsRefused) {
    write(m_out, "a file");
    EXPECT_THAT(refusal(), HasSubstr("out is not a folder"));
    EXPECT_THROW(OutputFolder("", names()), UsageError);
    EXPECT_THROW(OutputFolder("/proc/sheer-out", names()), UsageError);
    EXPECT_THROW(OutputFolder("/proc", names()), UsageError);
}

}  // namespace
}  // namespace sheer::cli::output_folder_test
