#pragma once
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "memory_store.h"
#include "renderer/core/sha256.h"
#include "server/archive/sqlite_store.h"
#include "server/jobs/report_id.h"
#include "server/postgres/postgres_store.h"
#include "server/storage/data_folder.h"
#include "temporary_folder.h"

namespace sheer::test {

/// The place where a store keeps its data. Stores opened on one place share it, as the processes of a service do.
class StorePlace {
  public:
    virtual ~StorePlace() = default;
    virtual std::unique_ptr<Store> open(LeaseRules rules, ClockMs clock) = 0;
};

class MemoryPlace : public StorePlace {
  public:
    std::unique_ptr<Store> open(LeaseRules rules, ClockMs clock) override {
        return std::make_unique<MemoryStore>(m_state, rules, std::move(clock));
    }

  private:
    std::shared_ptr<MemoryState> m_state = make_memory_state();
};

/// An empty folder.
class SqlitePlace : public StorePlace {
  public:
    explicit SqlitePlace(std::filesystem::path data) : m_data(std::move(data)) {}
    std::unique_ptr<Store> open(LeaseRules rules, ClockMs clock) override {
        return std::make_unique<SqliteStore>(m_data, rules, std::move(clock));
    }

  private:
    std::filesystem::path m_data;
};

/// An empty schema in a database of this process on the server that SHEER_TEST_STORE names; see
/// tests/private_postgres.sh.
class PostgresPlace : public StorePlace {
  public:
    explicit PostgresPlace(std::filesystem::path data);
    std::unique_ptr<Store> open(LeaseRules rules, ClockMs clock) override {
        return std::make_unique<PostgresStore>(m_url, m_data, rules, std::move(clock));
    }
    const std::string& url() const { return m_url; }
    /// One statement, as another client of the database.
    void run(const std::string& sql) const;

  private:
    const std::filesystem::path m_data;
    const std::string m_url;
};

/// Whether there is a server for PostgresPlace.
bool has_postgres();

/// An empty store, with a clock that moves only when told to, and a folder for the other needs of a test.
class StoreFixture {
  protected:
    explicit StoreFixture(std::unique_ptr<StorePlace> (*make)(const std::filesystem::path& data))
        : m_place(make(m_data.root)) {}

    std::string submit(const std::string& title = "", const nlohmann::json& more = nlohmann::json::object()) {
        m_now_ms += 1;
        nlohmann::json spec = {{"title", title}, {"scene", {{"type", "quads"}}}, {"methods", {{{"id", "b2f"}}}}};
        spec.update(more);
        NewReport report{.id = m_ids.next(), .spec = spec.dump()};
        report.spec_sha256 = sha256_hex(report.spec);
        EXPECT_EQ(m_queue.submit(report, {100}).outcome, SubmitResult::Outcome::created);
        return report.id;
    }

    /// Of the spec of the only report with this title.
    std::string sha256_of(const std::string& title) { return m_reports.list({.q = title}).reports.at(0).spec_sha256; }

    Lease lease(const std::string& owner = "worker") {
        const auto leased = m_queue.lease(owner);
        if (!leased) throw std::runtime_error("no job to lease");
        return *leased;
    }

    /// A report of this job, with one picture.
    FinishedReport finished(const Lease& job, const std::string& picture) {
        const std::string sha256 = sha256_hex(picture);
        const nlohmann::json image = {{"sha256", sha256}, {"url", "of " + sha256}, {"media_type", "image/png"}};
        nlohmann::json report = {{"id", job.id}, {"status", "done"}, {"verdict", "passed"}};
        report["runs"] = {{{"reference", {{"images", {{"color", image}}}}}}};
        FinishedReport finished{.report = report, .finished_ms = m_now_ms};
        add_picture(finished, picture);
        return finished;
    }

