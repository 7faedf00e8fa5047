#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/params/described.h"
#include "renderer/params/param.h"

namespace sheer {

/// A JSON value of any type; null if there is none.
struct AnyValue {
    nlohmann::json value;

    bool operator==(const AnyValue&) const = default;
};

/// A Param as the service's catalog and the docs list it.
struct Field {
    std::string name;
    Param::Kind kind = Param::Kind::number;
    std::string summary, unit;
    nlohmann::json default_value;
    bool required = false;
    AnyValue suggestion, min, max;
    bool exclusive = false, whole = false, optional = false;
    int step = 0;  ///< 0 for any
    std::vector<std::string> parts, choices;
    std::string asset_type;
    std::size_t min_length = 0, max_length = 0;
    std::vector<Field> fields;

    bool operator==(const Field&) const = default;
};

std::vector<Field> fields_of(const std::vector<Param>& params);

template <>
struct Words<Param::Kind> {
    using enum Param::Kind;
    static constexpr std::pair<Param::Kind, const char*> all[] = {
        {number, "number"},   {integer, "integer"}, {boolean, "boolean"}, {choice, "choice"}, {text, "text"},
        {numbers, "numbers"}, {object, "object"},   {list, "list"},       {asset, "asset"},   {any, "any"}};
};

template <>
const Description<Field>& description_of();

namespace detail {

template <>
struct Codec<AnyValue> {
    static nlohmann::json write(const AnyValue& any) { return any.value; }
    static void read(const nlohmann::json& from, AnyValue& to) { to.value = from; }
    static nlohmann::json schema(SchemaBook&) { return nlohmann::json::object(); }
};

/// The types of the default and the suggestion depend on the kind.
template <>
struct Codec<Field> {
    static nlohmann::json write(const Field& field) { return description_of<Field>().write(field); }
    static void read(const nlohmann::json& from, Field& to) { description_of<Field>().read(from, to); }
    static nlohmann::json schema(SchemaBook& book);
};

}  // namespace detail

}  // namespace sheer
