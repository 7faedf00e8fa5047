#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "renderer/diff/diff_parts.h"

namespace sheer {

using nlohmann::json;

namespace {

const json& member(const json& object, const std::string& name) {
    static const json none;
    const auto found = object.find(name);
    return found == object.end() ? none : *found;
}

/// A color, a size or a load is one value.
bool is_tuple(const json& value) {
    return value.is_array() && std::ranges::all_of(value, [](const json& one) { return one.is_number(); });
}

void compare_values(const std::string& pointer, const json& a, const json& b, std::vector<FieldDifference>& found) {
    if (a == b) return;
    if (a.is_object() && b.is_object()) {
        std::set<std::string> names;
        for (const json* object : {&a, &b})
            for (const auto& [name, value] : object->items()) names.insert(name);
        for (const std::string& name : names) {
            const std::string inner = (json::json_pointer(pointer) / name).to_string();
            if (a.contains(name) && b.contains(name)) {
                compare_values(inner, a[name], b[name], found);
            } else {
                found.push_back({{inner, member(a, name), member(b, name)}, false});
            }
        }
    } else if (a.is_array() && b.is_array() && a.size() == b.size() && !is_tuple(a)) {
        for (std::size_t i = 0; i < a.size(); ++i) compare_values(fmt::format("{}/{}", pointer, i), a[i], b[i], found);
    } else {
        found.push_back({{pointer, a, b}, true});
    }
}

/// A method with its own shading or texture has another picture than one without.
void mark_looks(const std::string& method_pointer, std::vector<FieldDifference>& found) {
    for (FieldDifference& one : found)
        if (one.pointer == method_pointer + "/shading" || one.pointer == method_pointer + "/texture")
            one.is_in_both = true;
}

const json* labelled(const json& methods, const std::string& label) {
    const auto found = std::ranges::find_if(methods, [&](const json& method) { return method["label"] == label; });
    return found == methods.end() ? nullptr : &*found;
}

void compare_methods(const json& a, const json& b, std::vector<FieldDifference>& found) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        const std::string pointer = fmt::format("/spec/methods/{}", i);
        if (const json* other = labelled(b, a[i]["label"])) {
            compare_values(pointer, a[i], *other, found);
            mark_looks(pointer, found);
        } else {
            found.push_back({{pointer, a[i], nullptr}, false});
        }
    }
    for (std::size_t i = 0; i < b.size(); ++i)
        if (!labelled(a, b[i]["label"])) found.push_back({{fmt::format("/spec/methods/{}", i), nullptr, b[i]}, false});
}

/// Files are matched by their names and the fields that refer to them. A report without any was made before reports
/// listed files, or its scene has none.
void compare_files(const std::vector<report::File>& a, const std::vector<report::File>& b,
                   std::vector<FieldDifference>& found) {
    if (a.empty() || b.empty()) return;
    const auto is_in = [](const std::vector<report::File>& files, const report::File& file) {
        return std::ranges::find(files, file) != files.end();
    };
    const auto is_same_place = [](const report::File& one, const report::File& other) {
        return one.pointer == other.pointer && one.name == other.name && one.of == other.of;
    };
    std::vector<report::File> left;
    std::ranges::copy_if(b, std::back_inserter(left), [&](const report::File& file) { return !is_in(a, file); });
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (is_in(b, a[i])) continue;
        const auto now =
            std::ranges::find_if(left, [&](const report::File& file) { return is_same_place(file, a[i]); });
        const bool is_there = now != left.end();
        found.push_back(
            {{fmt::format("/files/{}", i), to_document(a[i]), is_there ? to_document(*now) : json()}, is_there});
        if (is_there) left.erase(now);
    }
    for (const report::File& file : left)
        found.push_back(
            {{fmt::format("/files/{}", std::ranges::find(b, file) - b.begin()), nullptr, to_document(file)}, false});
}

/// The command that repeats a report and the path of its spec do not matter here. An older report may lack newer
/// members.
json provenance_of(const report::Report& report) {
    json provenance = to_document(report.provenance);
    for (const char* key : {"rerun", "spec"}) provenance.erase(key);
    if (report.provenance.cores == 0) provenance.erase("cores");
    for (const char* key : {"version", "commit"})
        if (provenance[key] == "") provenance.erase(key);
    return provenance;
}

json device_of(const report::Report& report) {
    return report.device ? to_document(*report.device) : json();
}

}  // namespace

std::vector<FieldDifference> report_differences(const report::Report& a, const report::Report& b) {
    std::vector<FieldDifference> found;
    json spec_a = a.spec, spec_b = b.spec;
    compare_methods(spec_a.at("methods"), spec_b.at("methods"), found);
    spec_a.erase("methods");
    spec_b.erase("methods");
    compare_values("/spec", spec_a, spec_b, found);
    compare_files(a.files, b.files, found);
    compare_values("/device", device_of(a), device_of(b), found);
    compare_values("/provenance", provenance_of(a), provenance_of(b), found);
    return found;
}

bool is_same_device(const report::Report& a, const report::Report& b) {
    const auto is_same = [](const std::optional<report::Device>& one, const std::optional<report::Device>& other) {
        return one && other && one->renderer == other->renderer && one->cpu == other->cpu;
    };
    return is_same(a.device, b.device) &&
           std::ranges::equal(a.devices, b.devices, [&](const auto& one, const auto& other) {
               return one.label == other.label && is_same(one.device, other.device);
           });
}

}  // namespace sheer
