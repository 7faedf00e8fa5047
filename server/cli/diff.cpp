#include "renderer/files/diff.h"

#include <fmt/format.h>

#include "renderer/command/signal_watch.h"
#include "renderer/files/blob_sink.h"
#include "server/cli/commands.h"
#include "server/cli/output_folder.h"

namespace sheer::cli {

using nlohmann::json;

namespace {

struct DiffArguments {
    std::string a, b, out;
    bool as_json = false;
};

/// A report.json and the folder that its pictures are in.
class ReportFile {
  public:
    /// `path` is the file, or the folder that holds it. Throws UsageError if it cannot be read.
    explicit ReportFile(const std::filesystem::path& path)
        : m_file(std::filesystem::is_directory(path) ? path / "report.json" : path) {
        try {
            m_report = json::parse(read_text(m_file));
        } catch (const json::exception&) {
            throw UsageError(m_file.string() + " is not JSON");
        } catch (const std::exception& error) {
            throw UsageError(error.what());
        }
        if (!m_report.is_object() || !m_report.contains("runs") || !m_report.contains("spec"))
            throw UsageError(m_file.string() + " is not a report");
    }

    DiffSide side() const {
        return {m_report, [this](const json& image) {
                    return read_text(m_file.parent_path() / image.at("url").get<std::string>());
                }};
    }

  private:
    std::filesystem::path m_file;
    json m_report;
};

json diff(const ReportFile& a, const ReportFile& b, const DiffOptions& options) {
    try {
        return diff_reports(a.side(), b.side(), options);
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
json diff_into(const std::string& out, const ReportFile& a, const ReportFile& b) {
    OutputFolder folder(out, {"diff.json", {}, {}});
    std::mutex busy;
    SignalWatch watch(busy, [&folder](int) { folder.discard(); });
    FolderSink maps(folder.partial());
    LockedSink sink(maps, busy);
    json result = diff(a, b, {.pictures = &sink});
    const std::lock_guard lock(busy);
    write_text(folder.partial() / "diff.json", result.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
    folder.commit();
    watch.finish();
    return result;
}

int run_diff(const DiffArguments& options) {
    const ReportFile a(options.a), b(options.b);
    const json result = options.out.empty() ? diff(a, b, {}) : diff_into(options.out, a, b);
    fmt::print("{}", options.as_json ? result.dump(2) + "\n" : diff_table(result));
    return is_worse(result) ? exit_check_failed : exit_ok;
}

}  // namespace

void add_diff(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("diff", "Say what changed from one report to another one of the same spec");
    auto options = std::make_shared<DiffArguments>();
    command->add_option("a", options->a, "The report before: report.json, or the folder of compare --out")->required();
    command->add_option("b", options->b, "The report after")->required();
    command->add_option("--out", options->out, "Folder for diff.json and the FLIP maps of the pictures that differ");
    command->add_flag("--json", options->as_json, "Print JSON instead of a table");
    command->callback([options, &exit_code] { exit_code = guarded([&] { return run_diff(*options); }); });
}

}  // namespace sheer::cli
