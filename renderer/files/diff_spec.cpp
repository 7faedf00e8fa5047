#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "renderer/files/diff_parts.h"
#include "renderer/spec/param.h"

namespace sheer {

using nlohmann::json;

namespace {

const json& member(const json& object, const std::string& name) {
    static const json none;
    const auto found = object.find(name);
    return found == object.end() ? none : *found;
}

/// A colour, a size or a load is one value.
bool is_tuple(const json& value) {
    return value.is_array() && std::ranges::all_of(value, [](const json& one) { return one.is_number(); });
}

void compare_values(const std::string& pointer, const json& a, const json& b, std::vector<Difference>& found) {
    if (a == b) return;
    if (a.is_object() && b.is_object()) {
        std::set<std::string> names;
        for (const json* object : {&a, &b})
            for (const auto& [name, value] : object->items()) names.insert(name);
        for (const std::string& name : names) {
            const std::string inner = pointer + "/" + pointer_token(name);
            if (a.contains(name) && b.contains(name)) {
                compare_values(inner, a[name], b[name], found);
            } else {
                found.push_back({inner, member(a, name), member(b, name), false});
            }
        }
    } else if (a.is_array() && b.is_array() && a.size() == b.size() && !is_tuple(a)) {
        for (std::size_t i = 0; i < a.size(); ++i) compare_values(fmt::format("{}/{}", pointer, i), a[i], b[i], found);
    } else {
        found.push_back({pointer, a, b, true});
    }
}

const json* labelled(const json& methods, const std::string& label) {
    const auto found = std::ranges::find_if(methods, [&](const json& method) { return method["label"] == label; });
    return found == methods.end() ? nullptr : &*found;
}

void compare_methods(const json& a, const json& b, std::vector<Difference>& found) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        const std::string pointer = fmt::format("/spec/methods/{}", i);
        if (const json* other = labelled(b, a[i]["label"])) {
            compare_values(pointer, a[i], *other, found);
        } else {
            found.push_back({pointer, a[i], nullptr, false});
        }
    }
    for (std::size_t i = 0; i < b.size(); ++i)
        if (!labelled(a, b[i]["label"])) found.push_back({fmt::format("/spec/methods/{}", i), nullptr, b[i], false});
}

bool is_in(const json& list, const json& value) {
    return std::ranges::find(list, value) != list.end();
}

/// Files are matched by their names and the fields that lead to them. Reports made before they were named have none.
void compare_files(const json& a, const json& b, std::vector<Difference>& found) {
    if (!a.is_array() || !b.is_array()) return;
    const auto is_same_place = [](const json& one, const json& other) {
        return std::ranges::all_of(std::array{"pointer", "name", "of"},
                                   [&](const char* key) { return member(one, key) == member(other, key); });
    };
    json left = json::array();
    for (const json& file : b)
        if (!is_in(a, file)) left.push_back(file);
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (is_in(b, a[i])) continue;
        const auto now = std::ranges::find_if(left, [&](const json& file) { return is_same_place(file, a[i]); });
        found.push_back({fmt::format("/files/{}", i), a[i], now == left.end() ? json() : *now, now != left.end()});
        if (now != left.end()) left.erase(now);
    }
    for (const json& file : left)
        found.push_back({fmt::format("/files/{}", std::ranges::find(b, file) - b.begin()), nullptr, file, false});
}

std::vector<std::string> labels(const json& report) {
    std::vector<std::string> all;
    for (const json& method : report.at("spec").at("methods")) all.push_back(method.at("label"));
    return all;
}

bool sweeps_methods(const json& report) {
    return std::ranges::any_of(report.at("runs"), [](const json& run) {
        return std::ranges::any_of(run.at("point").items(),
                                   [](const auto& value) { return value.key().starts_with("/methods/"); });
    });
}

/// What decides how a picture of a method looks.
bool shapes_pictures(const std::string& pointer) {
    return pointer.starts_with("/spec/image/") || pointer.starts_with("/spec/scene") ||
           pointer.starts_with("/spec/methods/");
}

}  // namespace

std::vector<Difference> report_differences(const json& a, const json& b) {
    std::vector<Difference> found;
    json spec_a = a.at("spec"), spec_b = b.at("spec");
    compare_methods(spec_a.at("methods"), spec_b.at("methods"), found);
    spec_a.erase("methods");
    spec_b.erase("methods");
    compare_values("/spec", spec_a, spec_b, found);
    compare_files(member(a, "files"), member(b, "files"), found);
    compare_values("/device", member(a, "device"), member(b, "device"), found);
    json provenance_a = member(a, "provenance"), provenance_b = member(b, "provenance");
    // How to repeat a report is no part of where it comes from, nor is where its spec lay.
    for (json* provenance : {&provenance_a, &provenance_b})
        for (const char* key : {"rerun", "spec"})
            if (provenance->is_object()) provenance->erase(key);
    compare_values("/provenance", provenance_a, provenance_b, found);
    return found;
}

std::vector<FieldError> spec_conflicts(const json& a, const json& b, const std::vector<Difference>& differences) {
    std::vector<FieldError> errors;
    for (const Difference& one : differences)
        if (one.is_in_both && shapes_pictures(one.pointer))
            errors.push_back({one.pointer, fmt::format("is {} in one report and {} in the other",
                                                       one.a.dump(-1, ' ', false, json::error_handler_t::replace),
                                                       one.b.dump(-1, ' ', false, json::error_handler_t::replace))});
    // A sweep names methods by their place.
    if (labels(a) != labels(b) && (sweeps_methods(a) || sweeps_methods(b)))
        errors.push_back({"/spec/methods", "must be the same in both reports where the sweep sets their parameters"});
    return errors;
}

bool is_same_device(const json& a, const json& b) {
    const json &of_a = member(a, "device"), &of_b = member(b, "device");
    return of_a.is_object() && of_b.is_object() && member(of_a, "renderer") == member(of_b, "renderer") &&
           member(of_a, "cpu") == member(of_b, "cpu");
}

}  // namespace sheer
