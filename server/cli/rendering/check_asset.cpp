// The service's child process that reads one whole upload and describes it as a JSON object. It may crash without harm.
#include "renderer/assets/check_asset.h"

#include <fmt/format.h>

#include <new>

#include "renderer/params/json_text.h"
#include "server/cli/rendering/commands.h"
#include "server/cli/rendering/sandbox_option.h"

namespace sheer::cli {

namespace {

nlohmann::json verdict(const std::string& file, const std::string& media_type) {
    try {
        return {{"facts", check_asset(file, media_type)}};
    } catch (const AssetError& error) {
        return {{"refusal", error.what()}};
    } catch (const std::bad_alloc&) {
        return {{"refusal", "reading it takes too much memory"}};
    }
}

}  // namespace

void add_check_asset(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("check-asset", "Read one upload for the service")->group("");
    auto file = std::make_shared<std::string>(), media_type = std::make_shared<std::string>();
    command->add_option("file", *file, "The upload")->required();
    command->add_option("--type", *media_type, "The declared media type")->required();
    auto sandbox = std::make_shared<SandboxOption>();
    sandbox->add_to(*command);
    command->callback([file, media_type, sandbox, &exit_code] {
        try {
            sandbox->confine_files({});
            sandbox->confine_calls();
            const nlohmann::json line = verdict(*file, *media_type);
            fmt::print("{}\n", json_line(line));
            exit_code = exit_ok;
        } catch (const std::exception& error) {
            fmt::print(stderr, "sheer check-asset: {}\n", error.what());
            exit_code = exit_render_failed;
        }
    });
}

}  // namespace sheer::cli
