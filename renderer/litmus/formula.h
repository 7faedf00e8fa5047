#pragma once
#include <optional>
#include <string>

#include "renderer/litmus/over.h"

namespace sheer::litmus {

/// A formula of blending, in double precision. The file renderer/litmus/formulas/<id>.cpp ends with
/// `FormulaInfo formula_<id>()`; the id is that of the method whose formula it is, or a name of its own.
struct FormulaInfo {
    std::string id;
    /// What draws so, for people: "WBOIT".
    std::string name;
    /// Its value of a pixel with these parameters; missing parameters have the method's defaults.
    std::function<Formula(const nlohmann::json& parameters)> make;
    /// Draws primitives as a whole in the order of their middles, so that one side of an intersection is wrong.
    bool sorts_primitives = false;
    /// Of a picture that is random: the variance of a pixel, whose mean is `make`. Missing for others.
    std::function<Formula(const nlohmann::json& parameters)> variance = nullptr;
    bool depends_on_order = false;  ///< of submission
    /// Colors are multiplied by alpha, so that ones that already are can be added as they are.
    bool weighs_by_alpha = true;
    /// The parameters that pictures are looked for with; together with the formula, each is a possible answer.
    std::vector<nlohmann::json> variants = {nlohmann::json::object()};
};

/// Every formula, from the generated table.
const std::vector<FormulaInfo>& all_formulas();
/// Throws std::out_of_range if there is none.
const FormulaInfo& find_formula(const std::string& id);
/// Its `make`, which takes parameters.
const std::function<Formula(const nlohmann::json& parameters)>& formula_of(const std::string& id);

}  // namespace sheer::litmus
