// The care of an archive, beside a running service or without one.
#include <fmt/format.h>

#include <fstream>

#include "renderer/core/clock.h"
#include "renderer/core/sha256.h"
#include "renderer/params/json_text.h"
#include "server/archive/archive_copy.h"
#include "server/cli/archive_arguments.h"
#include "server/cli/commands.h"
#include "server/cli/open_store.h"
#include "server/cli/packed_files.h"
#include "server/cli/report_import.h"
#include "server/cli/service_config.h"
#include "server/http/problem.h"
#include "server/http/report_zip.h"
#include "server/jobs/prune_timer.h"
#include "server/worker/scratch.h"

namespace sheer::cli {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

std::unique_ptr<Store> opened_store(const ArchiveArguments& options) {
    const ServiceConfig config = load_service_config(options.config);
    const std::string& url = options.store.empty() ? config.store : options.store;
    // Opening would make a new archive.
    if (url.empty() && !fs::exists(DataFolder{options.data}.database()))
        throw UsageError(fmt::format("there is no archive in {}", options.data));
    return open_store(url, options.data, config.leases);
}

std::string megabytes(std::uint64_t bytes) {
    return fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6);
}

int check(const ArchiveArguments& options) {
    const auto store = opened_store(options);
    const CheckResult result = store->care().check(options.repair);
    for (const std::string& repair : result.repairs) fmt::print("repaired: {}\n", repair);
    for (const Finding& finding : result.findings)
        fmt::print("{}: {}\n", finding.kind == Finding::Kind::damage ? "damaged" : "left over", finding.text);
    fmt::print("{} reports, {} pictures, {} uploads, {}: {}\n", result.reports, result.pictures, result.uploads,
               megabytes(result.bytes), result.is_damaged() ? "damaged" : "everything is there");
    return result.is_damaged() ? exit_check_failed : exit_ok;
}

int collect(const ArchiveArguments& options) {
    const auto store = opened_store(options);
    const Garbage garbage = store->care().collect_garbage();
    sweep_scratch(DataFolder{options.data}.scratch(), store->reports());
    fmt::print("{} files with {} and {} rows are removed\n", garbage.files, megabytes(garbage.bytes), garbage.rows);
    return exit_ok;
}

int told_copy(const std::string& what, const BackupResult& result) {
    for (const std::string& damaged : result.damaged) fmt::print(stderr, "damaged: {}\n", damaged);
    fmt::print("{}: {} reports, {} pictures, {} uploads, {}\n", what, result.reports, result.pictures, result.uploads,
               megabytes(result.bytes));
    return result.damaged.empty() ? exit_ok : exit_check_failed;
}

int back_up(const ArchiveArguments& options) {
    const fs::path target = options.target;
    if (target.extension() != ".tar") {
        require_empty(target);
        return told_copy(target.string(), opened_store(options)->care().back_up(target));
    }
    if (fs::exists(target)) throw UsageError(fmt::format("{} exists already", target.string()));
    const fs::path copy = target.string() + ".folder";
    const BackupResult result = opened_store(options)->care().back_up(copy);
    write_tar(copy, target);
    fs::remove_all(copy);
    return told_copy(target.string(), result);
}

/// Only what a backup has: a tar file may name any path.
bool is_of_archive(const std::string& name) {
    if (name == "archive.sqlite") return true;
    const fs::path path(name);
    const std::string file = path.filename().string();
    return is_sha256(file) && (path == fs::path("blobs") / file.substr(0, 2) / file ||
                               path == fs::path("assets") / file.substr(0, 2) / file);
}

int restore(const ArchiveArguments& options) {
    if (!options.store.empty()) throw UsageError("a PostgreSQL store is restored by pg_restore");
    const DataFolder data{options.data};
    require_empty(data.root);
    int exit_code = exit_ok;
    if (fs::is_directory(options.target)) {
        exit_code = told_copy(options.data, copy_archive(DataFolder{options.target}, data));
    } else {
        fs::create_directories(data.root);
        extract_tar(options.target, data.root, is_of_archive);
    }
    const int checked = check(options);
    return exit_code == exit_ok ? checked : exit_code;
}

