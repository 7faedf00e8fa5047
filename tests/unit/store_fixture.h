#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "renderer/report/report.h"
#include "server/archive/sqlite_store.h"
#include "server/jobs/report_id.h"
#include "temporary_folder.h"

namespace sheer::test {

/// An archive in a new folder, with a clock that stands still until it is moved.
class StoreTest : public testing::Test {
  protected:
    std::string submit(const std::string& title = "", const nlohmann::json& more = nlohmann::json::object()) {
        m_now_ms += 1;
        nlohmann::json spec = {{"title", title}, {"scene", {{"type", "quads"}}}, {"methods", {{{"id", "b2f"}}}}};
        spec.update(more);
        NewReport report{.id = m_ids.next(), .spec = spec.dump(), .spec_sha256 = "hash of " + title};
        EXPECT_EQ(m_store.submit(report, 100).outcome, SubmitResult::Outcome::created);
        return report.id;
    }

    Lease lease(const std::string& owner = "worker") {
        const auto leased = m_store.lease(owner);
        if (!leased) throw std::runtime_error("no job to lease");
        return *leased;
    }

    /// A report of this job with one picture.
    FinishedReport finished(const Lease& job, const std::string& picture) {
        const std::string sha256 = sha256_hex(picture);
        const nlohmann::json image = {
            {"sha256", sha256}, {"url", "/api/v1/blobs/" + sha256}, {"media_type", "image/png"}};
        nlohmann::json report = {{"id", job.id}, {"status", "done"}, {"verdict", "passed"}};
        report["runs"] = {{{"reference", {{"images", {{"color", image}}}}}}};
        return {.report = report,
                .finished_ms = m_now_ms,
                .blobs = {{sha256, "image/png", m_folder.file("picture-" + sha256.substr(0, 8), picture)}}};
    }

    /// Queues, leases and commits a report.
    std::string make_done(const std::string& title, const std::string& picture) {
        submit(title);
        const Lease job = lease();
        EXPECT_TRUE(m_store.commit(job, finished(job, picture)));
        return job.id;
    }

    Status status(const std::string& id) { return m_store.find(id).value().status; }

    TemporaryFolder m_folder;
    std::int64_t m_now_ms = 1'700'000'000'000;
    LeaseRules m_rules{.lease_ms = 10'000, .heartbeat_ms = 1'000, .max_attempts = 2};
    ClockMs m_clock = [this] { return m_now_ms; };
    ReportIds m_ids{m_clock};
    SqliteStore m_store{m_folder.path() / "data", m_rules, m_clock};
};

}  // namespace sheer::test
