#pragma once
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/core/errors.h"

namespace sheer {

inline constexpr std::size_t max_asset_name_bytes = 1024;

/// One field of a spec, described once: the reader, the JSON schema, `sheer methods`, the page's forms and the docs are
/// all made from it.
struct Param {
    enum class Kind { number, integer, boolean, choice, text, numbers, object, list, asset, any };

    std::string name;
    Kind kind = Kind::number;
    std::string summary;
    std::string unit;                        ///< "" if it has none
    nlohmann::json default_value = nullptr;  ///< null: the field must be given, unless `optional`
    nlohmann::json suggestion = nullptr;     ///< a form's initial value if the field must be given; null for none
    bool optional = false;                   ///< may be absent, and is then null
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool exclusive = false;            ///< min and max themselves are not allowed
    bool whole = false;                ///< of numbers: each is a whole number
    int step = 1;                      ///< of an integer: only min and every step-th number from there are allowed
    std::vector<std::string> parts;    ///< of numbers: their names; {} if they have none
    std::vector<std::string> choices;  ///< of a choice; of an asset: the built-in names
    std::string asset_type;            ///< of an asset: texture, model or volume
    std::size_t min_length = 0;        ///< of text (bytes), numbers and lists
    std::size_t max_length = 0;        ///< of an asset: the length of an array in its place; 0: no array
    std::vector<Param> fields;  ///< of an object, of the objects in a list, or of the object that may replace a choice

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
    /// A fixed count of numbers, such as a color.
    static Param numbers(std::string name, std::string summary, std::string unit, const std::vector<double>& fallback,
                         double min, double max);
    /// Red, green and blue from 0 to 1.
    static Param color(std::string name, std::string summary, const std::vector<double>& fallback);
    static Param object(std::string name, std::string summary, std::vector<Param> fields);
    static Param list(std::string name, std::string summary, std::vector<Param> fields, std::size_t min_length,
                      std::size_t max_length);

    /// An uploaded file, by its SHA-256, or one of `built_in`; for `sheer compare` also a path. "" for no default.
    static Param asset(std::string name, std::string summary, std::string type, std::string fallback,
                       std::vector<std::string> built_in);
    /// One such file or name, or an array of `count` of them.
    Param or_each_of(std::size_t count) const;

    /// The same field without a default; the default becomes the suggestion.
    Param required() const;
    /// Gives each of the numbers a name.
    Param of(std::vector<std::string> parts) const;
    /// Only the integers min, min + step, ... up to max are allowed.
    Param in_steps_of(int step) const;
};

/// Reads `object` by its description: checks types and ranges, fills in defaults, adds an error for each wrong, missing
/// or unknown field. Returns the normalised object, in which wrong fields have their defaults.
nlohmann::json read_fields(const nlohmann::json& object, const std::string& pointer, const std::vector<Param>& fields,
                           std::vector<FieldError>& errors);

/// The value of a field that is not given. An object that may not be null gets the defaults of its fields too, so that
/// code which reads it finds every field.
nlohmann::json default_of(const Param& param);
/// Whether a field may be left out; an object may if each of its fields may.
bool may_be_absent(const Param& param);
/// The allowed values of an integer with a step; for fields with few values.
std::vector<std::int64_t> values_in_steps(const Param& param);
/// `value` as JSON; as a whole number if the field is one.
nlohmann::json bound_of(const Param& param, double value);

/// The same description as a JSON schema object, for draft 7 and all later ones.
nlohmann::json schema_of(const std::vector<Param>& fields);
/// The schema of what read_fields() returns: every field is there, and an optional one may be null.
nlohmann::json normalised_schema_of(const std::vector<Param>& fields);
/// The same description as an array of Field.
nlohmann::json to_json(const std::vector<Param>& fields);

/// A field of a spec that refers to a file.
struct AssetReference {
    std::string pointer;
    std::string name;
    std::string type;  ///< texture, model or volume
};
/// Every file that a normalised object refers to; built-in names are not files.
std::vector<AssetReference> find_assets(const nlohmann::json& object, const std::string& pointer,
                                        const std::vector<Param>& fields);

/// The value as JSON text, cut to `max_bytes`, with "..." appended if it is cut.
std::string shortened_json(const nlohmann::json& value, std::size_t max_bytes);

}  // namespace sheer
