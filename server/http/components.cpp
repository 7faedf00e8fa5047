#include "server/http/components.h"

#include "renderer/results/diff_types.h"
#include "renderer/results/pixel_types.h"
#include "renderer/results/quantity.h"
#include "renderer/results/report.h"
#include "renderer/results/schemas.h"
#include "renderer/spec/catalog.h"
#include "renderer/spec/spec.h"
#include "server/http/answers.h"
#include "server/http/service.h"

namespace sheer::http {

using nlohmann::json;

namespace {

constexpr const char* report_name = "Report";
constexpr const char* unfinished_name = "UnfinishedReport";

template <typename T>
void add_list(SchemaBook& book, const char* name, const char* text) {
    book.reference(name, [text](SchemaBook& to) {
        json list = schema_in<std::vector<T>>(to);
        list["description"] = text;
        return list;
    });
}

void add_catalogue(SchemaBook& book) {
    add_list<catalog::Method>(book, "MethodList", "every method");
    add_list<catalog::Scene>(book, "SceneList", "every type of scene");
    add_list<catalog::Metric>(book, "MetricList", "every metric");
    add_list<Quantity>(book, "ColumnList", "the columns of the tables of times and fragments");
    add_list<std::uint64_t>(book, "RoundsNeeded",
                            "the fewest rounds with which every speedup has an interval, for 1, 2, 3 and more methods");
    add_list<catalog::Suite>(book, "SuiteList", "every published measurement that can be repeated");
    add_list<Field>(book, "FieldList", "the fields of a spec");
    add_list<catalog::Example>(book, "ExampleList", "ready-made specs");
    add_list<catalog::ListedDevice>(book, "DeviceList", "every device");
}

void add_answers(SchemaBook& book) {
    schema_in<report::Report>(book);
    schema_in<report::UnfinishedReport>(book);
    schema_in<answer::Event>(book);
    schema_in<answer::ReportList>(book);
    schema_in<answer::AssetList>(book);
    schema_in<answer::BaselineList>(book);
    schema_in<answer::Pin>(book);
    schema_in<answer::EarlyPictures>(book);
    schema_in<answer::Trend>(book);
    schema_in<answer::Health>(book);
    schema_in<answer::WorkerList>(book);
    schema_in<answer::Readiness>(book);
    schema_in<answer::Session>(book);
    schema_in<answer::Problem>(book);
    schema_in<pixel::Pixel>(book);
    schema_in<diff::Diff>(book);
}

json any_report(SchemaBook& book) {
    return {{"description", "a report, whatever its status"},
            {"oneOf", {book.reference(report_name), book.reference(unfinished_name)}}};
}

json openapi_schema(SchemaBook&) {
    const json object = {{"type", "object"}}, text = {{"type", "string"}},
               list = {{"type", "array"}, {"items", object}};
    return {{"type", "object"},
            {"description", "a description of the service, OpenAPI 3.1"},
            {"properties",
             {{"openapi", text},
              {"info", object},
              {"servers", list},
              {"security", list},
              {"tags", list},
              {"paths", object},
              {"components", object}}},
            {"required", {"openapi", "info", "servers", "security", "tags", "paths", "components"}},
            {"additionalProperties", false}};
}

/// The status decides the type of a report: the service has complete reports only with this status.
void narrow(json& report, const std::vector<report::Status>& statuses) {
    json words = json::array();
    for (const report::Status status : statuses) words.push_back(word_of(status));
    report["properties"]["status"] = {{"enum", words}};
    report["properties"]["id"].erase("description");
    report["required"].push_back("id");
}

void mark_times(json& schema) {
    for (const char* name :
         {"created_at", "finished_at", "last_rendered_at", "last_seen_at", "accepted_at", "pinned_at"})
        if (schema.contains(json::json_pointer("/properties") / name))
            schema["properties"][name]["format"] = "date-time";
}

}  // namespace

std::map<std::string, json> component_schemas() {
    SchemaBook book(components_prefix);
    add_catalogue(book);
    add_answers(book);
    catalog::posted_spec_reference(book);
    book.reference("NewSession", [](SchemaBook&) { return session_schema(); });
    book.reference("PinRemark", [](SchemaBook&) { return pin_schema(); });
    book.reference("Acceptance", [](SchemaBook&) { return acceptance_schema(); });
    book.reference(normalised_spec_name, [](SchemaBook&) { return normalised_spec_schema(); });
    book.reference("AnyReport", any_report);
    book.reference("OpenapiDocument", openapi_schema);
    std::map<std::string, json> schemas = book.schemas();
    using enum report::Status;
    narrow(schemas.at(report_name), {done});
    narrow(schemas.at(unfinished_name), {queued, running, failed, cancelled});
    for (auto& [name, schema] : schemas) mark_times(schema);
    return schemas;
}

}  // namespace sheer::http
