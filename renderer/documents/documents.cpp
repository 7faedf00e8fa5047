#include "renderer/documents/documents.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/results/report.h"
#include "renderer/results/schemas.h"
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

/// A default as it is written in a spec.
std::string literal(const json& value) {
    if (value.is_number()) return plain(value);
    if (!value.is_array()) return value.dump();
    std::vector<std::string> entries;
    for (const json& entry : value) entries.push_back(literal(entry));
    return fmt::format("[{}]", fmt::join(entries, ", "));
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
    if (kind == "numbers") {
        const auto parts = field.value("parts", std::vector<std::string>());
        return fmt::format("array of {} numbers{}{}", plain(field.at("max_length")), parts.empty() ? "" : ": ",
                           fmt::join(parts, ", "));
    }
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
        const std::string own_pointer = (json::json_pointer(pointer) / text_of(field, "name")).to_string();
        rows += fmt::format("| {} | {} | {} | {} | {} | {} |\n", code(own_pointer), cell(text_of(field, "summary")),
                            type_text(field), text_of(field, "unit"), range_text(field), cell(default_text(field)));
        if (!field.contains("fields")) continue;
        const bool is_list = text_of(field, "kind") == "list";
        add_rows(rows, field["fields"], is_list ? fmt::format("{}/*", own_pointer) : own_pointer);
    }
}

std::string bytes_text(const json& method) {
    const auto bytes = method.find("bytes_per_px");
    if (bytes == method.end()) return "depends on the scene";
    const auto rgba8 = bytes->at("rgba8").get<double>(), rgba16f = bytes->at("rgba16f").get<double>(),
               rgba32f = bytes->at("rgba32f").get<double>();
    if (rgba8 == rgba16f && rgba16f == rgba32f) return fmt::format("{:g} bytes per pixel", rgba8);
    return fmt::format("{:g}, {:g} and {:g} bytes per pixel of rgba8, rgba16f and rgba32f", rgba8, rgba16f, rgba32f);
}

std::string method_section(const json& method) {
    std::string text = fmt::format("\n## {}\n`{}`: {}. {}\n\n| | |\n|---|---|\n", text_of(method, "name"),
                                   text_of(method, "id"), text_of(method, "kind"), text_of(method, "summary"));
    const std::pair<const char*, const char*> rows[] = {
        {"From", "paper"}, {"Good at", "good_at"}, {"Bad at", "bad_at"}, {"Passes", "passes"}, {"Memory", "memory"}};
    for (const auto& [caption, key] : rows) text += fmt::format("| {} | {} |\n", caption, cell(text_of(method, key)));
    text += fmt::format("| By default | {} |\n", bytes_text(method));
    const std::string needs = text_of(method, "needs");
    text +=
        fmt::format("| Needs | {} |\n", needs.empty() ? "nothing more than blending and a depth test" : cell(needs));
    text += fmt::format("| Sorts | {} |\n", method.at("needs_sorting").get<bool>() ? "yes" : "no");
    if (!method.at("no_metrics_reason").is_null())
        text +=
            fmt::format("| Not measured against the reference | {} |\n", cell(text_of(method, "no_metrics_reason")));
    text += method.at("parameters").empty() ? std::string("\nIt has no parameters.\n")
                                            : fmt::format("\n{}", field_table(method["parameters"], ""));
    return text;
}

/// The fields of a spec; two of those whose contents are described elsewhere are required.
json spec_fields_json() {
    json fields = describe_spec_fields();
    const auto required = spec_schema().at("required").get<std::vector<std::string>>();
    for (json& field : fields)
        if (std::ranges::find(required, text_of(field, "name")) != required.end()) field["required"] = true;
    return fields;
}

constexpr const char* generated = "<!-- Made by ./dev docs from the descriptions in the source. -->\n";

constexpr const char* methods_head = R"(# Methods

Each is one file, `renderer/methods/<id>.cpp`, with its passes and the description below. In a spec a method is its id, or an
object with the id and some of its fields: `{"id": "f2bd", "threshold": 0.02}`. Memory does not include the picture into which a
method renders. The [litmus scenes](litmus.md) show on which scenes each method is correct.
)";

constexpr const char* configs_head = R"(# Configuration

| file | contents |
|---|---|
| `server.json` | every setting of the service with its default, for `sheer serve --config` |
| `specs/*.json` | ready-made comparisons, for `sheer compare` and the page |
| `schema/spec.schema.json` | the JSON schema of a spec, for editors and other programs |
| `schema/report.schema.json` | the JSON schema of a report: [every field](../docs/report.md) |

The tables name each field by its JSON pointer; `*` stands for any index. A field that is not required and not given has its
default. Unknown fields are errors.

## Spec
A method is its id, or an object with `id` and the [parameters of the method](../docs/methods.md). `scene` is an object with
`type`, one of the scenes below, and the fields of that scene.

)";

