#include "renderer/compare/compare.h"

#include <fmt/format.h>

#include <mutex>
#include <optional>

#include "renderer/assets/file_assets.h"
#include "renderer/command/signal_watch.h"
#include "renderer/core/clock.h"
#include "renderer/core/files.h"
#include "renderer/files/html.h"
#include "renderer/params/json_text.h"
#include "renderer/pictures/blob_sink.h"
#include "renderer/report/report.h"
#include "server/cli/output_folder.h"
#include "server/cli/outputs.h"
#include "server/cli/rendering/commands.h"
#include "server/cli/rendering/rendering.h"

namespace sheer::cli {

namespace {

namespace fs = std::filesystem;

struct CompareArguments {
    Source source;
    std::string out;
    OutputOptions outputs;
    gl::ContextRequest context;
};

void write_report(const report::Report& report, const fs::path& folder) {
    const auto read_picture = [&](const report::Picture& picture) { return read_file(folder / picture.url); };
    write_file(folder / "report.html", report_html(report, read_picture));
    write_file(folder / "report.json", json_page(to_document(report)));
}

/// A comparison from its spec to its output. However it ends, finished parts are written.
class Comparison {
  public:
    explicit Comparison(const CompareArguments& options)
        : m_options(options), m_created_at(utc_now()), m_outputs(options.outputs, options.source.spec, options.out) {}

    int run() {
        {
            SignalWatch watch(m_busy, [this](int signal) { end_by(signal); });
            try {
                prepare();
                render();
                const std::lock_guard lock(m_busy);
                finish();
                watch.finish();
            } catch (const std::exception& error) {
                const std::lock_guard lock(m_busy);
                watch.finish();
                fail(error);
                throw;
            }
        }
        m_outputs.print(m_report);
        if (m_options.outputs.quiet || m_options.outputs.json) return exit_code_of(m_report);
        if (m_place.empty()) {
            fmt::print("\nAdd --out DIR to keep the pictures and the report.\n");
        } else {
            fmt::print("\nReport: {}\n", page().string());
        }
        return exit_code_of(m_report);
    }

  private:
    void prepare() {
        Spec spec = read_spec(m_options.source);
        const std::lock_guard lock(m_busy);
        m_spec = std::move(spec);
        if (!m_options.out.empty())
            m_folder.emplace(m_options.out, OutputNames{"report.json", {"report.html"}, picture_stems(*m_spec)});
    }

    void render() {
        ProgressLine progress;
        const auto context = gl::open_device(m_options.context);
        FileAssets assets = assets_in_folder(fs::path(m_options.source.spec).parent_path());
        const Device device = describe_device(*context);
        {
            const std::lock_guard lock(m_busy);
            if (m_folder) m_sink.emplace(m_folder->partial());
            m_maker.emplace(*m_spec, device, m_sink ? &*m_sink : nullptr, m_created_at);
            m_rerun = rerun_command("sheer compare", m_options.source, m_options.context) + context_arguments(device);
        }
        compare(
            *m_spec, *context, assets,
            [&](double fraction, const std::string& stage) {
                const std::lock_guard lock(m_busy);
                if (!m_options.outputs.quiet) progress.show(fraction, stage);
            },
            [&](const Run& run) {
                const std::lock_guard lock(m_busy);
                m_maker->add(run);
            },
            m_maker->undecided());
    }

    // The following functions are called with m_busy locked.

    void finish() {
        report::Report report = m_maker->finish();
        m_maker.reset();
        if (m_options.outputs.gate) require_checks(report);
        keep(std::move(report), true);
        m_outputs.write(m_report);
    }

    void keep(report::Report report, bool complete) {
        report.provenance.rerun = m_rerun;
        if (!m_options.source.spec.empty()) report.provenance.spec = fs::absolute(m_options.source.spec).string();
        m_report = std::move(report);
        if (!m_folder) return;
        write_report(m_report, m_folder->partial());
        m_place = fs::absolute(m_folder->commit(complete)).lexically_normal();
    }

    /// Writes the finished points as a report that says that it is incomplete. Returns how many points it has.
    std::size_t keep_finished(report::Status status, const std::string& title, const std::string& detail) {
        const std::size_t points = m_maker ? m_maker->runs() : 0;
        if (points == 0) {
            m_outputs.write_error(title, detail);
            if (m_folder) m_folder->discard();
            return 0;
        }
        report::Report report = m_maker->finish_early(status, title, detail);
        m_maker.reset();
        m_outputs.write(report);
        keep(std::move(report), false);
        m_outputs.print(m_report);
        return points;
    }

    std::string what_is_kept(std::size_t points) const {
        if (points == 0) return "no point was finished";
        std::string text = fmt::format("{} of {} points were finished", points, m_spec->points.size());
        return m_place.empty() ? text : fmt::format("{}: {}", text, page().string());
    }

    void fail(const std::exception& error) {
        const bool is_callers = dynamic_cast<const SpecError*>(&error) || dynamic_cast<const UsageError*>(&error);
        try {
            const std::size_t points =
                keep_finished(report::Status::failed, is_callers ? "The comparison cannot be made" : "Rendering failed",
                              error.what());
            if (points > 0) fmt::print(stderr, "sheer: {}\n", what_is_kept(points));
        } catch (const std::exception& more) {
            fmt::print(stderr, "sheer: the finished points cannot be saved: {}\n", more.what());
        }
    }

    void end_by(int signal) {
        clear_progress_line();
        const std::string detail = fmt::format("it was ended by {}", signal_name(signal));
        const std::size_t points = keep_finished(report::Status::cancelled, "Interrupted", detail);
        std::fflush(stdout);
        fmt::print(stderr, "sheer: {}; {}\n", detail, what_is_kept(points));
    }

    fs::path page() const { return m_place / "report.html"; }

    const CompareArguments& m_options;
    const std::string m_created_at;
    const Outputs m_outputs;
    std::mutex m_busy;  ///< guards all following members while a SignalWatch exists
    std::optional<Spec> m_spec;
    std::optional<OutputFolder> m_folder;
    std::optional<FolderSink> m_sink;
    std::optional<ReportMaker> m_maker;
    std::string m_rerun;
    report::Report m_report;
    fs::path m_place;  ///< the folder of the report; empty without --out
};

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("compare", "Render a comparison here and print its table");
    auto options = std::make_shared<CompareArguments>();
    add_source_options(*command, options->source);
    command->add_option("--out", options->out, "Folder for report.json, report.html and the pictures");
    add_output_options(*command, options->outputs);
    add_context_options(*command, options->context);
    command->footer("Example: sheer compare configs/specs/quick.json --out out --junit junit.xml");
    command->callback([options, &exit_code] { exit_code = guarded([&] { return Comparison(*options).run(); }); });
}

}  // namespace sheer::cli
