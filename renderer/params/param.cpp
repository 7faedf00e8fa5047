#include "renderer/params/param.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "renderer/params/json_text.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr std::size_t max_quoted_bytes = 80;

/// The value as JSON, shortened; of a long list or object only its type and size, since nobody would read it.
std::string quoted(const json& value) {
    if (value.is_structured() && value.size() > max_quoted_bytes / 2)
        return fmt::format("an {} of {} entries", value.type_name(), value.size());
    return shortened_json(value, max_quoted_bytes);
}

bool in_range(const Param& param, double value) {
    if (!std::isfinite(value)) return false;
    return param.exclusive ? value > param.min && value < param.max : value >= param.min && value <= param.max;
}

bool is_whole(const json& value) {
    return value.is_number_integer() ||
           (value.is_number_float() && std::floor(value.get<double>()) == value.get<double>());
}

std::string range_text(const Param& param) {
    const bool low = std::isfinite(param.min), high = std::isfinite(param.max);
    if (low && high)
        return fmt::format("from {} to {}{}", param.min, param.max, param.exclusive ? ", both excluded" : "");
    if (low) return fmt::format("{} {}", param.exclusive ? "over" : "at least", param.min);
    if (high) return fmt::format("{} {}", param.exclusive ? "under" : "at most", param.max);
    return "finite";
}

std::vector<std::string> names_of(const std::vector<Param>& fields) {
    std::vector<std::string> names;
    for (const Param& param : fields) names.push_back(param.name);
    return names;
}

/// Reads one value; if it is wrong, adds an error and returns the default.
class ValueReader {
  public:
    ValueReader(const Param& param, const std::string& pointer, std::vector<FieldError>& errors)
        : m_param(param), m_pointer(pointer), m_errors(errors) {}

    json read(const json& value) {
        switch (m_param.kind) {
            case Param::Kind::number:
                return number(value);
            case Param::Kind::integer:
                return integer(value);
            case Param::Kind::boolean:
                return value.is_boolean() ? value : wrong("must be true or false", value);
            case Param::Kind::choice:
                return choice(value);
            case Param::Kind::text:
                return text(value);
            case Param::Kind::numbers:
                return numbers(value);
            case Param::Kind::object:
                return object(value);
            case Param::Kind::list:
                return list(value);
            case Param::Kind::asset:
                return asset(value);
            case Param::Kind::any:
                return value;
        }
        return value;
    }

  private:
    json wrong(const std::string& what, const json& value) {
        add_error(m_errors, m_pointer, [&] { return fmt::format("{}, not {}", what, quoted(value)); });
        return default_of(m_param);
    }

    json number(const json& value) {
        if (!value.is_number()) return wrong("must be a number " + range_text(m_param), value);
        if (!in_range(m_param, value.get<double>())) return wrong("must be " + range_text(m_param), value);
        return value.get<double>();
    }

    json integer(const json& value) {
        if (!is_whole(value)) return wrong("must be a whole number " + range_text(m_param), value);
        if (!in_range(m_param, value.get<double>())) return wrong("must be " + range_text(m_param), value);
        if (m_param.step > 1 && std::ranges::count(values_in_steps(m_param), value.get<std::int64_t>()) == 0)
            return wrong(fmt::format("must be one of {}", fmt::join(values_in_steps(m_param), ", ")), value);
        return value.get<std::int64_t>();
    }

    json choice(const json& value) {
        if (value.is_string() && std::ranges::find(m_param.choices, value.get<std::string>()) != m_param.choices.end())
            return value;
        if (m_param.fields.empty())
            return wrong(fmt::format("must be one of {}", fmt::join(m_param.choices, ", ")), value);
        if (value.is_object()) return read_fields(value, m_pointer, m_param.fields, m_errors);
        return wrong(fmt::format("must be one of {}, or an object with {}", fmt::join(m_param.choices, ", "),
                                 fmt::join(names_of(m_param.fields), ", ")),
                     value);
    }

    json text(const json& value) {
        if (!value.is_string()) return wrong("must be a text", value);
        const std::size_t length = value.get_ref<const std::string&>().size();
        if (length < m_param.min_length || length > m_param.max_length)
            return wrong(fmt::format("must have {} to {} bytes", m_param.min_length, m_param.max_length), value);
        return value;
    }

    static bool is_asset_name(const json& value) {
        return value.is_string() && !value.get_ref<const std::string&>().empty() &&
               value.get_ref<const std::string&>().size() <= max_asset_name_bytes;
    }

