#include "server/worker/against.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "renderer/core/clock.h"
#include "renderer/core/exit_codes.h"
#include "renderer/files/report_document.h"

namespace sheer {

using nlohmann::json;

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

/// Null if the report is gone, not done or cannot be read.
json stored_report(Store& store, const std::string& id) {
    const auto record = store.reports().find(id);
    if (!record || record->status != Status::done) return nullptr;
    try {
        json document = json::parse(record->report);
        check_comparable(read_report(document));
        return document;
    } catch (const std::exception& error) {
        spdlog::error("the report {} cannot be compared with: {}", id, error.what());
        return nullptr;
    }
}

json accepted_for(Store& store, const std::string& against, std::int64_t now_ms) {
    json all = json::array();
    const auto add = [&](const std::string& id, const AcceptedReport& one, const std::string& accepted_at) {
        if (json report = stored_report(store, id); !report.is_null())
            all.push_back({{"report", std::move(report)},
                           {"baseline", one.name},
                           {"accepted_at", accepted_at},
                           {"by", one.by},
                           {"age", age_text(now_ms - one.accepted_ms)}});
    };
    if (!against.starts_with(baseline_prefix)) {
        add(against, {}, "");
    } else {
        for (const AcceptedReport& one : store.baselines().list(against.substr(baseline_prefix.size())))
            add(one.report_id, one, utc_text(one.accepted_ms));
    }
    return all;
}

}  // namespace

void compare_with_baseline(Store& store, FinishedReport& finished, const std::filesystem::path& pictures,
                           const std::string& data, const ChildLimits& limits) {
    const json against = finished.report.at("spec").value("against", json());
    if (!against.is_string()) return;
    const json question{{"report", finished.report}, {"accepted", accepted_for(store, against, finished.finished_ms)}};
    store.bring_here(question.dump());
    const ChildReply reply =
        ask_child({"against-stored", "--data", data, "--own", pictures.string()}, question.dump(), limits);
    json line = json::parse(reply.line, nullptr, false);
    if (reply.status.code != exit_ok || !line.is_object() || !line.contains("report"))
        throw std::runtime_error("the comparison with the baseline failed: " +
                                 ending_text("against-stored", reply.status));
    finished.report = std::move(line["report"]);
}

}  // namespace sheer
