// The accepted reports of a service.
#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "renderer/params/json_text.h"
#include "server/cli/commands.h"
#include "server/cli/http_client.h"
#include "server/cli/server_option.h"
#include "server/http/paths.h"

namespace sheer::cli {

using nlohmann::json;

namespace {

struct BaselineArguments {
    ServerOptions server;
    std::string name, report, by, reason;
    bool as_json = false;
};

/// A refusal of the service is a wrong use of the command; throws Unreachable for its own troubles.
json asked(const BaselineArguments& options, const std::string& method, const std::string& target,
           const std::string& body = "") {
    const HttpClient client = make_client(options.server);
    const HttpAnswer answer = client.request(method, target, body, {{"Content-Type", "application/json"}});
    const json document = answer.body.empty() ? json() : json::parse(answer.body, nullptr, false);
    if (answer.status / 100 == 2) return document;
    std::string text = document.is_object() ? document.value("detail", "") : fmt::format("status {}", answer.status);
    if (document.is_object())
        for (const json& error : document.value("errors", json::array()))
            text += fmt::format("\n{}: {}", error.value("pointer", ""), error.value("detail", ""));
    if (answer.status >= 500) throw Unreachable(fmt::format("{}: {}", client.url(), text));
    throw UsageError(text);
}

std::string path_of(const std::string& name) {
    return fmt::format("{}/{}", http::baselines_path, name);
}

void print_baseline(const json& baseline) {
    fmt::print("{}\n", baseline.at("name").get<std::string>());
    for (const json& one : baseline.at("reports")) {
        const auto text = [&](const char* member) { return one.at(member).get<std::string>(); };
        fmt::print("  {}  accepted {}{}{}  \"{}\" on {}\n", text("report"), text("accepted_at"),
                   text("by").empty() ? "" : " by " + text("by"), text("reason").empty() ? "" : ": " + text("reason"),
                   text("title"), text("device"));
    }
}

void list_baselines(const BaselineArguments& options) {
    const json found = options.name.empty()
                           ? asked(options, "GET", http::baselines_path)
                           : json{{"baselines", json::array({asked(options, "GET", path_of(options.name))})}};
    if (options.as_json) {
        fmt::print("{}", json_page(found));
        return;
    }
    for (const json& baseline : found.at("baselines")) print_baseline(baseline);
}

void accept_report(const BaselineArguments& options) {
    print_baseline(asked(options, "PUT", path_of(options.name),
                         json{{"report", options.report}, {"by", options.by}, {"reason", options.reason}}.dump()));
}

void forget_baseline(const BaselineArguments& options) {
    const std::string query = options.report.empty() ? "" : "?report=" + options.report;
    asked(options, "DELETE", path_of(options.name) + query);
    fmt::print("forgotten; the reports themselves stay\n");
}

}  // namespace

void add_baseline(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("baseline", "The reports that others are compared with");
    command->require_subcommand(1);
    command->footer("Example: sheer baseline list");
    // Each has arguments of its own, as the environment is read for all of them, chosen or not.
    const auto add = [&](const std::string& name, const std::string& what, void (*run)(const BaselineArguments&)) {
        CLI::App* one = command->add_subcommand(name, what);
        auto options = std::make_shared<BaselineArguments>();
        add_server_options(*one, options->server);
        one->callback([options, run, &exit_code] {
            exit_code = guarded([&] {
                try {
                    run(*options);
                    return exit_ok;
                } catch (const Unreachable& error) {
                    fmt::print(stderr, "sheer: {}\n", error.what());
                    return exit_unreachable;
                }
            });
        });
        return std::pair(one, options.get());
    };
    const auto [listing, listed] = add("list", "List the accepted reports", list_baselines);
    listing->add_option("name", listed->name, "Only this baseline");
    listing->footer("Example: sheer baseline list main --server http://renderer:8080");
    listing->add_flag("--json", listed->as_json, "Print JSON");
    const auto [accepting, accepted] = add("accept", "Accept a done report", accept_report);
    accepting->add_option("name", accepted->name, "Name of the baseline, such as main")->required();
    accepting->add_option("report", accepted->report, "Id of the report")->required();
    accepting->add_option("--by", accepted->by, "Who accepts it; by default $USER")->envname("USER");
    accepting->footer("Example: sheer baseline accept main 01a2b3c4-0000-7000-8000-000000000001 --reason merged");
    accepting->add_option("--reason", accepted->reason, "Why");
    const auto [forgetting, forgotten] = add("forget", "Forget a baseline, or one report of it", forget_baseline);
    forgetting->add_option("name", forgotten->name, "Name of the baseline")->required();
    forgetting->footer("Example: sheer baseline forget main");
    forgetting->add_option("report", forgotten->report, "Only this report");
}

}  // namespace sheer::cli
