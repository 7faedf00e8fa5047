#include "renderer/spec/documents.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "renderer/spec/litmus_page.h"
#include "renderer/spec/spec.h"

namespace sheer {

using nlohmann::json;

namespace {

std::string text_of(const json& object, const char* key) {
    return object.at(key).get<std::string>();
}

/// Without an exponent, and without the ".0" of whole numbers.
std::string plain(const json& number) {
    return number.is_number_integer() ? number.dump() : fmt::format("{}", number.get<double>());
}

/// A default as it stands in a spec.
std::string literal(const json& value) {
    if (value.is_number()) return plain(value);
    if (!value.is_array()) return value.dump();
    std::vector<std::string> entries;
    for (const json& entry : value) entries.push_back(literal(entry));
    return fmt::format("[{}]", fmt::join(entries, ", "));
}

/// What would end a cell of a table.
std::string cell(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '|') escaped += '\\';
        escaped += c;
    }
    return escaped;
}

std::string code(const std::string& text) {
    return fmt::format("`{}`", text);
}

std::string type_text(const json& field) {
    const std::string kind = text_of(field, "kind");
    if (kind == "boolean") return "true or false";
    if (kind == "choice") {
        std::vector<std::string> choices;
        for (const json& choice : field.at("choices")) choices.push_back(code(choice));
        const bool may_be_object = field.contains("fields");
        return fmt::format("one of {}{}", fmt::join(choices, ", "), may_be_object ? ", or an object" : "");
    }
    if (kind == "text")
        return fmt::format("text of {} to {} bytes", field.value("min_length", 0), plain(field.at("max_length")));
    if (kind == "numbers") return fmt::format("array of {} numbers", plain(field.at("max_length")));
    if (kind == "list")
        return fmt::format("array of {} to {} objects", field.value("min_length", 0), plain(field.at("max_length")));
    if (kind == "asset") {
        std::vector<std::string> names;
        for (const json& choice : field.value("choices", json::array())) names.push_back(code(choice));
        names.push_back(fmt::format("the SHA-256 of an uploaded {}", field.value("asset_type", "file")));
        const std::string each =
            field.contains("max_length") ? fmt::format(", or an array of {}", plain(field["max_length"])) : "";
        return fmt::format("{}{}", fmt::join(names, ", "), each);
    }
    return kind == "any" ? std::string() : kind;
}

std::string range_text(const json& field) {
    const bool low = field.contains("min"), high = field.contains("max");
    const bool exclusive = field.value("exclusive", false);
    if (low && high)
        return fmt::format("{} to {}{}", plain(field["min"]), plain(field["max"]), exclusive ? ", both excluded" : "");
    if (low) return fmt::format("{} {}", exclusive ? "over" : "at least", plain(field["min"]));
    if (high) return fmt::format("{} {}", exclusive ? "under" : "at most", plain(field["max"]));
    return "";
}

std::string default_text(const json& field) {
    if (field.at("required").get<bool>()) return "required";
    if (field.value("optional", false) && field.at("default").is_null()) return "none";
    return text_of(field, "kind") == "object" ? std::string() : code(literal(field.at("default")));
}

void add_rows(std::string& rows, const json& fields, const std::string& pointer) {
    for (const json& field : fields) {
        const std::string own_pointer = fmt::format("{}/{}", pointer, pointer_token(text_of(field, "name")));
        rows += fmt::format("| {} | {} | {} | {} | {} | {} |\n", code(own_pointer), cell(text_of(field, "summary")),
                            type_text(field), text_of(field, "unit"), range_text(field), cell(default_text(field)));
        if (!field.contains("fields")) continue;
        const bool is_list = text_of(field, "kind") == "list";
        add_rows(rows, field["fields"], is_list ? fmt::format("{}/*", own_pointer) : own_pointer);
    }
}

