// The service's child that reads one upload whole and says what it is, as a JSON object. It may die without harm.
#include "renderer/assets/check_asset.h"

#include <fmt/format.h>

#include <new>

#include "server/cli/commands.h"

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
    command->add_option("--type", *media_type, "The media type that it is said to have")->required();
    command->callback([file, media_type, &exit_code] {
        try {
            const nlohmann::json line = verdict(*file, *media_type);
            fmt::print("{}\n", line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
            exit_code = exit_ok;
        } catch (const std::exception& error) {
            fmt::print(stderr, "sheer check-asset: {}\n", error.what());
            exit_code = exit_render_failed;
        }
    });
}

}  // namespace sheer::cli
