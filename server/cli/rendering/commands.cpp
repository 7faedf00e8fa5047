#include "server/cli/rendering/commands.h"

namespace sheer::cli {

void add_rendering_commands(CLI::App& app, int& exit_code) {
    for (const auto add : {add_compare, add_diff, add_pixel, add_qualify, add_litmus, add_view, add_devices,
                           add_completion, add_manual, add_docs, add_gallery, add_render, add_check_asset,
                           add_check_shading, add_diff_stored, add_against_stored, add_join_stored})
        add(app, exit_code);
}

}  // namespace sheer::cli
