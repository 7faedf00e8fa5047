#include "renderer/litmus/formula.h"

#include <algorithm>
#include <stdexcept>

namespace sheer::litmus {

std::vector<FormulaInfo> make_formulas();

const std::vector<FormulaInfo>& all_formulas() {
    static const std::vector<FormulaInfo> formulas = make_formulas();
    return formulas;
}

const FormulaInfo& find_formula(const std::string& id) {
    const auto found = std::ranges::find(all_formulas(), id, &FormulaInfo::id);
    if (found == all_formulas().end())
        throw std::out_of_range("there is no formula " + id + ": add renderer/litmus/formulas/" + id + ".cpp");
    return *found;
}

const std::function<Formula(const nlohmann::json& parameters)>& formula_of(const std::string& id) {
    return find_formula(id).make;
}

}  // namespace sheer::litmus
