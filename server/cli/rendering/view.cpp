// A window that shows a spec's scene.
#include <fmt/format.h>

#include "renderer/assets/file_assets.h"
#include "server/cli/rendering/commands.h"
#include "server/cli/rendering/rendering.h"
#include "server/view/viewer.h"

namespace sheer::cli {

namespace {

struct ViewArguments {
    std::string spec, screenshot;
    gl::ContextRequest context;
};

int run_view(const ViewArguments& options) {
    const Spec spec = load_spec(options.spec);
    FileAssets assets = assets_in_folder(std::filesystem::path(options.spec).parent_path());
    gl::require_sound_window();
    view::Viewer viewer(spec, options.context, assets, options.screenshot);
    fmt::print("H or F1 in the window lists the keys.\n");
    std::fflush(stdout);
    viewer.run();
    return exit_ok;
}

}  // namespace

void add_view(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("view", "Look at a spec's scene in a window: orbit, switch methods, split");
    auto options = std::make_shared<ViewArguments>();
    command->add_option("spec", options->spec, "The spec, a JSON file (see configs/specs)")->required();
    command->add_option("--screenshot", options->screenshot,
                        "PNG file for the picture shown when the window closes, and for the key P");
    command->add_option("--without-workaround", options->context.disabled_workarounds,
                        "Name of a driver workaround to switch off");
    command->footer(std::string("Keys:\n") + view::keys_text);
    command->footer("Example: sheer view configs/specs/foliage.json");
    command->callback([options, &exit_code] { exit_code = guarded([&] { return run_view(*options); }); });
}

}  // namespace sheer::cli
