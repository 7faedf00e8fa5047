#pragma once
#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "renderer/params/param.h"

namespace sheer {

namespace detail {

/// Read a normalised object; throw std::logic_error naming the parameter if it is missing or of another type.
double number_in(const nlohmann::json& object, const std::string& name);
std::int64_t integer_in(const nlohmann::json& object, const std::string& name);
bool boolean_in(const nlohmann::json& object, const std::string& name);
std::string text_in(const nlohmann::json& object, const std::string& name);
std::vector<double> numbers_in(const nlohmann::json& object, const std::string& name, std::size_t count);
[[noreturn]] void throw_unknown_choice(const std::string& name, const std::string& choice);

}  // namespace detail

/// Binds the members of a struct of parameters to their descriptions. A parameter's default is in the struct,
/// everything else about it is here:
///
///     enum class Variant { simple, full };
///     struct MineParameters {
///         double threshold = 0.01;
///         Variant variant = Variant::simple;
///     };
///
///     ParamTable<MineParameters> parameters() {
///         return ParamTable<MineParameters>()
///             .number(&MineParameters::threshold, "threshold", "what it does", "unit", 0, 1)
///             .choice(&MineParameters::variant, "variant", "what it does",
///                     {{"simple", Variant::simple}, {"full", Variant::full}});
///     }
template <typename Struct>
class ParamTable {
  public:
    ParamTable& number(double Struct::*member, const std::string& name, const std::string& summary,
                       const std::string& unit, double min, double max) {
        return add(
            Param::number(name, summary, unit, Struct{}.*member, min, max),
            [member, name](Struct& to, const nlohmann::json& from) { to.*member = detail::number_in(from, name); });
    }

    template <std::integral Int>
    ParamTable& integer(Int Struct::*member, const std::string& name, const std::string& summary,
                        const std::string& unit, double min, double max) {
        return add(Param::integer(name, summary, unit, static_cast<long long>(Struct{}.*member), min, max),
                   [member, name](Struct& to, const nlohmann::json& from) {
                       to.*member = static_cast<Int>(detail::integer_in(from, name));
                   });
    }

    ParamTable& boolean(bool Struct::*member, const std::string& name, const std::string& summary) {
        return add(
            Param::boolean(name, summary, Struct{}.*member),
            [member, name](Struct& to, const nlohmann::json& from) { to.*member = detail::boolean_in(from, name); });
    }

    /// Red, green and blue from 0 to 1.
    ParamTable& color(std::array<double, 3> Struct::*member, const std::string& name, const std::string& summary) {
        const std::array<double, 3> fallback = Struct{}.*member;
        return add(Param::color(name, summary, {fallback.begin(), fallback.end()}),
                   [member, name](Struct& to, const nlohmann::json& from) {
                       const std::vector<double> values = detail::numbers_in(from, name, 3);
                       std::copy(values.begin(), values.end(), (to.*member).begin());
                   });
    }

    /// Each value of the enum that may be chosen, with its name in JSON.
    template <typename Enum>
    ParamTable& choice(Enum Struct::*member, const std::string& name, const std::string& summary,
                       std::initializer_list<std::pair<const char*, Enum>> choices) {
        const std::vector<std::pair<std::string, Enum>> known(choices.begin(), choices.end());
        std::vector<std::string> names;
        std::string fallback;
        for (const auto& [choice_name, value] : known) {
            names.push_back(choice_name);
            if (value == Struct{}.*member) fallback = choice_name;
        }
        if (fallback.empty()) throw std::logic_error("the default of " + name + " is not one of its choices");
        return add(Param::choice(name, summary, fallback, names),
                   [member, name, known](Struct& to, const nlohmann::json& from) {
                       const std::string chosen = detail::text_in(from, name);
                       for (const auto& [choice_name, value] : known)
                           if (choice_name == chosen) {
                               to.*member = value;
                               return;
                           }
                       detail::throw_unknown_choice(name, chosen);
                   });
    }

    /// Only min, min + step, ... up to max are allowed for the integer added last.
    ParamTable& in_steps_of(int step) {
        Param& last = m_bindings.back().param;
        last = last.in_steps_of(step);
        return *this;
    }

    /// The parameters of a base struct.
    template <typename Base>
    requires std::derived_from<Struct, Base> ParamTable& with(const ParamTable<Base>& base) {
        for (const auto& binding : base.m_bindings) add(binding.param, binding.read);
        return *this;
    }

    /// The same table with another least value for one parameter.
    ParamTable with_min(const std::string& name, double min) const {
        ParamTable table = *this;
        for (auto& binding : table.m_bindings)
            if (binding.param.name == name) {
                binding.param.min = min;
                return table;
            }
        throw std::logic_error("there is no parameter " + name);
    }

    std::vector<Param> params() const {
        std::vector<Param> all;
        for (const auto& binding : m_bindings) all.push_back(binding.param);
        return all;
    }

    /// Reads an object that read_fields() has normalised, so that every parameter is present and in range. Throws
    /// std::logic_error for any other object, naming the parameter and, if it is unknown, the choice.
    Struct read(const nlohmann::json& normalised) const {
        Struct values;
        for (const auto& binding : m_bindings) binding.read(values, normalised);
        return values;
    }

  private:
    template <typename Other>
    friend class ParamTable;

    using Read = std::function<void(Struct&, const nlohmann::json&)>;
    struct Binding {
        Param param;
        Read read;
    };

    ParamTable& add(Param param, Read read) {
        m_bindings.push_back({std::move(param), std::move(read)});
        return *this;
    }

    std::vector<Binding> m_bindings;
};

}  // namespace sheer
