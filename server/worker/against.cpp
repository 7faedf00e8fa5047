#include "server/worker/against.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "renderer/core/clock.h"
#include "renderer/files/against.h"
#include "renderer/files/report_document.h"
#include "server/jobs/limits.h"
#include "server/jobs/store_errors.h"

namespace sheer {

namespace {

const std::string baseline_prefix = "baseline:";

/// "5 minutes", "1 day".
std::string age_text(std::int64_t age_ms) {
    const std::int64_t minutes = std::max<std::int64_t>(age_ms, 0) / 60'000;
    const auto text = [](std::int64_t count, const char* unit) {
        return fmt::format("{} {}{}", count, unit, count == 1 ? "" : "s");
    };
    if (minutes < 60) return text(minutes, "minute");
    if (minutes < 48 * 60) return text(minutes / 60, "hour");
    return text(minutes / (24 * 60), "day");
}

/// None if the report is gone, not done or cannot be read.
std::optional<report::Report> stored_report(Store& store, const std::string& id) {
    const auto record = store.reports().find(id);
    if (!record || record->status != Status::done) return std::nullopt;
    try {
        report::Report report = read_report(nlohmann::json::parse(record->report));
        check_comparable(report);
        return report;
    } catch (const std::exception& error) {
        spdlog::error("the report {} cannot be compared with: {}", id, error.what());
        return std::nullopt;
    }
}

std::vector<Accepted> accepted_for(Store& store, const std::string& against, std::int64_t now_ms) {
    std::vector<Accepted> all;
    if (!against.starts_with(baseline_prefix)) {
        if (auto report = stored_report(store, against)) all.push_back({.report = std::move(*report)});
        return all;
    }
    for (const AcceptedReport& one : store.baselines().list(against.substr(baseline_prefix.size())))
        if (auto report = stored_report(store, one.report_id))
            all.push_back({.report = std::move(*report),
                           .baseline = one.name,
                           .accepted_at = utc_text(one.accepted_ms),
                           .by = one.by,
                           .age = age_text(now_ms - one.accepted_ms)});
    return all;
}

}  // namespace

void compare_with_baseline(Store& store, FinishedReport& finished) {
    const nlohmann::json against = finished.report.at("spec").value("against", nlohmann::json());
    if (!against.is_string()) return;
    auto report = from_document<report::Report>(finished.report);
    const auto own = [&](const report::Picture& picture) { return finished.read_blob(picture.sha256); };
    const auto accepted = [&](const report::Picture& picture) {
        const auto blob = store.blobs().open(picture.sha256);
        if (!blob) throw DamagedData(fmt::format("the picture {} is missing", picture.sha256));
        return read_all(*blob->content, max_picture_bytes);
    };
    compare_against(report, accepted_for(store, against, finished.finished_ms), own, accepted);
    finished.report = to_document(report);
}

}  // namespace sheer
