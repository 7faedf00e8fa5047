#include <fmt/format.h>

#include <optional>

#include "renderer/assets/file_assets.h"
#include "renderer/compare.h"
#include "renderer/files/blob_sink.h"
#include "renderer/files/html.h"
#include "renderer/report/report.h"
#include "server/cli/commands.h"
#include "server/cli/rendering.h"

namespace sheer::cli {

namespace {

struct CompareArguments {
    Source source;
    std::string out, junit;
    gl::ContextRequest context;
};

void write_report(const nlohmann::json& report, const std::filesystem::path& folder) {
    const auto read_picture = [&](const nlohmann::json& image) {
        return read_text(folder / image.at("url").get<std::string>());
    };
    write_text(folder / "report.html", report_html(report, read_picture));
    write_text(folder / "report.json", report.dump(2) + "\n");
}

int run_compare(const CompareArguments& options) {
    const std::string created_at = utc_now();
    const Spec spec = read_spec(options.source);
    std::optional<ReportFolder> folder;
    if (!options.out.empty()) folder.emplace(options.out);
    nlohmann::json report;
    {
        ProgressBar bar;
        const auto context = gl::create_context(options.context);
        FileAssets assets = assets_in_folder(std::filesystem::path(options.source.spec).parent_path());
        std::optional<FolderSink> sink;
        if (folder) sink.emplace(folder->partial());
        const Device device = describe_device(*context);
        ReportMaker maker(spec, device, sink ? &*sink : nullptr, created_at);
        compare(
            spec, *context, assets, [&](double fraction, const std::string& stage) { bar.show(fraction, stage); },
            [&](const Run& run) { maker.add(run); });
        report = maker.finish();
        report["provenance"]["rerun"] =
            rerun_command("sheer compare", options.source, options.context) + context_arguments(device);
        if (folder) {
            write_report(report, folder->partial());
            folder->commit();
        }
    }
    fmt::print("{}", report_table(report));
    if (!options.junit.empty()) write_text(options.junit, report_junit(report));
    if (folder) {
        fmt::print("\nReport: {}\n", (std::filesystem::absolute(options.out) / "report.html").string());
    } else {
        fmt::print("\nAdd --out DIR to keep the pictures and the report.\n");
    }
    return report["verdict"] == "failed" ? exit_check_failed : exit_ok;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("compare", "Render a comparison here and print its table");
    auto options = std::make_shared<CompareArguments>();
    add_source_options(*command, options->source);
    command->add_option("--out", options->out, "Folder for report.json, report.html and the pictures");
    command->add_option("--junit", options->junit, "File for the checks as JUnit XML");
    add_context_options(*command, options->context);
    command->callback([options, &exit_code] { exit_code = guarded([&] { return run_compare(*options); }); });
}

}  // namespace sheer::cli
