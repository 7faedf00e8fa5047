#include "server/http/reuse.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "renderer/report/provenance.h"
#include "server/http/report_view.h"
#include "version.h"

namespace sheer::http {

using nlohmann::json;

namespace {

constexpr int most_candidates = 20;

/// The first device that works, which is the one that workers open; null if there is none.
json current_device(Service& service) {
    try {
        const json devices = service.list_devices();
        for (const json& device : devices)
            if (device.value("error", json()).is_null()) return device;
    } catch (const std::exception& error) {
        spdlog::warn("no report is reused: {}", error.what());
    }
    return nullptr;
}

bool is_of_device(const report::Report& report, const json& device) {
    return report.device && report.device->renderer == device.value("renderer", "") &&
           report.device->vendor == device.value("vendor", "") &&
           report.device->gl_version == device.value("gl_version", "") && report.device->cpu == cpu_name();
}

bool has_failures(const report::Report& report) {
    return std::ranges::any_of(report.runs, [](const report::Run& run) {
        return run.reference.status == report::ResultStatus::failed ||
               std::ranges::any_of(run.results, [](const report::Result& result) {
                   return result.status == report::ResultStatus::failed;
               });
    });
}

}  // namespace

std::optional<ReportRecord> reusable_report(Service& service, const std::string& spec_sha256) {
    const ReportPage page =
        service.store.reports().list({.spec_sha256 = spec_sha256, .status = Status::done, .limit = most_candidates});
    if (page.reports.empty()) return std::nullopt;
    const json device = current_device(service);
    if (device.is_null()) return std::nullopt;
    for (const ReportSummary& each : page.reports) {
        try {
            auto record = service.store.reports().find(each.id);
            if (!record) continue;
            const report::Report report = report_of(*record);
            if (report.provenance.version == version && report.provenance.commit == commit &&
                is_of_device(report, device) && !has_failures(report))
                return record;
        } catch (const DamagedData& damaged) {
            spdlog::error("report {} is not reused: {}", each.id, damaged.what());
        }
    }
    return std::nullopt;
}

}  // namespace sheer::http
