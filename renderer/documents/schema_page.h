#pragma once
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace sheer {

/// JSON schemas by name; they refer to each other by references that end in a slash and a name.
using Schemas = std::map<std::string, nlohmann::json>;

/// `text` without characters that would end a cell of a table.
std::string cell(const std::string& text);

/// `name` and the names of all schemas to which it refers, in reading order.
std::vector<std::string> names_from(const Schemas& schemas, const std::string& name);

/// For each name a heading, a description and a table of its fields.
std::string schema_sections(const Schemas& schemas, const std::vector<std::string>& names);

}  // namespace sheer
