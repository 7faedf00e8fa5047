#include "server/http/lasting.h"

#include <gtest/gtest.h>

namespace sheer::http::lasting_test {
namespace {

Limits limits(int connections, int per_client) {
    Limits made;
    made.max_connections = connections;
    made.max_streams_per_client = per_client;
    return made;
}

TEST(LastingAnswersTest, AClientMayHaveAFew) {
    LastingAnswers answers(limits(100, 2));
    const Lasting first(answers, "a");
    EXPECT_TRUE(first.is_granted());
    {
        const Lasting second(answers, "a"), third(answers, "a"), other(answers, "b");
        EXPECT_TRUE(second.is_granted());
        EXPECT_FALSE(third.is_granted());
        EXPECT_TRUE(other.is_granted());
    }
    EXPECT_TRUE(Lasting(answers, "a").is_granted());
}

TEST(LastingAnswersTest, AllTogetherLeaveConnectionsForOthers) {
    LastingAnswers answers(limits(8, 100));
    for (int i = 0; i < 6; ++i) EXPECT_TRUE(answers.begin(std::to_string(i)));
    EXPECT_FALSE(answers.begin("another"));
    answers.end("3");
    EXPECT_TRUE(answers.begin("another"));
    // A single connection may be long-lived.
    LastingAnswers one(limits(1, 100));
    EXPECT_TRUE(one.begin("a"));
    EXPECT_FALSE(one.begin("a"));
}

}  // namespace
}  // namespace sheer::http::lasting_test
