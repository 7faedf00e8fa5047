// The worker's child: renders one job and says how far it is, a JSON object a line. It may die without harm.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>

#include "renderer/assets/file_assets.h"
#include "renderer/compare.h"
#include "renderer/files/blob_sink.h"
#include "renderer/frame/target.h"
#include "renderer/report/report.h"
#include "server/cli/commands.h"
#include "server/cli/failure.h"
#include "server/cli/rendering.h"

namespace sheer::cli {

namespace {

using nlohmann::json;

struct RenderArguments {
    std::string spec, out, assets;
    bool probe = false;
    gl::ContextRequest context;
};

void say(const json& line) {
    fmt::print("{}\n", line.dump(-1, ' ', false, json::error_handler_t::replace));
    std::fflush(stdout);
}

/// Clears one pixel and reads it back.
int probe(gl::Context& context) {
    ImageSpec image;
    image.width_px = image.height_px = 1;
    const Target target(context.gl(), image, PixelFormat::rgba8);
    begin_pass(context.gl(), target.framebuffer(), 1, 1);
    const float green[] = {0, 1, 0, 1};
    context.gl().ClearBufferfv(GL_COLOR, 0, green);
    const Image read = target.read();
    context.check("the probe");
    if (quantize(read).rgb != std::vector<std::uint8_t>{0, 255, 0}) throw RenderError("the probe's pixel is not green");
    return exit_ok;
}

int run_render(const RenderArguments& options) {
    try {
        if (options.probe) return probe(*gl::open_device(options.context));
        const std::string created_at = utc_now();
        const Spec spec = parse_spec_text(read_text(options.spec));
        const auto context = gl::open_device(options.context);
        FileAssets assets(uploads_in(options.assets));
        ContentSink sink(options.out);
        ReportMaker maker(spec, describe_device(*context), &sink, created_at);
        compare(
            spec, *context, assets,
            [](double fraction, const std::string& stage) {
                say({{"progress", fraction}, {"stage", stage}});
            },
            [&](const Run& run) { maker.add(run); });
        const json report = maker.finish();
        write_text(std::filesystem::path(options.out) / "report.json",
                   report.dump(-1, ' ', false, json::error_handler_t::replace));
        return report["verdict"] == "failed" ? exit_check_failed : exit_ok;
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
    command->add_option("--assets", options->assets, "Folder of the uploaded files, named by content");
    command->add_flag("--probe", options->probe, "Render one pixel and nothing else");
    add_context_options(*command, options->context);
    command->callback([options, &exit_code] { exit_code = run_render(*options); });
}

}  // namespace sheer::cli
