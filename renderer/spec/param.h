#pragma once
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/errors.h"

namespace sheer {

/// One field of a spec, described once: the reader, the JSON schema, `sheer methods`, the page's forms and the docs are
/// all made from it.
struct Param {
    enum class Kind { number, integer, boolean, choice, text, numbers, object, list, asset, any };

    std::string name;
    Kind kind = Kind::number;
    std::string summary;
    std::string unit;                        ///< "" where it has none
    nlohmann::json default_value = nullptr;  ///< null: the field must be given, unless `optional`
    nlohmann::json suggestion = nullptr;     ///< what a form begins with where the field must be given; null for none
    bool optional = false;                   ///< may be absent, then it is null
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool exclusive = false;            ///< min and max themselves are not allowed
    bool whole = false;                ///< of numbers: each is a whole number
    int step = 1;                      ///< of an integer: min and every step-th number from there are allowed
    std::vector<std::string> choices;  ///< of a choice; of an asset: the names that mean something built in
    std::string asset_type;            ///< of an asset: texture, model or volume
    std::size_t min_length = 0;        ///< of text (bytes), numbers and lists
    std::size_t max_length = 0;        ///< of an asset: how many an array in its place has; 0 for none
    std::vector<Param> fields;  ///< of an object, of the objects in a list, of the object that a choice may be instead

    static Param number(std::string name, std::string summary, std::string unit, double fallback, double min,
                        double max);
    static Param integer(std::string name, std::string summary, std::string unit, long long fallback, double min,
                         double max);
    static Param boolean(std::string name, std::string summary, bool fallback);
    static Param choice(std::string name, std::string summary, std::string fallback, std::vector<std::string> choices);
    /// One of `choices`, or an object with these fields.
    static Param choice_or_object(std::string name, std::string summary, std::string fallback,
                                  std::vector<std::string> choices, std::vector<Param> fields);
    static Param text(std::string name, std::string summary, std::string fallback, std::size_t max_length_bytes);
    /// A fixed count of numbers, such as a colour.
    static Param numbers(std::string name, std::string summary, std::string unit, const std::vector<double>& fallback,
                         double min, double max);
    static Param object(std::string name, std::string summary, std::vector<Param> fields);
    static Param list(std::string name, std::string summary, std::vector<Param> fields, std::size_t min_length,
                      std::size_t max_length);

    /// A file that was uploaded, by its SHA-256, or one of `built_in`; for `sheer compare` also a path. "" for no
    /// default.
    static Param asset(std::string name, std::string summary, std::string type, std::string fallback,
                       std::vector<std::string> built_in);
    /// One such file or name, or an array of `count` of them.
    Param or_each_of(std::size_t count) const;

    /// The same field without a default; what was the default is the suggestion.
    Param required() const;
    /// An integer of which only min, min + step, ... to max are allowed.
    Param in_steps_of(int step) const;
};

/// Reads `object` by its description: checks types and ranges, fills in defaults, adds an error for each wrong, missing
/// or unknown field. Returns the normalised object; its wrong fields hold their defaults.
nlohmann::json read_fields(const nlohmann::json& object, const std::string& pointer, const std::vector<Param>& fields,
                           std::vector<FieldError>& errors);

/// The same description as a JSON schema (draft 7) object.
nlohmann::json schema_of(const std::vector<Param>& fields);
/// The same description as an array of {name, kind, summary, unit, default, required, suggestion, min, max, exclusive,
/// whole, optional, choices, asset_type, fields, min_length, max_length}; what says nothing is left out.
nlohmann::json to_json(const std::vector<Param>& fields);

/// A field of a spec that refers to a file.
struct AssetReference {
    std::string pointer;
    std::string name;
    std::string type;  ///< texture, model or volume
};
/// Every file that a normalised object refers to; built-in names are none.
std::vector<AssetReference> find_assets(const nlohmann::json& object, const std::string& pointer,
                                        const std::vector<Param>& fields);

/// The value as JSON text, cut to `max_bytes` with "..." behind them.
std::string shortened_json(const nlohmann::json& value, std::size_t max_bytes);

/// `token` escaped for a JSON pointer (RFC 6901).
std::string pointer_token(const std::string& token);

}  // namespace sheer
