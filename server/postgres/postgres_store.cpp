#include "server/postgres/postgres_store.h"

#include "server/postgres/local_copies.h"
#include "server/postgres/postgres_activity.h"
#include "server/postgres/postgres_care.h"
#include "server/postgres/postgres_content.h"
#include "server/postgres/postgres_marks.h"
#include "server/postgres/postgres_queue.h"
#include "server/postgres/postgres_reports.h"
#include "server/postgres/postgres_steps.h"
#include "server/postgres/postgres_watch.h"

namespace sheer {

struct PostgresStore::Parts {
    Parts(const std::string& url, const std::filesystem::path& folder, LeaseRules rules, std::optional<ClockMs> clock)
        : database(postgres::Address(url), rules, std::move(clock)), copies(database, DataFolder{folder}) {}

    postgres::Database database;
    postgres::LocalCopies copies;
    postgres::PostgresQueue queue{database};
    postgres::PostgresReports reports{database};
    postgres::PostgresBlobs blobs{database};
    postgres::PostgresAssets assets{database};
    postgres::PostgresBaselines baselines{database};
    postgres::PostgresPins pins{database};
    postgres::PostgresReadiness readiness{database};
    postgres::PostgresCare care{database};
    postgres::PostgresTrends trends{database};
    postgres::PostgresActivity activity{database};
    postgres::PostgresWorkers workers{database};
    postgres::PostgresUsage usage{database};
};

PostgresStore::PostgresStore(const std::string& url, const std::filesystem::path& folder, LeaseRules rules,
                             std::optional<ClockMs> made_up_clock)
    : m_parts(std::make_unique<Parts>(url, folder, rules, std::move(made_up_clock))) {}

PostgresStore::~PostgresStore() = default;

JobQueue& PostgresStore::queue() {
    return m_parts->queue;
}
ReportArchive& PostgresStore::reports() {
    return m_parts->reports;
}
Blobs& PostgresStore::blobs() {
    return m_parts->blobs;
}
Assets& PostgresStore::assets() {
    return m_parts->assets;
}
Baselines& PostgresStore::baselines() {
    return m_parts->baselines;
}
Pins& PostgresStore::pins() {
    return m_parts->pins;
}
Readiness& PostgresStore::readiness() {
    return m_parts->readiness;
}
Care& PostgresStore::care() {
    return m_parts->care;
}
Trends& PostgresStore::trends() {
    return m_parts->trends;
}
Activity& PostgresStore::activity() {
    return m_parts->activity;
}
Workers& PostgresStore::workers() {
    return m_parts->workers;
}
Usage& PostgresStore::usage() {
    return m_parts->usage;
}
std::unique_ptr<ChangeWatch> PostgresStore::watch() {
    return std::make_unique<postgres::PostgresWatch>(m_parts->database.address(), postgres::changes_channel);
}
std::unique_ptr<ChangeWatch> PostgresStore::watch_jobs() {
    return std::make_unique<postgres::PostgresWatch>(m_parts->database.address(), postgres::jobs_channel);
}
void PostgresStore::bring_here(const std::string& text) {
    m_parts->copies.bring(text);
}

}  // namespace sheer
