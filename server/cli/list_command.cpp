#include "server/cli/list_command.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "renderer/command/command.h"

namespace sheer::cli {

using nlohmann::json;

void add_list(CLI::App& app, int& exit_code, const std::string& name, const std::string& summary,
              std::function<json()> describe, std::function<std::string(const json&)> line) {
    CLI::App* command = app.add_subcommand(name, summary);
    auto as_json = std::make_shared<bool>(false);
    command->add_flag("--json", *as_json, "As JSON");
    command->callback([=, &exit_code] {
        exit_code = guarded([&] {
            const json all = describe();
            if (*as_json) {
                fmt::print("{}\n", all.dump(2));
            } else {
                for (const json& one : all) fmt::print("{}", line(one));
            }
            return exit_ok;
        });
    });
}

}  // namespace sheer::cli
