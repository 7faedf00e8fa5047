#include "server/http/queue_speed.h"

#include "store_fixture.h"

namespace sheer::http::queue_speed_test {
namespace {

using std::chrono::seconds;

class QueueSpeedTest : public test::WithStore {
  protected:
    void render(int taken_s) {
        const Lease leased = lease();
        m_now_ms += taken_s * 1000;
        EXPECT_TRUE(m_queue.commit(leased, finished(leased, "picture")));
    }

    QueueSpeed m_speed{m_reports, m_clock};
};

TEST_F(QueueSpeedTest, WithoutExperienceItIsASecondForEach) {
    EXPECT_EQ(m_speed.until_a_place(), seconds(1));
    EXPECT_EQ(m_speed.until_empty(), seconds(1));
}

TEST_F(QueueSpeedTest, TheMedianOfWhatTheLastOnesTook) {
    for (const int taken_s : {90, 5, 5, 8}) {
        submit();
        render(taken_s);
        m_now_ms += 600'000;  // nothing is waiting
    }
    submit();
    submit();
    submit();
    EXPECT_EQ(m_speed.until_a_place(), seconds(5));
    EXPECT_EQ(m_speed.until_empty(), seconds(15));
}

TEST_F(QueueSpeedTest, ReportsThatWaitedCountFromTheEndOfTheOneBefore) {
    for (int i = 0; i < 5; ++i) submit();
    for (int i = 0; i < 3; ++i) render(7);
    EXPECT_EQ(m_speed.until_a_place(), seconds(7));
    EXPECT_EQ(m_speed.until_empty(), seconds(14));
}

TEST_F(QueueSpeedTest, ItIsMeasuredAgainAfterASecond) {
    submit();
    render(3);
    EXPECT_EQ(m_speed.until_empty(), seconds(3));
    submit();
    submit();
    EXPECT_EQ(m_speed.until_empty(), seconds(3));
    m_now_ms += 1000;
    EXPECT_EQ(m_speed.until_empty(), seconds(6));
}

}  // namespace
}  // namespace sheer::http::queue_speed_test
