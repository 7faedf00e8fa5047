#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/spec/catalog.h"
#include "renderer/spec/spec.h"
#include "renderer/spec/suites.h"
#include "server/cli/commands.h"
#include "server/cli/list_command.h"

namespace sheer::cli {

namespace {

using nlohmann::json;

std::string parameter_line(const json& parameter, int indent) {
    std::string range;
    if (parameter.contains("choices")) {
        range = fmt::format(" {}", fmt::join(parameter["choices"].get<std::vector<std::string>>(), "|"));
    } else if (parameter.contains("min") && parameter.contains("max")) {
        range = fmt::format(" {} to {}", parameter["min"].dump(), parameter["max"].dump());
    }
    const auto unit = parameter["unit"].get<std::string>();
    std::string line = fmt::format("{:{}}{} ({}{}{})", "", indent, parameter["name"].get<std::string>(),
                                   parameter["kind"].get<std::string>(), range, unit.empty() ? "" : " " + unit);
    if (!parameter["default"].is_null() && !parameter.contains("fields")) line += " = " + parameter["default"].dump();
    line += "  " + parameter["summary"].get<std::string>() + "\n";
    if (parameter.contains("fields"))
        for (const json& field : parameter["fields"]) line += parameter_line(field, indent + 2);
    return line;
}

std::string entry(const json& info, const std::vector<std::pair<std::string, std::string>>& captions) {
    std::string text = fmt::format("{}  {}\n", info["id"].get<std::string>(), info["summary"].get<std::string>());
    for (const auto& [caption, key] : captions)
        if (const auto value = info[key].get<std::string>(); !value.empty())
            text += fmt::format("    {:<9}{}\n", caption, value);
    for (const json& parameter : info.value("parameters", json::array())) text += parameter_line(parameter, 4);
    return text;
}

/// A value of a metric, with its name in checks.
std::string metric_field_line(const json& field) {
    const auto unit = field["unit"].get<std::string>();
    return fmt::format("    {} ({}{}{})  {}\n", field["full_name"].get<std::string>(),
                       field["range"].get<std::string>(), unit.empty() ? "" : " ", unit,
                       field["summary"].get<std::string>());
}

std::string metric_entry(const json& metric) {
    std::string text = entry(metric, {{"source", "source"}, {"good for", "good_for"}});
    for (const json& field : metric["fields"]) text += metric_field_line(field);
    return text + "\n";
}

}  // namespace

void add_catalog(CLI::App& app, int& exit_code) {
    add_list(app, exit_code, "methods", "The methods and their parameters", "f2bd", describe_methods,
             [](const json& info) {
                 return entry(info, {{"paper", "paper"},
                                     {"good at", "good_at"},
                                     {"bad at", "bad_at"},
                                     {"passes", "passes"},
                                     {"memory", "memory"},
                                     {"needs", "needs"}}) +
                        "\n";
             });
    add_list(app, exit_code, "scenes", "The scenes and their parameters", "quads", describe_scenes,
             [](const json& info) {
                 return entry(info, {{"source", "source"}}) + "\n";
             });
    add_list(app, exit_code, "metrics", "The metrics and their values", "flip", describe_metrics, metric_entry);
    add_list(app, exit_code, "suites", "Published measurements that can be repeated", "--json", describe_suites,
             [](const json& suite) {
                 return fmt::format("{:<15} {} ({})\n", suite["id"].get<std::string>(),
                                    suite["title"].get<std::string>(), suite["source"].get<std::string>());
             });
}

}  // namespace sheer::cli
