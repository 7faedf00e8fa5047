#include "renderer/assets/gltf_object.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <utility>

#include "renderer/scene/assets.h"

namespace sheer {

using nlohmann::json;

namespace {

/// Up to here every whole number is exact as a double.
constexpr double largest_whole_double = 9007199254740992.0;

std::optional<std::uint64_t> as_whole_number(const json& value) {
    if (value.is_number_unsigned()) return value.get<std::uint64_t>();
    if (!value.is_number_float()) return std::nullopt;
    const auto number = value.get<double>();
    if (!(number >= 0 && number <= largest_whole_double) || std::floor(number) != number) return std::nullopt;
    return static_cast<std::uint64_t>(number);
}

}  // namespace

GltfObject::GltfObject(const json& object, std::string what, std::string where)
    : m_object(&object), m_what(std::move(what)), m_where(std::move(where)) {
    if (!object.is_object()) throw AssetError(m_what + " is not an object");
}

void GltfObject::fail(const std::string& why) const {
    throw AssetError(m_what + ": " + why);
}

const json* GltfObject::find(const char* name) const {
    const auto found = m_object->find(name);
    return found == m_object->end() || found->is_null() ? nullptr : &*found;
}

const json* GltfObject::find_list(const char* name) const {
    const json* found = find(name);
    if (found != nullptr && !found->is_array()) fail(fmt::format("{} is not a list", name));
    return found;
}

std::optional<std::uint64_t> GltfObject::whole_number(const char* name) const {
    const json* found = find(name);
    if (found == nullptr) return std::nullopt;
    const auto number = as_whole_number(*found);
    if (!number) fail(fmt::format("{} must be a whole number of at least 0", name));
    return number;
}

std::uint64_t GltfObject::needed_number(const char* name) const {
    const auto number = whole_number(name);
    if (!number) fail(fmt::format("{} is missing", name));
    return *number;
}

double GltfObject::number(const char* name, double otherwise) const {
    const json* found = find(name);
    if (found == nullptr) return otherwise;
    if (!found->is_number()) fail(fmt::format("{} must be a number", name));
    return found->get<double>();
}

bool GltfObject::flag(const char* name) const {
    const json* found = find(name);
    if (found == nullptr) return false;
    if (!found->is_boolean()) fail(fmt::format("{} must be true or false", name));
    return found->get<bool>();
}

std::string GltfObject::text(const char* name, const std::string& otherwise) const {
    const json* found = find(name);
    if (found == nullptr) return otherwise;
    if (!found->is_string()) fail(fmt::format("{} must be a string", name));
    return found->get<std::string>();
}

std::vector<double> GltfObject::numbers(const char* name, std::size_t count) const {
    const json* list = find_list(name);
    if (list == nullptr) return {};
    if (list->size() != count) fail(fmt::format("{} must have {} numbers, not {}", name, count, list->size()));
    std::vector<double> numbers;
    for (const json& value : *list) {
        if (!value.is_number()) fail(fmt::format("{} holds something that is not a number", name));
        numbers.push_back(value.get<double>());
    }
    return numbers;
}

std::vector<std::uint64_t> GltfObject::whole_numbers(const char* name) const {
    const json* list = find_list(name);
    if (list == nullptr) return {};
    std::vector<std::uint64_t> numbers;
    for (const json& value : *list) {
        const auto number = as_whole_number(value);
        if (!number) fail(fmt::format("{} holds something that is not a whole number of at least 0", name));
        numbers.push_back(*number);
    }
    return numbers;
}

std::optional<GltfObject> GltfObject::object(const char* name) const {
    const json* found = find(name);
    if (found == nullptr) return std::nullopt;
    if (!found->is_object()) fail(fmt::format("{} is not an object", name));
    return GltfObject(*found, m_what, m_where.empty() ? name : m_where + "." + name);
}

std::optional<GltfObject> GltfObject::extension(const char* name) const {
    const auto all = object("extensions");
    if (!all) return std::nullopt;
    auto found = all->object(name);
    if (found) found->m_what += ": " + std::string(name);
    return found;
}

std::vector<GltfObject> GltfObject::objects(const char* name, const char* one) const {
    const json* list = find_list(name);
    std::vector<GltfObject> objects;
    for (std::size_t i = 0; list != nullptr && i < list->size(); ++i)
        objects.emplace_back((*list)[i], fmt::format("{}, {} {}", m_what, one, i),
                             fmt::format("{}.{}[{}]", m_where, name, i));
    return objects;
}

}  // namespace sheer
