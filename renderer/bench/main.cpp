// sheer-bench: a comparison as numbers, on a host that has EGL but none of the other libraries that `sheer` needs. It
// writes no pictures and reads no file except the spec.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <mutex>
#include <optional>

#include "renderer/command/command.h"
#include "renderer/command/signal_watch.h"
#include "renderer/compare/compare.h"
#include "renderer/core/clock.h"
#include "renderer/core/files.h"
#include "renderer/gl/context_kinds.h"
#include "renderer/params/json_text.h"
#include "renderer/report/report.h"

namespace {

using namespace sheer;

struct Arguments {
    cli::Source source;
    std::string out;
    gl::ContextRequest context{.context = "egl", .device = {}, .disabled_workarounds = {}};
};

/// A file that is written completely or not at all. Its constructor throws std::runtime_error, naming it, if it cannot
/// be written.
class WholeFile {
  public:
    explicit WholeFile(std::filesystem::path path) : m_partial(std::move(path)) {
        m_partial += ".partial";
        write_file(m_partial, "");
    }
    ~WholeFile() {
        std::error_code ignored;
        std::filesystem::remove(m_partial, ignored);
    }
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    /// `path` is its own, or another one in the same folder.
    void write(const std::string& text, const std::filesystem::path& path) const {
        write_file(m_partial, text);
        std::filesystem::rename(m_partial, path);
    }

  private:
    std::filesystem::path m_partial;
};

class Bench {
  public:
    explicit Bench(const Arguments& arguments)
        : m_arguments(arguments), m_created_at(utc_now()), m_spec(cli::read_spec(arguments.source)) {
        if (!arguments.out.empty()) m_out.emplace(arguments.out);
    }

    int run() {
        report::Report report;
        {
            cli::SignalWatch watch(m_busy, [this](int signal) { end_by(signal); });
            try {
                render();
                const std::lock_guard lock(m_busy);
                watch.finish();
                report = m_maker->finish();
            } catch (const std::exception& error) {
                const std::lock_guard lock(m_busy);
                watch.finish();
                keep_finished(report::Status::failed, "Rendering failed", error.what());
                throw;
            }
        }
        write(report, m_arguments.out);
        return cli::exit_code_of(report);
    }

  private:
    void render() {
        const std::array kinds{gl::Kind{"egl", gl::egl_candidates, true}};
        const auto context = gl::open_device(m_arguments.context, kinds);
        const Device device = describe_device(*context);
        {
            const std::lock_guard lock(m_busy);
            m_maker.emplace(m_spec, device, nullptr, m_created_at);
            m_rerun = cli::rerun_command("sheer-bench", m_arguments.source, m_arguments.context) +
                      (device.info.name.empty() ? "" : " --device " + device.info.name);
        }
        cli::ProgressLine progress;
        NoAssets assets;
        compare(
            m_spec, *context, assets,
            [&](double fraction, const std::string& stage) {
                const std::lock_guard lock(m_busy);
                progress.show(fraction, stage);
            },
            [&](const Run& run) {
                const std::lock_guard lock(m_busy);
                m_maker->add(run);
            },
            m_maker->undecided());
    }

    void write(report::Report& report, const std::string& file) {
        report.provenance.rerun = m_rerun;
        if (m_out) m_out->write(json_page(to_document(report)), file);
        fmt::print("{}", report_table(report));
    }

    // With m_busy held.

    /// Writes the finished points to a file next to that of the whole report.
    void keep_finished(report::Status status, const std::string& title, const std::string& detail) {
        if (!m_maker || m_maker->runs() == 0) return;
        report::Report report = m_maker->finish_early(status, title, detail);
        m_maker.reset();
        write(report, m_arguments.out + ".incomplete");
    }

    void end_by(int signal) {
        cli::clear_progress_line();
        const std::string detail = fmt::format("ended by {}", cli::signal_name(signal));
        keep_finished(report::Status::cancelled, "Interrupted", detail);
        m_out.reset();
        std::fflush(stdout);
        fmt::print(stderr, "sheer-bench: {}\n", detail);
    }

    const Arguments& m_arguments;
    const std::string m_created_at;
    const Spec m_spec;
    std::optional<WholeFile> m_out;
    std::mutex m_busy;  ///< guards what follows and m_out while a SignalWatch exists
    std::optional<ReportMaker> m_maker;
    std::string m_rerun;
};

}  // namespace

int main(int argc, char** argv) {
    cli::log_to_stderr("sheer-bench");
    CLI::App app{"Compares transparency methods through EGL and prints the numbers.", "sheer-bench"};
    Arguments arguments;
    cli::add_source_options(app, arguments.source);
    cli::add_device_options(app, arguments.context);
    app.add_option("--out", arguments.out, "File for the report: report.json of `sheer compare`, without its pictures");
    int exit_code = exit_ok;
    app.callback([&] { exit_code = cli::guarded([&] { return Bench(arguments).run(); }); });
    return cli::run_command_line(app, argc, argv, exit_code);
}
