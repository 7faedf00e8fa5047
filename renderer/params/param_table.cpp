#include "renderer/params/param_table.h"

#include <nlohmann/json.hpp>

namespace sheer::detail {

using nlohmann::json;

namespace {

[[noreturn]] void fail(const std::string& name, const std::string& what) {
    throw std::logic_error("the parameter " + name + " " + what);
}

const json& value_in(const json& object, const std::string& name) {
    const auto found = object.find(name);
    if (found == object.end()) fail(name, "is missing");
    return *found;
}

}  // namespace

double number_in(const json& object, const std::string& name) {
    const json& value = value_in(object, name);
    if (!value.is_number()) fail(name, "is not a number");
    return value.get<double>();
}

std::int64_t integer_in(const json& object, const std::string& name) {
    const json& value = value_in(object, name);
    if (!value.is_number()) fail(name, "is not a number");
    return value.get<std::int64_t>();
}

bool boolean_in(const json& object, const std::string& name) {
    const json& value = value_in(object, name);
    if (!value.is_boolean()) fail(name, "is neither true nor false");
    return value.get<bool>();
}

std::string text_in(const json& object, const std::string& name) {
    const json& value = value_in(object, name);
    if (!value.is_string()) fail(name, "is not a text");
    return value.get<std::string>();
}

std::vector<double> numbers_in(const json& object, const std::string& name, std::size_t count) {
    const json& value = value_in(object, name);
    if (!value.is_array() || value.size() != count) fail(name, "is not an array of " + std::to_string(count));
    std::vector<double> numbers;
    for (const json& element : value) {
        if (!element.is_number()) fail(name, "is not an array of numbers");
        numbers.push_back(element.get<double>());
    }
    return numbers;
}

void throw_unknown_choice(const std::string& name, const std::string& choice) {
    fail(name, "has the unknown choice \"" + choice + "\"");
}

}  // namespace sheer::detail
