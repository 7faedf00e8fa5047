#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/spec/param.h"

namespace sheer {

/// A file of the repository that is made from the descriptions of methods, scenes and fields.
struct Document {
    std::string path;  ///< from the repository's root
    std::string text;
};

/// docs/methods.md, docs/litmus.md, configs/README.md and configs/schema/spec.schema.json. `service_fields` describe
/// the service's configuration; `litmus` is tests/render/litmus.json.
std::vector<Document> make_documents(const std::vector<Param>& service_fields, const nlohmann::json& litmus);

/// A row for each field, fields of fields below theirs: pointer, what it says, type, unit, range, default.
/// `fields` is what to_json() of a description gives; pointers begin with `pointer`.
std::string field_table(const nlohmann::json& fields, const std::string& pointer);

}  // namespace sheer
