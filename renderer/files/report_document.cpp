#include "renderer/files/report_document.h"

#include <fmt/format.h>

#include <initializer_list>

#include "renderer/spec/sweep.h"

namespace sheer {

using nlohmann::json;

namespace {

/// `pointer` is the object's. from_document() has checked the types of all members except those of the spec.
void check_members(const json& object, const std::string& pointer, std::initializer_list<const char*> names) {
    if (!object.is_object()) throw DocumentError(pointer + " must be an object");
    for (const char* name : names)
        if (!object.contains(name)) throw DocumentError(fmt::format("{}/{} is missing", pointer, name));
}

void check_run(const json& run, const std::string& pointer) {
    check_members(run, pointer, {"point", "reference", "results"});
    check_members(run["reference"], pointer + "/reference", {"method", "images"});
    for (std::size_t i = 0; i < run["results"].size(); ++i)
        check_members(run["results"][i], fmt::format("{}/results/{}", pointer, i),
                      {"method", "label", "status", "images"});
}

}  // namespace

report::Report read_report(const json& document) {
    auto report = from_document<report::Report>(document);
    check_members(document, "", {"status", "spec", "runs"});
    for (std::size_t i = 0; i < report.runs.size(); ++i) check_run(document["runs"][i], fmt::format("/runs/{}", i));
    check_comparable(report);
    return report;
}

void check_comparable(const report::Report& report) {
    const json& spec = report.spec;
    check_members(spec, "/spec", {"methods", "image"});
    const json& methods = spec["methods"];
    if (!methods.is_array()) throw DocumentError("/spec/methods must be an array");
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const std::string pointer = fmt::format("/spec/methods/{}", i);
        check_members(methods[i], pointer, {"label"});
        if (!methods[i]["label"].is_string()) throw DocumentError(pointer + "/label must be a string");
    }
    for (const char* name : {"title", "baseline"})
        if (spec.contains(name) && !spec[name].is_string())
            throw DocumentError(fmt::format("/spec/{} must be a string", name));
    for (std::size_t i = 0; i < report.runs.size(); ++i) {
        if (!report.runs[i].point.is_object()) throw DocumentError(fmt::format("/runs/{}/point must be an object", i));
        picture_size_px(report, report.runs[i].point);
    }
}

std::array<int, 2> picture_size_px(const report::Report& report, const report::Point& point) {
    json spec;
    try {
        spec = at_point(report.spec, point);
    } catch (const json::exception&) {
        throw DocumentError("/spec does not have the fields that the sweep sets");
    }
    std::array<int, 2> size_px{};
    for (const std::size_t i : {0, 1}) {
        const json::json_pointer place(i == 0 ? "/image/width" : "/image/height");
        if (!spec.contains(place) || !spec[place].is_number_integer())
            throw DocumentError("/spec" + place.to_string() + " must be a whole number");
        size_px[i] = spec[place].get<int>();
    }
    return size_px;
}

const report::Picture* find_picture(const report::Pictures& pictures, const std::string& name) {
    const auto found = pictures.find(name);
    return found == pictures.end() ? nullptr : &found->second;
}

}  // namespace sheer
