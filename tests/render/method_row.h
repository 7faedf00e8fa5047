#pragma once
#include <string>
#include <vector>

#include "tests/render/formulas.h"

namespace sheer::test {

/// A method's parameters for a test; the formula is MethodRow::formula.
struct MethodVariant {
    nlohmann::json parameters = nlohmann::json::object();
    Bound bound = rounded_once;
    bool software_only = false;      ///< the formula is llvmpipe's; other devices have other rules
    std::size_t most_layers = 1024;  ///< the most that the method can draw or its formula covers
};

/// What a method's theory says about some litmus scenes, by their ids (renderer/litmus/scenes.h).
struct LitmusExpectation {
    std::vector<std::string> scenes;
    bool passes;
    std::string why;  ///< "<scenes>: passes, because <why>."
};
inline constexpr bool passes = true, fails = false;

/// Variants of one method with the same expectations.
struct LitmusEntry {
    std::string name;  ///< "" for the method's id
    std::vector<nlohmann::json> variants;
    std::vector<LitmusExpectation> expectations;  ///< each scene exactly once
};

/// What a method that stops early shades in each of early_exit_scenes() (tests/render/early_exit.h).
struct EarlyExit {
    nlohmann::json parameters = nlohmann::json::object();
    /// By scene: fragments that it shades for each needed one, at most, on a device that draws one primitive after the
    /// other.
    std::vector<double> most_shaded;
    std::string why;
};

/// Everything that the tests of all methods need to know about one: tests/render/methods/<id>.cpp, which ends with
/// `MethodRow row_<id>()`.
struct MethodRow {
    std::string id;
    /// Its value of a pixel with these parameters; missing parameters have their defaults.
    std::function<Formula(const nlohmann::json& parameters)> formula;
    bool sorts_primitives = false;  ///< as a whole, so that one side of an intersection has the wrong order
    /// Of a stochastic method, whose formula is its mean: how far a pixel with these parameters may be from it by
    /// chance. Missing for other methods.
    std::function<Bound(const nlohmann::json& parameters)> noise = nullptr;
    bool weighs_depths = false;  ///< its picture depends on the depths of fragments, not only on their order
    std::vector<MethodVariant> variants;
    std::vector<LitmusEntry> litmus;
    std::vector<EarlyExit> early_exit;  ///< of a method with a saturation_parameter and a picture
    double litmus_tolerance = 64e-5;    ///< of colors, from the formula: the roundings of 64 layers in 32-bit floats
};

/// Every row, from the generated table.
const std::vector<MethodRow>& all_method_rows();
/// Throws std::out_of_range, saying what to do, if there is none.
const MethodRow& method_row(const std::string& id);

/// `parameters` with the method's id, as a spec has it.
nlohmann::json method_json(const MethodRow& row, const nlohmann::json& parameters);

}  // namespace sheer::test
