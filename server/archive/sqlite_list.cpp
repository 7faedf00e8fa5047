#include <spdlog/spdlog.h>

#include "server/archive/sqlite_reports.h"
#include "server/archive/sqlite_steps.h"

namespace sheer {

using nlohmann::json;

namespace {

/// `text` for LIKE ... ESCAPE '\', to be found anywhere.
std::string like_pattern(const std::string& text) {
    std::string pattern = "%";
    for (const char c : text) {
        if (c == '%' || c == '_' || c == '\\') pattern += '\\';
        pattern += c;
    }
    return pattern + "%";
}

struct Query {
    std::string where = "1";
    std::vector<std::string> values;

    void add(const std::string& condition, const std::vector<std::string>& more_values) {
        where += " AND " + condition;
        values.insert(values.end(), more_values.begin(), more_values.end());
    }
};

Query query_of(const ListFilter& filter) {
    Query query;
    if (filter.status) query.add("status = ?", {std::string(status_text(*filter.status))});
    if (!filter.scene.empty()) query.add("scene = ?", {filter.scene});
    if (!filter.method.empty())
        query.add("EXISTS (SELECT 1 FROM report_methods m WHERE m.report_id = id AND m.method = lower(?))",
                  {filter.method});
    if (!filter.q.empty()) {
        const std::string pattern = like_pattern(filter.q);
        query.add(
            "(title LIKE ? ESCAPE '\\' OR EXISTS (SELECT 1 FROM report_tags t WHERE t.report_id = id AND t.value "
            "LIKE ? ESCAPE '\\'))",
            {pattern, pattern});
    }
    if (!filter.tag.empty()) {
        const std::size_t colon = filter.tag.find(':');
        const std::string name = filter.tag.substr(0, colon);
        if (colon == std::string::npos) {
            query.add("EXISTS (SELECT 1 FROM report_tags t WHERE t.report_id = id AND t.name = ?)", {name});
        } else {
            query.add("EXISTS (SELECT 1 FROM report_tags t WHERE t.report_id = id AND t.name = ? AND t.value = ?)",
                      {name, filter.tag.substr(colon + 1)});
        }
    }
    return query;
}

ReportSummary summary_of(SQLite::Database& database, SQLite::Statement& row) {
    ReportSummary summary{.id = row.getColumn(0).getString()};
    summary.status = status_from(row.getColumn(1).getString()).value_or(Status::failed);
    summary.progress = row.getColumn(2).getDouble();
    summary.created_ms = row.getColumn(3).getInt64();
    if (!row.getColumn(4).isNull()) summary.finished_ms = row.getColumn(4).getInt64();
    summary.title = row.getColumn(5).getString();
    summary.scene = row.getColumn(6).getString();
    summary.spec_sha256 = row.getColumn(7).getString();
    summary.error = error_of(row.getColumn(8), row.getColumn(9));
    summary.verdict = row.getColumn(10).getString();
    if (!row.getColumn(11).isNull()) {
        summary.preview = json::parse(row.getColumn(11).getString(), nullptr, false);
        if (!summary.preview.is_object()) {
            spdlog::error("report {}: its preview in the archive is not JSON", summary.id);
            summary.preview = nullptr;
            summary.broken = "its preview cannot be read";
        }
    }
    SQLite::Statement methods(database, "SELECT method FROM report_methods WHERE report_id = ? ORDER BY position");
    methods.bind(1, summary.id);
    while (methods.executeStep()) summary.methods.push_back(methods.getColumn(0).getString());
    SQLite::Statement tags(database, "SELECT name, value FROM report_tags WHERE report_id = ?");
    tags.bind(1, summary.id);
    while (tags.executeStep()) summary.tags[tags.getColumn(0).getString()] = tags.getColumn(1).getString();
    return summary;
}

}  // namespace

ReportPage SqliteReports::list(const ListFilter& filter) {
    const Query of_all = query_of(filter);
    Query query = of_all;
    if (!filter.before_id.empty()) query.add("id < ?", {filter.before_id});
    return m_archive.read([&](SQLite::Database& database) {
        // One transaction, so that the lines, their methods and their tags are consistent.
        SQLite::Transaction transaction(database, SQLite::TransactionBehavior::DEFERRED);
        SQLite::Statement rows(database,
                               "SELECT id, status, progress, created_ms, finished_ms, title, scene, spec_sha256, "
                               "error_title, error_detail, verdict, preview FROM reports WHERE " +
                                   query.where + " ORDER BY id DESC LIMIT ?");
        int index = 0;
        for (const std::string& value : query.values) rows.bind(++index, value);
        rows.bind(++index, filter.limit + 1);
        ReportPage page;
        SQLite::Statement count(database, "SELECT COUNT(*) FROM reports WHERE " + of_all.where);
        int place = 0;
        for (const std::string& value : of_all.values) count.bind(++place, value);
        if (count.executeStep()) page.count = count.getColumn(0).getInt64();
        while (rows.executeStep()) {
            page.more = static_cast<int>(page.reports.size()) == filter.limit;
            if (page.more) break;
            page.reports.push_back(summary_of(database, rows));
        }
        return page;
    });
}

}  // namespace sheer
