// Who may use a service.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "renderer/core/clock.h"
#include "renderer/params/json_text.h"
#include "server/access/token_file.h"
#include "server/cli/commands.h"
#include "server/cli/service_config.h"

namespace sheer::cli {

using nlohmann::json;

namespace {

struct TokenArguments {
    std::string name, scope = "submit", data, config;
    Quota quota;
    bool as_json = false;
};

TokenFile file_of(const TokenArguments& options) {
    json overrides = json::object();
    if (!options.data.empty()) overrides["data"] = options.data;
    const ServiceConfig config = load_service_config(options.config, overrides);
    std::filesystem::create_directories(config.token_file().parent_path());
    return TokenFile(config.token_file());
}

/// The secret alone goes to standard output, so that it can be kept in a file.
void create_token(const TokenArguments& options) {
    TokenFile file = file_of(options);
    const std::string secret = file.create(options.name, *scope_from(options.scope), options.quota, system_now_ms());
    fmt::print("{}\n", secret);
    fmt::print(stderr, "\"{}\" may {}. This is the only time that its token is shown; {} has its hash.\n", options.name,
               options.scope, file.path().string());
}

void list_tokens(const TokenArguments& options) {
    json all = json::array();
    for (const Token& token : file_of(options).read()) {
        std::string line =
            fmt::format("{:<24} {:<8} {}", token.name, scope_text(token.scope), utc_text(token.created_ms));
        json quota = json::object();
        for (const auto& [name, what, limit] : quota_limits)
            if (token.quota.*limit) {
                quota[name] = *(token.quota.*limit);
                line += fmt::format("  at most {} {}", *(token.quota.*limit), what);
            }
        all.push_back({{"name", token.name},
                       {"scope", scope_text(token.scope)},
                       {"created_at", utc_text(token.created_ms)},
                       {"quota", quota}});
        if (!options.as_json) fmt::print("{}\n", line);
    }
    if (options.as_json) fmt::print("{}", json_page({{"tokens", all}}));
}

void revoke_token(const TokenArguments& options) {
    file_of(options).revoke(options.name);
    fmt::print("\"{}\" is revoked\n", options.name);
}

}  // namespace

void add_token(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("token", "Who may use a service");
    command->require_subcommand(1);
    command->footer("Example: sheer token list");
    const auto add = [&](const char* name, const char* summary, void (*action)(const TokenArguments&)) {
        CLI::App* one = command->add_subcommand(name, summary);
        auto options = std::make_shared<TokenArguments>();
        one->add_option("--data", options->data, "The service's folder, sheer-data if not given");
        one->add_option("--config", options->config, "The service's configuration");
        one->callback([options, action, &exit_code] {
            exit_code = guarded([&] {
                try {
                    action(*options);
                    return exit_ok;
                } catch (const TokenError& error) {
                    throw UsageError(error.what());
                }
            });
        });
        return std::pair(one, options.get());
    };
    const auto [create, created] = add("create", "Print a new token", create_token);
    create->add_option("name", created->name, "Whose it is, for the log")->required();
    create
        ->add_option("--scope", created->scope,
                     "read: look at everything; submit: also post and delete reports and files; admin: also "
                     "baselines and pins; submit if not given")
        ->check(CLI::IsMember({"read", "submit", "admin"}));
    for (const auto& [name, what, limit] : quota_limits) {
        std::string option = fmt::format("--max-{}", name);
        std::ranges::replace(option, '_', '-');
        create->add_option(option, created->quota.*limit, fmt::format("Greatest number of {}", what))
            ->check(CLI::NonNegativeNumber);
    }
    create->footer("Example: sheer token create ci --scope submit --max-jobs 20 > ci.token");
    const auto [listing, listed] = add("list", "Names and scopes", list_tokens);
    listing->add_flag("--json", listed->as_json, "Print JSON");
    listing->footer("Example: sheer token list --data sheer-data");
    const auto [revoking, revoked] = add("revoke", "Make a token worthless", revoke_token);
    revoking->add_option("name", revoked->name, "Its name")->required();
    revoking->footer("Example: sheer token revoke ci");
}

}  // namespace sheer::cli
