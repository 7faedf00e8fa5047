#include "server/cli/list_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "renderer/command/command.h"
#include "renderer/core/names.h"
#include "renderer/core/similar_name.h"

namespace sheer::cli {

using nlohmann::json;

namespace {

/// Those with these ids, or all. Throws UsageError for an id that there is not.
json chosen(const json& all, const std::vector<std::string>& ids, const std::string& what) {
    if (ids.empty()) return all;
    std::vector<std::string> known;
    const auto id_of = [](const json& one) { return one.contains("id") ? one["id"] : one["name"]; };
    for (const json& one : all) known.push_back(id_of(one));
    json some = json::array();
    for (const std::string& id : ids) {
        const auto found = std::ranges::find(known, lower_case(id), lower_case);
        if (found != known.end()) {
            some.push_back(all[static_cast<std::size_t>(found - known.begin())]);
            continue;
        }
        const std::string meant = similar_name(id, known);
        throw UsageError(fmt::format("there is no \"{}\" among the {}{}", id, what,
                                     meant.empty() ? fmt::format("; there are {}", fmt::join(known, ", "))
                                                   : fmt::format("; did you mean {}?", meant)));
    }
    return some;
}

}  // namespace

void add_list(CLI::App& app, int& exit_code, const std::string& name, const std::string& summary,
              const std::string& example, std::function<json()> describe,
              std::function<std::string(const json&)> line) {
    CLI::App* command = app.add_subcommand(name, summary);
    auto as_json = std::make_shared<bool>(false);
    auto ids = std::make_shared<std::vector<std::string>>();
    command->add_option("id", *ids, "Only those with these ids");
    command->add_flag("--json", *as_json, "As JSON");
    command->footer(fmt::format("Example: sheer {} {}", name, example));
    command->callback([=, &exit_code] {
        exit_code = guarded([&] {
            const json all = chosen(describe(), *ids, name);
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
