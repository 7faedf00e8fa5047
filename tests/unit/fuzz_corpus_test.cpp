// Every input of tests/fuzz/corpus. What `./dev fuzz` finds is added there.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/fuzz/target.h"
#include "tests/source_folder.h"

namespace sheer::fuzz_corpus_test {

namespace {

namespace fs = std::filesystem;

TEST(FuzzCorpus, IsReadOrRefusedByItsTarget) {
    for (const test::FuzzTarget& target : test::make_fuzz_targets()) {
        int count = 0;
        for (const auto& entry : fs::directory_iterator(fs::path(source_folder()) / "tests/fuzz/corpus" / target.id)) {
            std::ifstream file(entry.path(), std::ios::binary);
            const std::string input(std::istreambuf_iterator<char>(file), {});
            EXPECT_FALSE(input.empty()) << entry.path();
            EXPECT_NO_THROW(target.read(input)) << entry.path();
            ++count;
        }
        EXPECT_GT(count, 0) << target.id;
    }
}

TEST(FuzzCorpus, WhatMustHoldIsTested) {
    EXPECT_THROW(test::require(false, "what"), std::logic_error);
    EXPECT_THROW(test::require_readable(""), std::logic_error);
    EXPECT_THROW(test::require_readable("a\x7f"), std::logic_error);
    EXPECT_NO_THROW(test::require_readable("line 3: what"));
}

}  // namespace

}  // namespace sheer::fuzz_corpus_test