    json asset(const json& value) {
        if (is_asset_name(value)) return value;
        std::string what = "must be the SHA-256 of an uploaded " + m_param.asset_type;
        if (!m_param.choices.empty())
            what = fmt::format("must be one of {}, or the SHA-256 of an uploaded {}", fmt::join(m_param.choices, ", "),
                               m_param.asset_type);
        if (m_param.max_length == 0) return wrong(what, value);
        if (!value.is_array() || value.size() != m_param.max_length)
            return wrong(fmt::format("{}, or an array of {} of them", what, m_param.max_length), value);
        bool right = true;
        for (std::size_t i = 0; i < value.size(); ++i) {
            if (is_asset_name(value[i])) continue;
            right = false;
            m_errors.push_back({fmt::format("{}/{}", m_pointer, i), fmt::format("{}, not {}", what, quoted(value[i]))});
        }
        return right ? value : m_param.default_value;
    }

    json numbers(const json& value) {
        if (!value.is_array() || value.size() != m_param.max_length)
            return wrong(fmt::format("must be an array of {} numbers", m_param.max_length), value);
        json read_values = json::array();
        for (std::size_t i = 0; i < value.size(); ++i) {
            const bool right = (m_param.whole ? is_whole(value[i]) : value[i].is_number()) &&
                               in_range(m_param, value[i].get<double>());
            if (!right) {
                add_error(m_errors, fmt::format("{}/{}", m_pointer, i), [&] {
                    return fmt::format("must be a {} {}, not {}", m_param.whole ? "whole number" : "number",
                                       range_text(m_param), quoted(value[i]));
                });
                return default_of(m_param);
            }
            read_values.push_back(value[i].get<double>());
        }
        return read_values;
    }

    json object(const json& value) {
        if (!value.is_object()) return wrong("must be an object", value);
        return read_fields(value, m_pointer, m_param.fields, m_errors);
    }

    json list(const json& value) {
        if (!value.is_array()) return wrong("must be an array", value);
        if (value.size() < m_param.min_length || value.size() > m_param.max_length) {
            add_error(m_errors, m_pointer, [&] {
                return fmt::format("must have {} to {} entries, not {}", m_param.min_length, m_param.max_length,
                                   value.size());
            });
            return json::array();
        }
        json entries = json::array();
        for (std::size_t i = 0; i < value.size(); ++i) {
            const std::string entry_pointer = fmt::format("{}/{}", m_pointer, i);
            if (value[i].is_object()) {
                entries.push_back(read_fields(value[i], entry_pointer, m_param.fields, m_errors));
            } else {
                add_error(m_errors, entry_pointer, [&] { return "must be an object, not " + quoted(value[i]); });
            }
        }
        return entries;
    }

    const Param& m_param;
    const std::string& m_pointer;
    std::vector<FieldError>& m_errors;
};

}  // namespace

Param Param::number(std::string name, std::string summary, std::string unit, double fallback, double min, double max) {
    Param param{.name = std::move(name), .summary = std::move(summary), .unit = std::move(unit)};
    param.default_value = fallback;
    param.min = min;
    param.max = max;
    return param;
}

Param Param::integer(std::string name, std::string summary, std::string unit, long long fallback, double min,
                     double max) {
    Param param = number(std::move(name), std::move(summary), std::move(unit), 0, min, max);
    param.kind = Kind::integer;
    param.default_value = fallback;
    return param;
}

Param Param::boolean(std::string name, std::string summary, bool fallback) {
    Param param{.name = std::move(name), .kind = Kind::boolean, .summary = std::move(summary)};
    param.default_value = fallback;
    return param;
}

Param Param::choice(std::string name, std::string summary, std::string fallback, std::vector<std::string> choices) {
    Param param{.name = std::move(name), .kind = Kind::choice, .summary = std::move(summary)};
    param.default_value = std::move(fallback);
    param.choices = std::move(choices);
    return param;
}

Param Param::choice_or_object(std::string name, std::string summary, std::string fallback,
                              std::vector<std::string> choices, std::vector<Param> fields) {
    Param param = choice(std::move(name), std::move(summary), std::move(fallback), std::move(choices));
    param.fields = std::move(fields);
    return param;
}

Param Param::text(std::string name, std::string summary, std::string fallback, std::size_t max_length_bytes) {
    Param param{.name = std::move(name), .kind = Kind::text, .summary = std::move(summary)};
    param.default_value = std::move(fallback);
    param.max_length = max_length_bytes;
    return param;
}

Param Param::numbers(std::string name, std::string summary, std::string unit, const std::vector<double>& fallback,
                     double min, double max) {
    Param param = number(std::move(name), std::move(summary), std::move(unit), 0, min, max);
    param.kind = Kind::numbers;
    param.min_length = param.max_length = fallback.size();
    param.default_value = fallback;
    return param;
}

Param Param::color(std::string name, std::string summary, const std::vector<double>& fallback) {
    return numbers(std::move(name), std::move(summary), "", fallback, 0, 1).of({"red", "green", "blue"});
}

