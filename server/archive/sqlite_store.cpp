#include "server/archive/sqlite_store.h"

#include "server/archive/sqlite_activity.h"
#include "server/archive/sqlite_assets.h"
#include "server/archive/sqlite_baselines.h"
#include "server/archive/sqlite_blobs.h"
#include "server/archive/sqlite_care.h"
#include "server/archive/sqlite_pins.h"
#include "server/archive/sqlite_queue.h"
#include "server/archive/sqlite_readiness.h"
#include "server/archive/sqlite_reports.h"
#include "server/archive/sqlite_trends.h"
#include "server/archive/sqlite_version.h"
#include "server/archive/sqlite_watch.h"

namespace sheer {

struct SqliteStore::Parts {
    Parts(const DataFolder& data, LeaseRules rules, ClockMs clock)
        : folder(data), archive(data, rules, std::move(clock)) {}

    const DataFolder folder;
    SqliteArchive archive;
    SqliteBlobs blobs{archive};
    SqliteQueue queue{archive, blobs};
    SqliteReports reports{archive, blobs};
    SqliteAssets assets{archive};
    SqliteBaselines baselines{archive};
    SqlitePins pins{archive};
    SqliteReadiness readiness{archive};
    SqliteTrends trends{archive};
    SqliteActivity activity{archive};
    SqliteWorkers workers{archive};
    SqliteUsage usage{archive};
    SqliteCare care{archive, blobs, folder};
    SqliteVersion version{folder};
};

SqliteStore::SqliteStore(const std::filesystem::path& folder, LeaseRules rules, ClockMs clock)
    : m_parts(std::make_unique<Parts>(DataFolder{folder}, rules, std::move(clock))) {}

SqliteStore::~SqliteStore() = default;

JobQueue& SqliteStore::queue() {
    return m_parts->queue;
}
ReportArchive& SqliteStore::reports() {
    return m_parts->reports;
}
Blobs& SqliteStore::blobs() {
    return m_parts->blobs;
}
Assets& SqliteStore::assets() {
    return m_parts->assets;
}
Baselines& SqliteStore::baselines() {
    return m_parts->baselines;
}
Pins& SqliteStore::pins() {
    return m_parts->pins;
}
Readiness& SqliteStore::readiness() {
    return m_parts->readiness;
}
Care& SqliteStore::care() {
    return m_parts->care;
}
Trends& SqliteStore::trends() {
    return m_parts->trends;
}
Activity& SqliteStore::activity() {
    return m_parts->activity;
}
Workers& SqliteStore::workers() {
    return m_parts->workers;
}
Usage& SqliteStore::usage() {
    return m_parts->usage;
}
std::unique_ptr<ChangeWatch> SqliteStore::watch() {
    return std::make_unique<SqliteWatch>(m_parts->folder);
}

std::optional<std::int64_t> SqliteStore::version() {
    return m_parts->version.read();
}

}  // namespace sheer
