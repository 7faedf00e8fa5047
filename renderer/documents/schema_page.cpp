#include "renderer/documents/schema_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>

namespace sheer {

using nlohmann::json;

namespace {

std::string name_in(const std::string& reference) {
    return reference.substr(reference.rfind('/') + 1);
}

void add_names(const Schemas& schemas, const json& schema, std::vector<std::string>& names) {
    if (!schema.is_structured()) return;
    if (schema.is_object() && schema.contains("$ref")) {
        const std::string name = name_in(schema["$ref"]);
        if (std::ranges::find(names, name) != names.end()) return;
        names.push_back(name);
        add_names(schemas, schemas.at(name), names);
        return;
    }
    for (const json& part : schema) add_names(schemas, part, names);
}

std::string link_to(const std::string& name) {
    std::string anchor = name;
    std::ranges::transform(anchor, anchor.begin(), [](unsigned char c) { return std::tolower(c); });
    return fmt::format("[{}](#{})", name, anchor);
}

std::string value_text(const json& value) {
    return value.is_null() ? "null" : fmt::format("`{}`", value.is_string() ? value.get<std::string>() : value.dump());
}

std::string any_of(const std::vector<std::string>& texts) {
    return fmt::format("{}", fmt::join(texts, " or "));
}

std::string value_type(const json& schema);

std::string array_type(const json& schema) {
    const std::string of = schema.contains("items") ? " of " + value_type(schema["items"]) : "";
    if (!schema.contains("minItems") || schema["minItems"] != schema.value("maxItems", json())) return "array" + of;
    return fmt::format("array of {}{}", schema["minItems"].dump(), of);
}

std::string named_type(const json& schema, const std::string& type) {
    if (type == "array") return array_type(schema);
    if (type == "object") {
        const json values = schema.value("additionalProperties", json());
        return values.is_object() ? "object of " + value_type(values) : "object";
    }
    if (type == "integer") return "whole number";
    if (type == "boolean") return "true or false";
    return type == "string" ? "text" : type;
}

/// The type of a schema, short enough for a cell of a table.
std::string value_type(const json& schema) {
    std::vector<std::string> texts;
    if (schema.contains("$ref")) return link_to(name_in(schema["$ref"]));
    if (schema.contains("const")) return value_text(schema["const"]);
    if (schema.contains("enum")) {
        for (const json& value : schema["enum"]) texts.push_back(value_text(value));
        return any_of(texts);
    }
    for (const char* key : {"anyOf", "oneOf"}) {
        for (const json& one : schema.value(key, json::array()))
            if (const std::string text = value_type(one); std::ranges::find(texts, text) == texts.end())
                texts.push_back(text);
        if (!texts.empty()) return any_of(texts);
    }
    if (!schema.contains("type")) return "any";
    const json& types = schema["type"];
    for (const json& type : types.is_array() ? types : json::array({types})) texts.push_back(named_type(schema, type));
    return any_of(texts);
}

std::string field_rows(const json& schema) {
    std::string rows = "\n| field | type | meaning |\n|---|---|---|\n";
    const json required = schema.value("required", json::array());
    for (const auto& [name, property] : schema["properties"].items()) {
        const bool is_required = std::ranges::find(required, json(name)) != required.end();
        rows += fmt::format("| `{}` | {}{} | {} |\n", name, cell(value_type(property)),
                            is_required ? "" : ", or absent", cell(property.value("description", "")));
    }
    return rows;
}

std::string section(const std::string& name, const json& schema) {
    std::string text = schema.value("description", "");
    if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    if (!text.empty()) text += ".\n";
    const bool has_fields = schema.contains("properties") && !schema["properties"].empty();
    if (!has_fields) text += fmt::format("{}It is: {}.\n", text.empty() ? "" : "\n", value_type(schema));
    return fmt::format("\n### {}\n{}{}", name, text, has_fields ? field_rows(schema) : "");
}

}  // namespace

std::string cell(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '|') escaped += '\\';
        escaped += c;
    }
    return escaped;
}

std::vector<std::string> names_from(const Schemas& schemas, const std::string& name) {
    std::vector<std::string> names = {name};
    add_names(schemas, schemas.at(name), names);
    return names;
}

std::string schema_sections(const Schemas& schemas, const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += section(name, schemas.at(name));
    return text;
}

}  // namespace sheer
