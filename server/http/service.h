#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <vector>

#include "server/http/router.h"
#include "server/jobs/clock.h"
#include "server/jobs/report_id.h"
#include "server/jobs/store.h"
#include "server/worker/pixel_child.h"
#include "server/worker/upload_check.h"

namespace sheer::http {

/// The most that is read of one picture of a report.
inline constexpr std::uintmax_t max_picture_bytes = std::uintmax_t{512} << 20;

/// What the handlers need.
struct Service {
    Store& store;
    ReportIds& ids;
    ClockMs clock;
    /// `sheer devices --json`; throws std::exception if it fails.
    std::function<nlohmann::json()> list_devices;
    /// Reads an upload whole; see check_upload.
    std::function<UploadVerdict(const std::string& bytes, const std::string& media_type)> check_upload;
    /// Takes a pixel of a done report apart; see worker/pixel_child.h.
    std::function<PixelAnswer(const std::string& report, const PixelPlace& place)> take_pixel_apart;
    std::size_t max_asset_bytes = std::size_t{64} << 20;
    int max_checks = 2;  ///< uploads that are read at a time
    int max_diffs = 2;   ///< diffs of reports that are made at a time
    std::size_t max_queued = 100;
    std::chrono::seconds max_wait{300};     ///< what `Prefer: wait` is cut to
    std::chrono::seconds ready_within{90};  ///< how long after its last rendering the service still counts as ready
};

// The calls, by what they are about. `service` must outlive the routes.
std::vector<Route> submit_routes(Service& service);   ///< POST /reports, /specs/validate
std::vector<Route> report_routes(Service& service);   ///< one report
std::vector<Route> diff_routes(Service& service);     ///< two reports held against each other
std::vector<Route> pixel_routes(Service& service);    ///< one pixel of a report
std::vector<Route> archive_routes(Service& service);  ///< the list of reports, the pictures
std::vector<Route> asset_routes(Service& service);    ///< uploaded files
std::vector<Route> catalog_routes(Service& service);  ///< /methods, /scenes, /devices
std::vector<Route> health_routes(Service& service);   ///< /healthz, /readyz
std::vector<Route> page_routes();                     ///< the page at /

/// All of them, and /openapi.json made from their table.
Router make_router(Service& service);

/// The OpenAPI 3.1 document of `routes`.
nlohmann::json openapi_document(const std::vector<Route>& routes);

}  // namespace sheer::http