    /// Another picture of the report.
    void add_picture(FinishedReport& finished, const std::string& picture) {
        const std::string sha256 = sha256_hex(picture);
        finished.blobs.push_back({sha256, "image/png"});
        m_pictures[sha256] = picture;
        finished.read_blob = [this](const std::string& wanted) {
            const auto found = m_pictures.find(wanted);
            if (found == m_pictures.end()) throw StoreError("there is no such file");
            return found->second;
        };
    }

    /// Queues, leases and commits a report.
    std::string make_done(const std::string& title, const std::string& picture) {
        submit(title);
        const Lease job = lease();
        EXPECT_TRUE(m_queue.commit(job, finished(job, picture)));
        return job.id;
    }

    std::string add_asset(const std::string& bytes, const std::string& type = "texture") {
        m_now_ms += 1;
        const std::string sha256 = sha256_hex(bytes);
        m_assets.add({.sha256 = sha256,
                      .type = type,
                      .media_type = "image/png",
                      .name = "name of " + bytes,
                      .size_bytes = static_cast<std::int64_t>(bytes.size()),
                      .facts = {{"width", 7}}},
                     bytes);
        return sha256;
    }

    Status status(const std::string& id) { return m_reports.find(id).value().status; }
    std::string picture(const std::string& sha256) { return read_all(*m_blobs.open(sha256).value().content, 100); }
    std::string upload(const std::string& sha256) { return read_all(*m_assets.open(sha256).value().content, 100); }

    TemporaryFolder m_folder;
    const DataFolder m_data{m_folder.path() / "data"};
    std::int64_t m_now_ms = 1'700'000'000'000;
    LeaseRules m_rules{.lease_ms = 10'000, .heartbeat_ms = 1'000, .max_attempts = 2};
    ClockMs m_clock = [this] { return m_now_ms; };
    ReportIds m_ids{m_clock};
    std::map<std::string, std::string> m_pictures;
    const std::unique_ptr<StorePlace> m_place;
    const std::unique_ptr<Store> m_opened = m_place->open(m_rules, m_clock);
    Store& m_store = *m_opened;
    JobQueue& m_queue = m_store.queue();
    ReportArchive& m_reports = m_store.reports();
    Blobs& m_blobs = m_store.blobs();
    Assets& m_assets = m_store.assets();
    Readiness& m_readiness = m_store.readiness();
};

inline std::unique_ptr<StorePlace> in_memory(const std::filesystem::path&) {
    return std::make_unique<MemoryPlace>();
}

inline std::unique_ptr<StorePlace> in_sqlite(const std::filesystem::path& data) {
    return std::make_unique<SqlitePlace>(data);
}

inline std::unique_ptr<StorePlace> in_postgres(const std::filesystem::path& data) {
    return std::make_unique<PostgresPlace>(data);
}

/// A test of code that uses any store.
class WithStore : public testing::Test, protected StoreFixture {
  protected:
    WithStore() : StoreFixture(in_memory) {}
};

/// A test of properties of only the SQLite store.
class WithSqlite : public testing::Test, protected StoreFixture {
  protected:
    WithSqlite() : StoreFixture(in_sqlite) {}
};

/// An implementation of the store.
struct StoreKind {
    const char* name;
    std::unique_ptr<StorePlace> (*make)(const std::filesystem::path& data);
};

/// A test of the interface, which every implementation passes.
class StoreTest : public testing::TestWithParam<StoreKind>, protected StoreFixture {
  protected:
    StoreTest() : StoreFixture(GetParam().make) {}
};

/// Without a server, those of PostgreSQL are missing.
inline std::vector<StoreKind> every_store_here() {
    std::vector<StoreKind> kinds = {{"Sqlite", in_sqlite}, {"Memory", in_memory}};
    if (has_postgres()) kinds.push_back({"Postgres", in_postgres});
    return kinds;
}
inline const auto every_store = testing::ValuesIn(every_store_here());

inline std::string store_name(const testing::TestParamInfo<StoreKind>& kind) {
    return kind.param.name;
}

}  // namespace sheer::test