constexpr const char* report_head = R"(# Every field

The fields of reports and of the service's other answers. All of them are JSON, and no object has a field that is not listed
here. If a field is absent or null, a field of the same name with `_reason` often says why. The same as JSON schemas:
`configs/schema/report.schema.json`, and `/api/v1/openapi.json` of the service.

## The report
`report.json` of `sheer compare`, and `GET /api/v1/reports/{id}` of a report that is done.
)";

constexpr const char* answers_head = R"(
## Other answers
From the service ([the calls](service.md)) and from commands with `--json`.
)";

constexpr const char* service_head = R"(## Service
`sheer serve --config FILE` reads these; options on the command line override them.

)";

std::string methods_page() {
    std::string page = fmt::format("{}{}", generated, methods_head);
    for (const json& method : describe_methods()) page += method_section(method);
    return page;
}

/// The metrics, then every value of them.
std::string metric_tables() {
    std::string metrics = "| metric | formula | good for |\n|---|---|---|\n";
    std::string values = "| value | meaning | unit | range |\n|---|---|---|---|\n";
    for (const json& metric : describe_metrics()) {
        metrics += fmt::format("| {} | {} | {} |\n", code(text_of(metric, "id")), cell(text_of(metric, "formula")),
                               cell(text_of(metric, "good_for")));
        for (const json& field : metric.at("fields"))
            values +=
                fmt::format("| {} | {} | {} | {} |\n", code(text_of(field, "full_name")),
                            cell(text_of(field, "summary")), text_of(field, "unit"), cell(text_of(field, "range")));
    }
    return fmt::format("{}\n## Every value\nThe names are those in checks and reports.\n\n{}", metrics, values);
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

Schemas report_schemas() {
    SchemaBook book("#/$defs/");
    schema_in<report::Report>(book);
    book.reference(normalised_spec_name, [](SchemaBook&) { return normalised_spec_schema(); });
    return book.schemas();
}

json report_schema() {
    return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
            {"title", "A report of Sheer"},
            {"$ref", "#/$defs/Report"},
            {"$defs", report_schemas()}};
}

/// The report's types, then what else the service answers.
std::string report_page(Schemas schemas) {
    // In a report file the status may be other than done, unlike in the service's answers.
    for (const auto& [name, schema] : report_schemas()) schemas[name] = schema;
    const std::vector<std::string> of_report = names_from(schemas, "Report");
    std::vector<std::string> others;
    for (const auto& [name, schema] : schemas)
        for (const std::string& each : names_from(schemas, name))
            if (std::ranges::count(of_report, each) + std::ranges::count(others, each) == 0) others.push_back(each);
    return fmt::format("{}{}{}{}{}", generated, report_head, schema_sections(schemas, of_report), answers_head,
                       schema_sections(schemas, others));
}

/// Every field with its default, in the order of the descriptions.
nlohmann::ordered_json defaults_of(const std::vector<Param>& fields) {
    nlohmann::ordered_json defaults = nlohmann::ordered_json::object();
    for (const Param& field : fields) {
        const json& value = field.default_value;
        const bool is_whole = value.is_number_float() && std::trunc(value.get<double>()) == value.get<double>();
        if (field.kind == Param::Kind::object) {
            defaults[field.name] = defaults_of(field.fields);
        } else if (is_whole) {
            defaults[field.name] = static_cast<std::int64_t>(value.get<double>());
        } else {
            defaults[field.name] = value;
        }
    }
    return defaults;
}

}  // namespace

std::string field_table(const json& fields, const std::string& pointer) {
    std::string table = "| field | what | type | unit | range | default |\n|---|---|---|---|---|---|\n";
    add_rows(table, fields, pointer);
    return table;
}

std::string with_part(const std::string& page, const std::string& name, const std::string& part) {
    const std::size_t begin = page.find(fmt::format("<!-- begin {} ", name));
    const std::size_t end = page.find(fmt::format("<!-- end {} ", name));
    if (begin == std::string::npos || end == std::string::npos || end < begin)
        throw std::runtime_error(fmt::format("a page has no part {} to write", name));
    return fmt::format("{}\n{}{}", page.substr(0, page.find('\n', begin)), part, page.substr(end));
}

std::vector<Document> make_documents(const ServiceDescription& service, const ReadText& read) {
    json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "A comparison for Sheer"}};
    schema.update(spec_schema());
    return {{"docs/methods.md", methods_page()},
            {"docs/report.md", report_page(service.schemas)},
            {"docs/metrics.md", with_part(read("docs/metrics.md"), "metrics", metric_tables())},
            {"configs/README.md", configs_page(service.fields)},
            {"configs/server.json", defaults_of(service.fields).dump(4) + "\n"},
            {"configs/schema/report.schema.json", report_schema().dump(2) + "\n"},
            {"configs/schema/spec.schema.json", schema.dump(2) + "\n"}};
}

}  // namespace sheer
