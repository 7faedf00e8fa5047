// sheer-bench: a comparison as numbers, on a host that has EGL and nothing else of what `sheer` needs. It has no
// pictures and reads no files but the spec.
#include <fmt/format.h>

#include <array>
#include <optional>

#include "renderer/command/command.h"
#include "renderer/compare.h"
#include "renderer/gl/context_kinds.h"
#include "renderer/report/report.h"

namespace {

using namespace sheer;

struct Arguments {
    cli::Source source;
    std::string out;
    gl::ContextRequest context{.context = "egl", .device = {}, .disabled_workarounds = {}};
};

/// A file that is there whole or not at all. Throws std::runtime_error, naming it, at once if it cannot be written.
class WholeFile {
  public:
    explicit WholeFile(std::filesystem::path path) : m_path(std::move(path)), m_partial(m_path) {
        m_partial += ".partial";
        cli::write_text(m_partial, "");
    }
    ~WholeFile() {
        std::error_code ignored;
        std::filesystem::remove(m_partial, ignored);
    }
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    void write(const std::string& text) {
        cli::write_text(m_partial, text);
        std::filesystem::rename(m_partial, m_path);
    }

  private:
    std::filesystem::path m_path, m_partial;
};

int run_bench(const Arguments& arguments) {
    const std::string created_at = utc_now();
    const Spec spec = cli::read_spec(arguments.source);
    std::optional<WholeFile> out;
    if (!arguments.out.empty()) out.emplace(arguments.out);
    const std::array kinds{gl::Kind{"egl", gl::egl_candidates, true}};
    const auto context = gl::create_context(arguments.context, kinds);
    const Device device = describe_device(*context);
    nlohmann::json report;
    {
        cli::ProgressBar bar;
        NoAssets assets;
        ReportMaker maker(spec, device, nullptr, created_at);
        compare(
            spec, *context, assets, [&](double fraction, const std::string& stage) { bar.show(fraction, stage); },
            [&](const Run& run) { maker.add(run); });
        report = maker.finish();
    }
    report["provenance"]["rerun"] = cli::rerun_command("sheer-bench", arguments.source, arguments.context) +
                                    (device.info.name.empty() ? "" : " --device " + device.info.name);
    if (out) out->write(report.dump(2) + "\n");
    fmt::print("{}", report_table(report));
    return report["verdict"] == "failed" ? cli::exit_check_failed : cli::exit_ok;
}

}  // namespace

int main(int argc, char** argv) {
    cli::log_to_stderr("sheer-bench");
    CLI::App app{"Compares transparency methods through EGL and prints the numbers."};
    Arguments arguments;
    cli::add_source_options(app, arguments.source);
    cli::add_device_options(app, arguments.context);
    app.add_option("--out", arguments.out, "File for the report: report.json of `sheer compare`, without its pictures");
    int exit_code = cli::exit_ok;
    app.callback([&] { exit_code = cli::guarded([&] { return run_bench(arguments); }); });
    return cli::run_command_line(app, argc, argv, exit_code);
}
