#include "server/cli/commands.h"

namespace sheer::cli {

void add_service_commands(CLI::App& app, int& exit_code) {
    for (const auto add : {add_submit, add_baseline, add_archive, add_serve, add_token, add_catalog, add_worker})
        add(app, exit_code);
}

}  // namespace sheer::cli