Param Param::object(std::string name, std::string summary, std::vector<Param> fields) {
    Param param{.name = std::move(name), .kind = Kind::object, .summary = std::move(summary)};
    param.fields = std::move(fields);
    return param;
}

Param Param::list(std::string name, std::string summary, std::vector<Param> fields, std::size_t min_length,
                  std::size_t max_length) {
    Param param = object(std::move(name), std::move(summary), std::move(fields));
    param.kind = Kind::list;
    param.min_length = min_length;
    param.max_length = max_length;
    if (min_length == 0) param.default_value = json::array();
    return param;
}

Param Param::asset(std::string name, std::string summary, std::string type, std::string fallback,
                   std::vector<std::string> built_in) {
    Param param = choice(std::move(name), std::move(summary), "", std::move(built_in));
    param.kind = Kind::asset;
    param.default_value = fallback.empty() ? json() : json(std::move(fallback));
    param.asset_type = std::move(type);
    return param;
}

Param Param::or_each_of(std::size_t count) const {
    Param param = *this;
    param.max_length = count;
    return param;
}

Param Param::required() const {
    Param param = *this;
    param.suggestion = std::move(param.default_value);
    param.default_value = nullptr;
    return param;
}

Param Param::of(std::vector<std::string> names_of_parts) const {
    if (names_of_parts.size() != max_length) throw std::logic_error("each number of " + name + " must have a name");
    Param param = *this;
    param.parts = std::move(names_of_parts);
    return param;
}

Param Param::in_steps_of(int allowed_step) const {
    Param param = *this;
    param.step = allowed_step;
    return param;
}

std::vector<std::int64_t> values_in_steps(const Param& param) {
    std::vector<std::int64_t> values;
    for (auto value = static_cast<std::int64_t>(param.min); value <= static_cast<std::int64_t>(param.max);
         value += param.step)
        values.push_back(value);
    return values;
}

json default_of(const Param& param) {
    if (param.kind == Param::Kind::object && param.default_value.is_null() && !param.optional) {
        std::vector<FieldError> ignored;
        return read_fields(json::object(), "", param.fields, ignored);
    }
    return param.default_value;
}

bool may_be_absent(const Param& param) {
    if (param.optional || !param.default_value.is_null()) return true;
    return param.kind == Param::Kind::object && std::ranges::all_of(param.fields, may_be_absent);
}

json bound_of(const Param& param, double value) {
    return param.kind == Param::Kind::integer || param.whole ? json(static_cast<std::int64_t>(value)) : json(value);
}

json read_fields(const json& object, const std::string& pointer, const std::vector<Param>& fields,
                 std::vector<FieldError>& errors) {
    json result = json::object();
    for (const Param& param : fields) {
        const auto found = object.find(param.name);
        const std::string field_pointer = (json::json_pointer(pointer) / param.name).to_string();
        if (found == object.end() || (found->is_null() && param.optional)) {
            result[param.name] = default_of(param);
            if (!may_be_absent(param)) add_error(errors, field_pointer, [&] { return "is missing: " + param.summary; });
        } else {
            result[param.name] = ValueReader(param, field_pointer, errors).read(*found);
        }
    }
    for (const auto& [key, value] : object.items()) {
        if (std::ranges::find(fields, key, &Param::name) != fields.end()) continue;
        add_error(errors, (json::json_pointer(pointer) / key).to_string(),
                  [&] { return fmt::format("is not a known field; known are {}", fmt::join(names_of(fields), ", ")); });
    }
    return result;
}

std::vector<AssetReference> find_assets(const json& object, const std::string& pointer,
                                        const std::vector<Param>& fields) {
    std::vector<AssetReference> found;
    for (const Param& param : fields) {
        const json& value = object.at(param.name);
        const std::string field_pointer = (json::json_pointer(pointer) / param.name).to_string();
        const auto add = [&](const std::string& name, const std::string& where) {
            if (std::ranges::find(param.choices, name) == param.choices.end())
                found.push_back({where, name, param.asset_type});
        };
        if (param.kind == Param::Kind::asset && value.is_string()) {
            add(value, field_pointer);
        } else if (param.kind == Param::Kind::asset && value.is_array()) {
            for (std::size_t i = 0; i < value.size(); ++i) add(value[i], fmt::format("{}/{}", field_pointer, i));
        } else if (value.is_object() && !param.fields.empty()) {
            std::ranges::move(find_assets(value, field_pointer, param.fields), std::back_inserter(found));
        }
    }
    return found;
}

std::string shortened_json(const json& value, std::size_t max_bytes) {
    std::string text = json_line(value);
    if (text.size() <= max_bytes) return text;
    // Do not cut within a UTF-8 character.
    std::size_t end = max_bytes;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return text.substr(0, end) + "...";
}

}  // namespace sheer
