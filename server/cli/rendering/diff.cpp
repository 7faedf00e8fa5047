#include "renderer/diff/diff.h"

#include <fmt/format.h>

#include "renderer/command/signal_watch.h"
#include "renderer/core/files.h"
#include "renderer/files/report_document.h"
#include "renderer/params/json_text.h"
#include "renderer/pictures/blob_sink.h"
#include "server/cli/output_folder.h"
#include "server/cli/rendering/commands.h"

namespace sheer::cli {

using nlohmann::json;

namespace {

struct DiffArguments {
    std::string a, b, out;
    std::vector<std::string> allow;
    bool as_json = false;
    DiffTolerance tolerance;
};

/// A report.json and the folder with its pictures.
class ReportFile {
  public:
    /// `path` is the file, or the folder that contains it. Throws UsageError if it cannot be read or is not a report.
    explicit ReportFile(const std::filesystem::path& path)
        : m_file(std::filesystem::is_directory(path) ? path / "report.json" : path) {
        try {
            m_report = read_report(json::parse(read_file(m_file)));
        } catch (const DocumentError& wrong) {
            throw UsageError(fmt::format("{} is not a report: {}", m_file.string(), wrong.what()));
        } catch (const json::exception&) {
            throw UsageError(m_file.string() + " is not JSON");
        } catch (const std::exception& error) {
            throw UsageError(error.what());
        }
    }

    DiffSide side() const {
        return {m_report,
                [this](const report::Picture& picture) { return read_file(m_file.parent_path() / picture.url); }};
    }

  private:
    std::filesystem::path m_file;
    report::Report m_report;
};

diff::Diff compare_files(const ReportFile& a, const ReportFile& b, const DiffOptions& options) {
    try {
        return diff_reports(a.side(), b.side(), options);
    } catch (const DiffConflict& conflict) {
        if (conflict.allowable().empty()) throw;
        throw UsageError(fmt::format("the reports cannot be compared:\n{}\nto compare them nevertheless: --allow {}",
                                     conflict.what(), fmt::join(conflict.allowable(), " --allow ")));
    } catch (const SpecError&) {
        throw;
    } catch (const std::exception& error) {
        throw UsageError(fmt::format("the reports cannot be compared: {}", error.what()));
    }
}

/// Holds a lock while it writes.
class LockedSink : public BlobSink {
  public:
    LockedSink(BlobSink& sink, std::mutex& busy) : m_sink(sink), m_busy(busy) {}
    std::string put(const std::string& sha256, const std::string& bytes, const std::string& name,
                    const std::string& media_type) override {
        const std::lock_guard lock(m_busy);
        return m_sink.put(sha256, bytes, name, media_type);
    }

  private:
    BlobSink& m_sink;
    std::mutex& m_busy;
};

/// The diff, with diff.json and the FLIP maps in a folder.
diff::Diff diff_into(const DiffArguments& arguments, const ReportFile& a, const ReportFile& b) {
    OutputFolder folder(arguments.out, {"diff.json", {}, {}});
    std::mutex busy;
    SignalWatch watch(busy, [&folder](int) { folder.discard(); });
    FolderSink maps(folder.partial());
    LockedSink sink(maps, busy);
    diff::Diff result = compare_files(a, b, {.pictures = &sink, .allow = arguments.allow});
    const std::lock_guard lock(busy);
    write_file(folder.partial() / "diff.json", json_page(to_document(result)));
    folder.commit();
    watch.finish();
    return result;
}

int run_diff(const DiffArguments& options) {
    const ReportFile a(options.a), b(options.b);
    const diff::Diff result =
        options.out.empty() ? compare_files(a, b, {.allow = options.allow}) : diff_into(options, a, b);
    const std::vector<std::string> worse = changes_for_the_worse(result, options.tolerance);
    if (options.as_json) {
        fmt::print("{}", json_page(to_document(result)));
    } else {
        fmt::print("{}{}", diff_table(result), worse.empty() ? "" : "\n");
        for (const std::string& one : worse) fmt::print("WORSE  {}\n", one);
    }
    return worse.empty() ? exit_ok : exit_check_failed;
}

}  // namespace

void add_diff(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("diff", "Show what changed between two reports of the same spec");
    auto options = std::make_shared<DiffArguments>();
    command->add_option("a", options->a, "The earlier report: report.json, or the folder of compare --out")->required();
    command->add_option("b", options->b, "The later report")->required();
    command->add_option("--out", options->out, "Folder for diff.json and the FLIP maps of the pictures that differ");
    command
        ->add_option("--allow", options->allow,
                     "JSON pointer into the spec, such as /scene/shading/glsl: the field there may differ (repeatable)")
        ->expected(1)
        ->take_all()
        ->type_name("POINTER");
    command->add_option("--max-flip", options->tolerance.max_flip, "Mean FLIP error that a changed picture may have")
        ->check(CLI::Range(0.0, 1.0));
    command
        ->add_option("--max-slowdown", options->tolerance.max_slowdown,
                     "How many times as long a method may take, such as 1.2")
        ->check(CLI::Range(1.0, 1000.0));
    command->add_flag("--json", options->as_json, "Print JSON instead of a table");
    command->footer("Example: sheer diff before/report.json after/report.json --max-flip 0.01 --max-slowdown 1.2");
    command->callback([options, &exit_code] { exit_code = guarded([&] { return run_diff(*options); }); });
}

}  // namespace sheer::cli
