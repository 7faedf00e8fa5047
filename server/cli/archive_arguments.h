#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "server/jobs/retention.h"

namespace sheer::cli {

struct ArchiveArguments {
    std::string data = "sheer-data";
    std::string store;   ///< a URL, or "" for the archive in `data`
    std::string config;  ///< the service's configuration
    std::string target;  ///< a backup, an id or a ZIP file
    std::string out;
    RetentionRule rule;
    std::string by, reason;
    bool repair = false, dry_run = false;
};

using ArchiveAction = int (*)(const ArchiveArguments& options);

/// What each command does; they return the exit code, and throw UsageError and StoreError.
struct ArchiveActions {
    ArchiveAction fsck, gc, backup, restore, export_report, import_report, prune, pin, unpin;
};

/// Adds them below `command`.
void add_archive_commands(CLI::App& command, const ArchiveActions& actions, int& exit_code);

}  // namespace sheer::cli
