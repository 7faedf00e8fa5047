// The worker's child process: renders one job and reports its progress, one JSON object per line. It may crash without
// harm.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>

#include "renderer/assets/file_assets.h"
#include "renderer/compare/compare.h"
#include "renderer/core/clock.h"
#include "renderer/core/files.h"
#include "renderer/params/json_text.h"
#include "renderer/passes/pass.h"
#include "renderer/pictures/blob_sink.h"
#include "renderer/pictures/early_pictures.h"
#include "renderer/report/qualification.h"
#include "renderer/report/report.h"
#include "server/cli/rendering/commands.h"
#include "server/cli/rendering/failure.h"
#include "server/cli/rendering/rendering.h"
#include "server/cli/rendering/sandbox_option.h"
#include "server/cli/rendering/shader_folder.h"
#include "server/http/paths.h"

namespace sheer::cli {

namespace {

using nlohmann::json;

struct RenderArguments {
    std::string spec, out, data;
    bool probe = false;
    gl::ContextRequest context;
    SandboxOption sandbox;
    ShaderFolder shaders;
};

void say(const json& line) {
    fmt::print("{}\n", json_line(line));
    std::fflush(stdout);
}

/// Clears one pixel and reads it back.
int probe(gl::Context& context) {
    ImageSpec image;
    image.width_px = image.height_px = 1;
    const Target target(context.gl(), image, PixelFormat::rgba8);
    Pass(context.gl(), target).clear_color({0, 1, 0, 1});
    const Image read = target.read();
    context.check("the probe");
    if (quantize(read).rgb != std::vector<std::uint8_t>{0, 255, 0}) throw RenderError("the probe's pixel is not green");
    say({{"renderer", describe_device(context).info.renderer}});
    return exit_ok;
}

/// Opens the device between the two parts of the sandbox: a driver takes calls to start that it does not need later.
std::unique_ptr<gl::Context> open_confined(const RenderArguments& options) {
    OpenFiles files = stored_files(options.data);
    if (!options.spec.empty()) files.read.emplace_back(options.spec);
    if (const auto qualifications = qualifications_file(); !qualifications.empty())
        files.read.push_back(qualifications);
    if (!options.out.empty()) {
        std::filesystem::create_directories(options.out);
        files.write.emplace_back(options.out);
    }
    options.shaders.open(files);
    options.sandbox.confine_files(std::move(files));
    auto context = gl::open_device(options.context);
    options.sandbox.confine_calls();
    return context;
}

int run_render(const RenderArguments& options) {
    try {
        const std::string created_at = utc_now();
        const auto context = open_confined(options);
        if (options.probe) return probe(*context);
        const Spec spec = parse_spec_text(read_file(options.spec));
        FileAssets assets(uploads_of(options.data));
        ContentSink sink(options.out, http::blobs_path);
        ReportMaker maker(spec, describe_device(*context), &sink, created_at);
        compare(
            spec, *context, assets,
            [](double fraction, const std::string& stage) {
                say({{"progress", fraction}, {"stage", stage}});
            },
            [&](const Run& run) { maker.add(run); }, maker.undecided(),
            [&](const Run& run) { write_early_pictures(run, sink, options.out); });
        const report::Report report = maker.finish();
        write_file(std::filesystem::path(options.out) / "report.json", json_line(to_document(report)));
        return report.verdict == report::ReportVerdict::failed ? exit_check_failed : exit_ok;
    } catch (const std::exception& error) {
        const Failure failure = describe_failure(error);
        if (!failure.is_for_caller) spdlog::error("the renderer failed: {}", error.what());
        say(failure.message);
        return failure.exit_code;
    }
}

}  // namespace

void add_render(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("render", "Render one job for a worker")->group("");
    auto options = std::make_shared<RenderArguments>();
    command->add_option("spec", options->spec, "The spec, a JSON file");
    command->add_option("--out", options->out, "Folder for report.json and the pictures, named by content");
    command->add_option("--data", options->data, "The service's folder with the uploaded files");
    command->add_flag("--probe", options->probe, "Render one pixel and nothing else");
    add_context_options(*command, options->context);
    options->sandbox.add_to(*command);
    options->shaders.add_to(*command);
    command->callback([options, &exit_code] { exit_code = run_render(*options); });
}

}  // namespace sheer::cli
