#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <optional>

#include "server/jobs/limits.h"
#include "server/postgres/list_query.h"
#include "server/postgres/postgres_reports.h"
#include "server/postgres/postgres_steps.h"
#include "server/postgres/report_rows.h"
#include "server/storage/packed_text.h"

namespace sheer::postgres {

using nlohmann::json;

namespace {

/// In the order in which summary_at() reads them.
constexpr const char* summary_columns =
    "r.id, coalesce(j.status, r.status), coalesce(j.progress, r.progress), r.created_ms, r.finished_ms, r.title, "
    "r.scene, "
    "r.spec_sha256, r.error_title, r.error_detail, r.verdict, r.device, r.methods, r.tags, r.preview, "
    "EXISTS (SELECT FROM pins p WHERE p.report_id = r.id)";

ReportSummary summary_at(const Rows& rows, int row) {
    ReportSummary summary{.id = rows.text(row, 0), .status = status_at(rows, row, 1), .progress = rows.number(row, 2)};
    summary.created_ms = rows.integer(row, 3);
    if (!rows.is_null(row, 4)) summary.finished_ms = rows.integer(row, 4);
    summary.title = rows.text(row, 5);
    summary.scene = rows.text(row, 6);
    summary.spec_sha256 = rows.text(row, 7);
    summary.error = error_at(rows, row, 8);
    summary.verdict = rows.text(row, 10);
    summary.device = rows.text(row, 11);
    summary.methods = rows.texts(row, 12);
    summary.tags = json::parse(rows.text(row, 13), nullptr, false);
    if (!rows.is_null(row, 14)) summary.preview = json::parse(rows.text(row, 14), nullptr, false);
    summary.pinned = rows.flag(row, 15);
    if (!summary.tags.is_object()) {
        summary.tags = json::object();
        summary.broken = "its tags cannot be read";
    }
    if (summary.preview.is_discarded()) {
        summary.preview = nullptr;
        summary.broken = "its preview cannot be read";
    }
    if (!summary.broken.empty()) spdlog::error("report {}: {}", summary.id, summary.broken);
    return summary;
}

/// Nothing if there are none or they are damaged.
std::optional<ReportNumbers> numbers_at(const Rows& rows, int row, const std::map<std::int64_t, std::string>& names) {
    if (rows.is_null(row, 2)) return std::nullopt;
    try {
        return ReportNumbers{names.at(rows.integer(row, 2)), unpack_text(rows.bytes(row, 3), max_report_bytes)};
    } catch (const DamagedData&) {
        return std::nullopt;
    }
}

std::map<std::int64_t, std::string> names_of(Connection& connection, const Rows& reports) {
    std::vector<std::string> ids;
    for (int i = 0; i < reports.count(); ++i)
        if (!reports.is_null(i, 2)) ids.push_back(std::to_string(reports.integer(i, 2)));
    const Rows rows = connection.run("SELECT id, names FROM number_names WHERE id = ANY ($1::bigint[])", {ids});
    std::map<std::int64_t, std::string> names;
    for (int i = 0; i < rows.count(); ++i) names[rows.integer(i, 0)] = rows.text(i, 1);
    return names;
}

}  // namespace

ReportPage PostgresReports::list(const ListFilter& filter) {
    const ListQuery query(filter);
    return m_database.read_one_state([&](Connection& connection) {
        ReportPage page;
        const Rows rows = query.page(connection, summary_columns);
        const Query counting = query.count();
        page.more = rows.count() > filter.limit;
        for (int i = 0; i < std::min(rows.count(), filter.limit); ++i) page.reports.push_back(summary_at(rows, i));
        const std::int64_t found = connection.run(counting.text, counting.values).integer(0, 0);
        page.count_is_exact = query.counts_all() || found <= max_exact_count;
        page.count = page.count_is_exact ? found : max_exact_count;
        return page;
    });
}

std::vector<TrendReport> PostgresTrends::reports(const ListFilter& filter) {
    ListFilter done = filter;
    done.status = Status::done;
    const ListQuery query(done);
    return m_database.read_one_state([&](Connection& connection) {
        const Rows page = query.page(connection, "r.id");
        std::vector<std::string> ids;
        for (int i = 0; i < page.count(); ++i) ids.push_back(page.text(i, 0));
        const Rows rows = connection.run(
            "SELECT r.id, r.created_ms, n.names, n.numbers FROM reports r LEFT JOIN report_numbers n ON n.report_id = "
            "r.id "
            "WHERE r.id = ANY ($1) ORDER BY r.id DESC",
            {ids});
        const auto names = names_of(connection, rows);
        std::vector<TrendReport> reports;
        for (int i = 0; i < std::min(rows.count(), filter.limit); ++i)
            reports.push_back({rows.text(i, 0), rows.integer(i, 1), numbers_at(rows, i, names)});
        std::ranges::reverse(reports);
        return reports;
    });
}

void PostgresTrends::keep(const std::string& report_id, const ReportNumbers& numbers) {
    m_database.write([&](Connection& connection) { add_numbers(connection, report_id, numbers); });
}

}  // namespace sheer::postgres
