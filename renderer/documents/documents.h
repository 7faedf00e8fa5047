#pragma once
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "renderer/documents/schema_page.h"
#include "renderer/params/param.h"

namespace sheer {

/// A file of the repository that is generated from the descriptions of methods, scenes and fields.
struct Document {
    std::string path;  ///< relative to the repository's root
    std::string text;
};

/// Returns the text of a file by its path relative to the repository's root.
using ReadText = std::function<std::string(const std::string& path)>;

/// The described parts of the service.
struct ServiceDescription {
    std::vector<Param> fields;  ///< of its configuration
    Schemas schemas;            ///< of its answers, by name
};

/// docs/methods.md, docs/report.md, configs/README.md, configs/server.json and the schemas in configs/schema, and the
/// tables of docs/metrics.md in the text around them.
std::vector<Document> make_documents(const ServiceDescription& service, const ReadText& read);

/// `page` with `part` between its two marks: the comments `<!-- begin NAME` and `<!-- end NAME`, each with its line.
/// Throws std::runtime_error if it has no such marks.
std::string with_part(const std::string& page, const std::string& name, const std::string& part);

/// A row for each field, with the fields of an object below it: pointer, meaning, type, unit, range, default. `fields`
/// comes from to_json() of a description; pointers begin with `pointer`.
std::string field_table(const nlohmann::json& fields, const std::string& pointer);

}  // namespace sheer
