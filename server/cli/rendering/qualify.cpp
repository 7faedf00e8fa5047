// Measures how far verdicts on times can be trusted on a device.
#include <fmt/format.h>

#include <chrono>

#include "renderer/assets/file_assets.h"
#include "renderer/compare/compare.h"
#include "renderer/core/clock.h"
#include "renderer/params/json_text.h"
#include "renderer/report/qualification.h"
#include "renderer/report/report.h"
#include "server/cli/rendering/commands.h"
#include "server/cli/rendering/rendering.h"

namespace sheer::cli {

namespace {

struct QualifyArguments {
    std::string data;
    int seconds = 120, rounds = 20, size_px = 256;
    bool as_json = false, keep = true;
    gl::ContextRequest context;
};

report::Report one_report(const Spec& spec, gl::Context& context) {
    NoAssets assets;
    ReportMaker maker(spec, describe_device(context), nullptr, utc_now());
    compare(
        spec, context, assets, [](double, const std::string&) {}, [&](const Run& run) { maker.add(run); });
    return maker.finish();
}

int qualify(const QualifyArguments& options) {
    using Clock = std::chrono::steady_clock;
    const Spec spec = parse_spec(qualification_spec(options.size_px, options.rounds));
    const auto context = gl::open_device(options.context);
    QualificationTally tally;
    ProgressLine progress;
    const auto begin = Clock::now();
    const auto elapsed_s = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    do {
        tally.add(one_report(spec, *context));
        progress.show(std::min(1.0, elapsed_s() / options.seconds), fmt::format("report {}", tally.reports()));
    } while (elapsed_s() < options.seconds);
    const report::Qualification result = tally.result(utc_now());
    const std::filesystem::path file =
        options.data.empty() ? qualifications_file() : std::filesystem::path(options.data) / "qualifications.json";
    if (options.keep) keep_qualification(file, result);
    clear_progress_line();
    fmt::print("{}", options.as_json ? json_page(to_document(result)) : qualification_table(result));
    if (options.keep && !options.as_json) fmt::print("\nKept in {}; reports of this device quote it.\n", file.string());
    return exit_ok;
}

}  // namespace

void add_qualify(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand(
        "qualify", "Measure how often verdicts on times are wrong here, and which slowdowns are found");
    auto options = std::make_shared<QualifyArguments>();
    command->add_option("--seconds", options->seconds, "How long it measures; at least one report")
        ->check(CLI::Range(1, 86'400))
        ->capture_default_str();
    command->add_option("--rounds", options->rounds, "Rounds of each report")
        ->check(CLI::Range(10, 1000))
        ->capture_default_str();
    command->add_option("--size", options->size_px, "Width and height of the picture, in pixels")
        ->check(CLI::Range(16, 4096))
        ->capture_default_str();
    command->add_option("--data", options->data, "Folder of the service whose reports quote it; by default yours do");
    command->add_flag("--json", options->as_json, "Print the result as JSON");
    command->add_flag("!--dont-keep", options->keep, "Only print it");
    add_context_options(*command, options->context);
    command->footer("Example: sheer qualify --seconds 300 --data sheer-data");
    command->callback([options, &exit_code] { exit_code = guarded([&] { return qualify(*options); }); });
}

}  // namespace sheer::cli
