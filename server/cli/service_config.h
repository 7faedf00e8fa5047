#pragma once
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "renderer/spec/param.h"
#include "server/http/limits.h"
#include "server/jobs/lease_rules.h"
#include "server/worker/upload_check.h"
#include "server/worker/worker.h"

namespace sheer::cli {

/// Everything that the service and its workers can be told: configs/server.json with defaults filled in.
struct ServiceConfig {
    std::string listen;  ///< ADDRESS:PORT
    std::filesystem::path data;
    int workers = 1;
    std::set<std::string> allowed_hosts;
    std::string log_level;  ///< a name that spdlog knows
    http::Limits http;
    std::size_t max_asset_bytes = 0;
    UploadCheckOptions upload_check;
    std::chrono::milliseconds pixel_time_limit{};
    std::size_t max_queued = 0;
    std::chrono::seconds max_wait{};
    std::chrono::seconds ready_within{};
    std::chrono::seconds devices_cache{};
    LeaseRules leases;
    WorkerOptions worker;  ///< without `data` and `name`
};

/// What may stand in it.
std::vector<Param> service_config_fields();

/// Throws SpecError that names every wrong or unknown field.
ServiceConfig read_service_config(const nlohmann::json& document);
/// The defaults if `path` is empty. Throws SpecError, also if there is no such file or it is not JSON.
ServiceConfig load_service_config(const std::filesystem::path& path);

}  // namespace sheer::cli
