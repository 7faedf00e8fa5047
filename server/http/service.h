#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "renderer/core/clock.h"
#include "server/children/diff_child.h"
#include "server/children/pixel_child.h"
#include "server/children/upload_check.h"
#include "server/http/access.h"
#include "server/http/limits.h"
#include "server/http/router.h"
#include "server/jobs/report_id.h"
#include "server/jobs/store.h"

namespace sheer::http {

/// Everything that the handlers need.
struct Service {
    Store& store;
    ReportIds& ids;
    ClockMs clock;
    /// `sheer devices --json`; throws std::exception if it fails.
    std::function<nlohmann::json()> list_devices;
    /// Reads and checks a whole upload; see check_upload.
    std::function<UploadVerdict(const std::string& bytes, const std::string& media_type)> check_upload;
    /// Explains a pixel of a done report; see children/pixel_child.h.
    std::function<PixelAnswer(const std::string& report, const PixelPlace& place)> pixel;
    /// Compares two done reports; see children/diff_child.h.
    std::function<DiffAnswer(const DiffQuestion& question)> diff;
    AnswerLimits limits = {};
    /// Why what others send is not read in a sandbox; "" if it is.
    std::string without_sandbox = {};
    bool needs_sandbox = true;
    /// What a compiler says of the user's own shading, "" for nothing; see children/shading_check.h. Null: shadings
    /// are compiled only when they are rendered.
    std::function<std::string(const std::string& glsl)> check_shading = {};
    /// Where the workers of this machine write until a report is done.
    std::filesystem::path scratch = {};
    /// See path_prefix.h.
    std::string path_prefix = {};
    /// In the text format of Prometheus; null for none.
    std::function<std::string()> metrics = {};
    Access access = {};
};

/// For how long a worker that gives no sign of life counts as present.
std::int64_t in_sight_ms(const Service& service);

/// Throws Problem (403) for `what`, such as "An upload", if it needs a sandbox and there is none.
void require_sandbox(const Service& service, const std::string& what);

// The calls by topic. `service` must outlive the routes.
std::vector<Route> submit_routes(Service& service);    ///< POST /reports, /specs/validate
std::vector<Route> report_routes(Service& service);    ///< one report
std::vector<Route> early_routes(Service& service);     ///< pictures of a report that is not done
std::vector<Route> diff_routes(Service& service);      ///< two reports compared with each other
std::vector<Route> pixel_routes(Service& service);     ///< one pixel of a report
std::vector<Route> archive_routes(Service& service);   ///< the list of reports, the pictures
std::vector<Route> asset_routes(Service& service);     ///< uploaded files
std::vector<Route> baseline_routes(Service& service);  ///< accepted reports
std::vector<Route> pin_routes(Service& service);       ///< pinned reports
std::vector<Route> trend_routes(Service& service);     ///< numbers over time
std::vector<Route> catalog_routes(Service& service);   ///< /methods, /scenes, /devices
std::vector<Route> worker_routes(Service& service);    ///< /workers
std::vector<Route> health_routes(Service& service);    ///< /healthz, /readyz
std::vector<Route> metrics_routes(Service& service);   ///< /metrics
std::vector<Route> session_routes(Service& service);   ///< the page's token
std::vector<Route> page_routes();                      ///< the page at /

/// All of them, and /openapi.json made from their table.
Router make_router(Service& service);

/// The schema of what PUT /baselines/{name} takes.
nlohmann::json acceptance_schema();

/// The schema of what POST /session takes.
nlohmann::json session_schema();

/// The schema of what PUT /reports/{id}/pin takes.
nlohmann::json pin_schema();

/// A group of calls in the OpenAPI document.
struct Tag {
    std::string name, description;
};

/// The OpenAPI 3.1 document of `routes`, which are served below `path_prefix`.
nlohmann::json openapi_document(const std::vector<Route>& routes, const std::vector<Tag>& tags,
                                const std::string& path_prefix);

}  // namespace sheer::http
