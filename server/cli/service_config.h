#pragma once
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "renderer/params/param.h"
#include "server/http/limits.h"
#include "server/http/observer.h"
#include "server/jobs/lease_rules.h"
#include "server/jobs/retention.h"
#include "server/process/ask_child.h"
#include "server/process/sandbox_settings.h"
#include "server/worker/worker.h"

namespace sheer::cli {

/// All settings of the service and its workers. A configuration file sets some of them; the others have the defaults
/// given here and in the structs.
struct ServiceConfig {
    std::string listen = "127.0.0.1:8080";
    std::filesystem::path data = "sheer-data";
    std::string store;  ///< see open_store()
    int workers = 1;
    std::set<std::string> allowed_hosts;
    std::set<std::string> cors_origins;
    std::string path_prefix;
    std::filesystem::path tokens;  ///< see token_file()
    bool behind_proxy = false;
    http::AccessLog access_log = http::AccessLog::text;
    std::string log_level = "info";  ///< a name that spdlog knows
    http::Limits http;
    http::AnswerLimits answers;
    std::chrono::seconds devices_cache{60};
    LeaseRules leases;
    SandboxSettings sandbox;
    ChildLimits upload_check{.memory_bytes = std::uint64_t{2} << 30, .time = std::chrono::seconds(20)};
    ChildLimits question;  ///< of a child that explains a pixel or compares reports; its memory is a renderer's
    std::vector<RetentionRule> retention;
    std::chrono::milliseconds retention_interval{3'600'000};
    WorkerOptions worker;  ///< without `scratch`, `data`, `name`, `rules`, `sandbox` and `fork_server`

    std::filesystem::path token_file() const { return tokens.empty() ? data / "tokens.json" : tokens; }
};

/// The fields of a configuration file. Its reader, configs/server.json and the documents are made from them.
std::vector<Param> service_config_fields();

/// Throws SpecError with every wrong or unknown field.
ServiceConfig read_service_config(const nlohmann::json& document);
/// The defaults if `path` is empty; `overrides` take precedence over the file. Throws SpecError, also if there is no
/// such file or it is not JSON.
ServiceConfig load_service_config(const std::filesystem::path& path,
                                  const nlohmann::json& overrides = nlohmann::json::object());

}  // namespace sheer::cli
