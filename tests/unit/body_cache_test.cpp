#include "server/http/body_cache.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

namespace sheer::http::body_cache_test {
namespace {

class BodyCacheTest : public testing::Test {
  protected:
    /// Whether the body had to be made.
    bool makes(const std::string& key, std::size_t bytes) {
        bool made = false;
        const std::string body = m_cache.get(key, [&] {
            made = true;
            return std::string(bytes, key[0]);
        });
        EXPECT_EQ(body, std::string(bytes, key[0]));
        return made;
    }

    BodyCache m_cache{100};
};

TEST_F(BodyCacheTest, ABodyIsMadeOnce) {
    EXPECT_TRUE(makes("a", 10));
    EXPECT_FALSE(makes("a", 10));
    EXPECT_TRUE(makes("b", 10));
    EXPECT_FALSE(makes("a", 10));
}

TEST_F(BodyCacheTest, WhatWasNotUsedForLongestIsForgotten) {
    makes("a", 40);
    makes("b", 40);
    makes("a", 40);
    makes("c", 40);
    EXPECT_FALSE(makes("a", 40));
    EXPECT_FALSE(makes("c", 40));
    EXPECT_TRUE(makes("b", 40));
}

TEST_F(BodyCacheTest, ABodyThatFillsItIsKeptAndALongerOneIsNot) {
    makes("a", 40);
    EXPECT_TRUE(makes("long", 101));
    EXPECT_TRUE(makes("long", 101));
    EXPECT_FALSE(makes("a", 40)) << "it had to make no room";
    EXPECT_TRUE(makes("full", 100));
    EXPECT_FALSE(makes("full", 100));
    EXPECT_TRUE(makes("a", 40));
}

TEST_F(BodyCacheTest, WhatIsKeptReplacesWhatWasKnown) {
    m_cache.keep("a", {std::string(60, 'a'), "\"1\"", 1});
    m_cache.keep("a", {std::string(70, 'b'), "\"2\"", 2});
    const BodyCache::KeptPtr kept = m_cache.find("a");
    ASSERT_NE(kept, nullptr);
    EXPECT_EQ(kept->body, std::string(70, 'b'));
    EXPECT_EQ(kept->etag, "\"2\"");
    EXPECT_EQ(kept->version, 2);
    m_cache.keep("b", {std::string(30, 'b')});
    EXPECT_NE(m_cache.find("a"), nullptr) << "the replaced one takes no room";
    EXPECT_EQ(m_cache.find("c"), nullptr);
}

TEST_F(BodyCacheTest, AFailureIsNotKept) {
    EXPECT_THROW(m_cache.get("a", []() -> std::string { throw std::runtime_error("no"); }), std::runtime_error);
    EXPECT_TRUE(makes("a", 10));
}

TEST_F(BodyCacheTest, ThreadsGetTheirOwnBodies) {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&, i] {
            for (int k = 0; k < 2'000; ++k) {
                const std::string key = std::to_string((i * 7 + k) % 10);
                EXPECT_EQ(m_cache.get(key, [&] { return std::string(30, key[0]); }), std::string(30, key[0]));
            }
        });
}

}  // namespace
}  // namespace sheer::http::body_cache_test
