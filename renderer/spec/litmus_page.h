#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace sheer {

/// The litmus scenes as a page: a table of methods and scenes, then the reason for each cell. `litmus` is
/// tests/render/litmus.json, by which tests/render/litmus_test.cpp tests. GitHub's Markdown.
/// Throws nlohmann::json::exception if it is not made like that file.
std::string litmus_page(const nlohmann::json& litmus);

}  // namespace sheer
