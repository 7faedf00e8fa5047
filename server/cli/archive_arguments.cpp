#include "server/cli/archive_arguments.h"

#include <fmt/format.h>

#include <memory>

#include "renderer/command/command.h"
#include "server/cli/open_store.h"

namespace sheer::cli {

namespace {

/// A command with --data, and the arguments that it fills.
struct ArchiveCommand {
    CLI::App* app;
    ArchiveArguments* options;
};

}  // namespace

void add_archive_commands(CLI::App& command, const ArchiveActions& actions, int& exit_code) {
    const auto add = [&](const std::string& name, const std::string& what, const std::string& example,
                         ArchiveAction action) -> ArchiveCommand {
        CLI::App* one = command.add_subcommand(name, what);
        one->footer(fmt::format("Example: sheer archive {}{}", name, example));
        auto options = std::make_shared<ArchiveArguments>();
        one->add_option("--data", options->data, "Folder of the archive, sheer-data if not given");
        one->add_option("--store", options->store, store_help)->envname(store_variable);
        one->add_option("--config", options->config, "The service's JSON file");
        one->callback([options, action, &exit_code] {
            exit_code = guarded([&] {
                try {
                    return action(*options);
                } catch (const UsageError&) {
                    throw;
                } catch (const std::exception& error) {
                    throw UsageError(error.what());
                }
            });
        });
        return {one, options.get()};
    };
    const ArchiveCommand fsck =
        add("fsck", "Read everything, and compare it with its hashes; exit code 1 if something is damaged",
            " --data sheer-data", actions.fsck);
    fsck.app->add_flag("--repair", fsck.options->repair,
                       "Move what is damaged or left over into DATA/quarantine, and make the index again");
    add("gc", "Remove files and rows to which nothing refers", "", actions.gc);
    const ArchiveCommand backup =
        add("backup", "Copy the archive while the service runs", " backup.tar", actions.backup);
    backup.app
        ->add_option("to", backup.options->target, "A new or empty folder, or a new file whose name ends with .tar")
        ->required();
    const ArchiveCommand restored = add("restore", "Copy a backup into an empty folder, and check it",
                                        " backup.tar --data new-folder", actions.restore);
    restored.app->add_option("from", restored.options->target, "The folder or .tar file of the backup")->required();
    const ArchiveCommand exported =
        add("export", "Write a done report as a ZIP file that another archive can import",
            " 01a2b3c4-0000-7000-8000-000000000001 --out report.zip", actions.export_report);
    exported.app->add_option("id", exported.options->target, "Id of the report")->required();
    exported.app->add_option("--out", exported.options->out, "The file, sheer-ID.zip if not given");
    const ArchiveCommand imported =
        add("import", "Add the report of a ZIP file from export or report.zip", " report.zip", actions.import_report);
    imported.app->add_option("zip", imported.options->target, "The file")->required();
    const ArchiveCommand pruned =
        add("prune", "Remove old reports by archive.retention of --config, or by one rule given here",
            " --max-age-days 90 --dry-run", actions.prune);
    pruned.app->add_option("--tag", pruned.options->rule.tag, "Only reports with this tag: name or name:value");
    pruned.app->add_option("--max-age-days", pruned.options->rule.max_age_days, "Remove older ones");
    pruned.app->add_option("--max-reports", pruned.options->rule.max_reports, "Keep so many of the newest");
    pruned.app->add_option("--max-bytes", pruned.options->rule.max_bytes, "Keep the newest with so many bytes");
    pruned.app->add_flag("--dry-run", pruned.options->dry_run, "Only say which");
    const ArchiveCommand pinned = add("pin", "Keep a report: it is neither deleted nor pruned",
                                      " 01a2b3c4-0000-7000-8000-000000000001 --reason release", actions.pin);
    pinned.app->add_option("id", pinned.options->target, "Id of the report")->required();
    pinned.app->add_option("--by", pinned.options->by, "Who pins it; by default $USER")->envname("USER");
    pinned.app->add_option("--reason", pinned.options->reason, "Why");
    const ArchiveCommand unpinned =
        add("unpin", "Pin a report no longer", " 01a2b3c4-0000-7000-8000-000000000001", actions.unpin);
    unpinned.app->add_option("id", unpinned.options->target, "Id of the report")->required();
}

}  // namespace sheer::cli