std::string method_section(const json& method) {
    std::string text = fmt::format("\n## {}\n`{}`: {}. {}\n\n| | |\n|---|---|\n", text_of(method, "name"),
                                   text_of(method, "id"), text_of(method, "kind"), text_of(method, "summary"));
    const std::pair<const char*, const char*> rows[] = {
        {"From", "paper"}, {"Good at", "good_at"}, {"Bad at", "bad_at"}, {"Memory", "memory"}};
    for (const auto& [caption, key] : rows) text += fmt::format("| {} | {} |\n", caption, cell(text_of(method, key)));
    text += fmt::format("| Sorts | {} |\n", method.at("needs_sorting").get<bool>() ? "yes" : "no");
    if (!method.at("no_metrics_reason").is_null())
        text +=
            fmt::format("| Not measured against the reference | {} |\n", cell(text_of(method, "no_metrics_reason")));
    text += method.at("parameters").empty() ? std::string("\nIt has no parameters.\n")
                                            : fmt::format("\n{}", field_table(method["parameters"], ""));
    return text;
}

/// The fields of a spec; two have no default although the description of their contents is elsewhere.
json spec_fields_json() {
    json fields = describe_spec_fields();
    const auto required = spec_schema().at("required").get<std::vector<std::string>>();
    for (json& field : fields)
        if (std::ranges::find(required, text_of(field, "name")) != required.end()) field["required"] = true;
    return fields;
}

constexpr const char* generated = "<!-- Made by ./dev docs from the descriptions in the source. -->\n";

constexpr const char* methods_head = R"(# Methods

Each is one file, `renderer/methods/<id>.cpp`, which holds its passes and this description of itself. In a spec a method is
its id, or an object with the id and some of its fields: `{"id": "f2bd", "threshold": 0.02}`. Memory is what a method takes
beside the picture that it renders into. Which of them are right where is shown by the [litmus scenes](litmus.md).
)";

constexpr const char* configs_head = R"(# Configuration

| file | holds |
|---|---|
| `server.json` | every setting of the service with its default, for `sheer serve --config` |
| `specs/*.json` | ready comparisons, for `sheer compare` and the page |
| `schema/spec.schema.json` | the JSON schema of a spec, for editors and other programs |

In the tables, a field is named by its JSON pointer; `*` stands for any index. A field that is neither required nor given has
its default. Unknown fields are errors.

## Spec
A method is its id, or an object with `id` and the [parameters of the method](../docs/methods.md). `scene` is an object with
`type`, one of the scenes below, and the fields of that scene.

)";

constexpr const char* service_head = R"(## Service
`sheer serve --config FILE` reads these; options of the command line come before them.

)";

std::string methods_page() {
    std::string page = fmt::format("{}{}", generated, methods_head);
    for (const json& method : describe_methods()) page += method_section(method);
    return page;
}

std::string configs_page(const std::vector<Param>& service_fields) {
    std::string page = fmt::format("{}{}{}", generated, configs_head, field_table(spec_fields_json(), ""));
    for (const json& scene : describe_scenes()) {
        page += fmt::format("\n### Scene `{}`\n{} From: {}.\n\n", text_of(scene, "id"), text_of(scene, "summary"),
                            text_of(scene, "source"));
        page += field_table(scene.at("parameters"), "/scene");
    }
    page += fmt::format("\n{}{}", service_head, field_table(to_json(service_fields), ""));
    return page;
}

}  // namespace

std::string field_table(const json& fields, const std::string& pointer) {
    std::string table = "| field | what | type | unit | range | default |\n|---|---|---|---|---|---|\n";
    add_rows(table, fields, pointer);
    return table;
}

std::vector<Document> make_documents(const std::vector<Param>& service_fields, const json& litmus) {
    json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "A comparison for Sheer"}};
    schema.update(spec_schema());
    return {{"docs/methods.md", methods_page()},
            {"docs/litmus.md", fmt::format("{}{}", generated, litmus_page(litmus))},
            {"configs/README.md", configs_page(service_fields)},
            {"configs/schema/spec.schema.json", schema.dump(2) + "\n"}};
}

}  // namespace sheer
