#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace sheer::cli {

/// Adds a command that prints what `describe` returns, a JSON array, or those entries whose ids are given: each as
/// `line` makes it, or all with --json. `example` is what the help's example has after the command.
void add_list(CLI::App& app, int& exit_code, const std::string& name, const std::string& summary,
              const std::string& example, std::function<nlohmann::json()> describe,
              std::function<std::string(const nlohmann::json&)> line);

}  // namespace sheer::cli