int export_report(const ArchiveArguments& options) {
    const auto store = opened_store(options);
    const std::string file = options.out.empty() ? fmt::format("sheer-{}.zip", options.target) : options.out;
    ContentPtr zip;
    try {
        zip = http::report_zip(*store, options.target);
    } catch (const http::Problem& problem) {
        throw UsageError(problem.what());
    }
    std::ofstream stream(file, std::ios::binary);
    std::string piece;
    for (std::uint64_t at = 0; at < zip->size_bytes(); at += piece.size()) {
        piece.resize(static_cast<std::size_t>(std::min<std::uint64_t>(1 << 20, zip->size_bytes() - at)));
        zip->read(at, piece);
        stream << piece;
    }
    if (!stream.flush()) throw UsageError(fmt::format("cannot write {}", file));
    fmt::print("{}\n", file);
    return exit_ok;
}

int import_report(const ArchiveArguments& options) {
    const auto store = opened_store(options);
    const ImportedReport report = read_report_zip(options.target);
    switch (store->care().import_report(report)) {
        case Care::Import::added:
            fmt::print("report {} is added\n", report.id);
            return exit_ok;
        case Care::Import::known:
            fmt::print("report {} is there already\n", report.id);
            return exit_ok;
        case Care::Import::restored:
            fmt::print("report {} is there already; pictures that were missing or damaged are restored\n", report.id);
            return exit_ok;
        case Care::Import::differs:
            break;
    }
    throw UsageError(fmt::format("the archive has another report {}", report.id));
}

int prune_reports(const ArchiveArguments& options) {
    const auto store = opened_store(options);
    std::vector<RetentionRule> rules = load_service_config(options.config).retention;
    if (options.rule.max_age_days || options.rule.max_reports || options.rule.max_bytes) rules = {options.rule};
    if (rules.empty())
        throw UsageError(
            "there is no rule: give --max-age-days, --max-reports or --max-bytes, or a --config with "
            "archive.retention");
    std::vector<PrunedReport> pruned = reports_to_prune(store->care().stored_reports(), rules, system_now_ms());
    if (!options.dry_run) pruned = prune(*store, pruned);
    std::uint64_t bytes = 0;
    for (const PrunedReport& report : pruned) {
        bytes += report.bytes;
        fmt::print("{}: {}\n", report.id, report.reason);
    }
    fmt::print("{} reports with {} {}\n", pruned.size(), megabytes(bytes),
               options.dry_run ? "would be removed" : "are removed");
    return exit_ok;
}

int pin(const ArchiveArguments& options) {
    const auto store = opened_store(options);
    switch (store->pins().pin({options.target, 0, options.by, options.reason})) {
        case Pins::Pinning::not_found:
            throw UsageError(fmt::format("there is no report {}", options.target));
        case Pins::Pinning::not_final:
            throw UsageError("only a report that has ended can be pinned");
        case Pins::Pinning::added:
        case Pins::Pinning::renewed:
            break;
    }
    fmt::print("report {} is pinned: it is neither deleted nor pruned\n", options.target);
    return exit_ok;
}

int unpin(const ArchiveArguments& options) {
    if (!opened_store(options)->pins().unpin(options.target))
        throw UsageError(fmt::format("report {} is not pinned, or does not exist", options.target));
    fmt::print("report {} is no longer pinned\n", options.target);
    return exit_ok;
}

}  // namespace

void add_archive(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("archive", "Check, copy, move and prune the reports of a service");
    command->require_subcommand(1);
    command->footer("Example: sheer archive fsck");
    add_archive_commands(*command,
                         {.fsck = check,
                          .gc = collect,
                          .backup = back_up,
                          .restore = restore,
                          .export_report = export_report,
                          .import_report = import_report,
                          .prune = prune_reports,
                          .pin = pin,
                          .unpin = unpin},
                         exit_code);
}

}  // namespace sheer::cli
