#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <vector>

#include "tests/source_folder.h"

namespace sheer::test::rooms_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

using Rooms = std::map<std::string, std::set<std::string>>;

/// A file and those of our files that it includes, as paths relative to the checkout's root.
struct Source {
    std::string path;
    std::vector<std::string> includes;
};

std::string folder_of(const std::string& path) {
    return fs::path(path).parent_path().string();
}

/// The rooms of rooms.txt; errors of the list itself are added to `wrong`.
Rooms read_rooms(std::istream& text, std::vector<std::string>& wrong) {
    Rooms rooms;
    for (std::string line; std::getline(text, line);) {
        if (line.empty() || line[0] == '#') continue;
        const std::size_t colon = line.find(':');
        const std::string room = line.substr(0, colon);
        std::set<std::string> allowed;
        std::istringstream names(colon == std::string::npos ? "" : line.substr(colon + 1));
        for (std::string name; names >> name;) {
            if (!rooms.contains(name)) wrong.push_back(room + " names " + name + ", which does not stand above it");
            allowed.insert(name);
        }
        if (!rooms.emplace(room, allowed).second) wrong.push_back(room + " is listed twice");
    }
    return rooms;
}

std::vector<std::string> wrong_arrows(const Rooms& rooms, const std::vector<Source>& sources) {
    std::vector<std::string> wrong;
    Rooms unused = rooms;
    for (const Source& source : sources) {
        const std::string room = folder_of(source.path);
        if (!rooms.contains(room)) {
            wrong.push_back(source.path + " is in no room");
            continue;
        }
        for (const std::string& include : source.includes) {
            const std::string other = folder_of(include);
            if (other == room) continue;
            unused[room].erase(other);
            if (!rooms.at(room).contains(other)) wrong.push_back(source.path + " includes " + include);
        }
    }
    for (const auto& [room, others] : unused)
        for (const std::string& other : others) wrong.push_back(room + " includes nothing of " + other);
    return wrong;
}

std::vector<Source> read_sources() {
    std::vector<Source> sources;
    const fs::path top = source_folder();
    for (const char* folder : {"renderer", "server"})
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(top / folder)) {
            if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
            Source source{fs::relative(entry.path(), top).string(), {}};
            std::ifstream file(entry.path());
            for (std::string line; std::getline(file, line);)
                if (line.starts_with("#include \"renderer/") || line.starts_with("#include \"server/"))
                    source.includes.push_back(line.substr(10, line.rfind('"') - 10));
            sources.push_back(std::move(source));
        }
    return sources;
}

TEST(Rooms, EveryIncludeGoesDown) {
    std::ifstream file(source_folder() + std::string("/tests/rooms.txt"));
    std::vector<std::string> wrong;
    const Rooms rooms = read_rooms(file, wrong);
    EXPECT_THAT(wrong, IsEmpty());
    const std::vector<Source> sources = read_sources();
    EXPECT_GT(sources.size(), 300u);
    EXPECT_THAT(wrong_arrows(rooms, sources), IsEmpty()) << "The rooms are listed in tests/rooms.txt";
}

TEST(Rooms, AnIncludeThatTheListDoesNotAllowIsFound) {
    const Rooms rooms = {{"low", {}}, {"high", {"low"}}};
    const Source up = {"low/a.h", {"high/b.h"}}, down = {"high/b.h", {"low/a.h", "high/c.h"}}, lost = {"new/d.h", {}};
    EXPECT_THAT(wrong_arrows(rooms, {down}), IsEmpty());
    EXPECT_THAT(wrong_arrows(rooms, {up, down}), ElementsAre("low/a.h includes high/b.h"));
    EXPECT_THAT(wrong_arrows(rooms, {down, lost}), ElementsAre("new/d.h is in no room"));
    EXPECT_THAT(wrong_arrows(rooms, {}), ElementsAre("high includes nothing of low"));
}

TEST(Rooms, AListWithACycleIsFound) {
    std::istringstream text("# low to high\nlow: high\nhigh: low\nlow:\n");
    std::vector<std::string> wrong;
    read_rooms(text, wrong);
    EXPECT_THAT(wrong, ElementsAre("low names high, which does not stand above it", "low is listed twice"));
}

}  // namespace
}  // namespace sheer::test::rooms_test
