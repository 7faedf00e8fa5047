#include "renderer/litmus/formula.h"

namespace sheer::litmus {

namespace {

Formula tested(const nlohmann::json& parameters) {
    return [reference = parameters.value("reference", 0.5)](const Stack& stack) {
        return nearest_of(stack, reference, stack.below);
    };
}

}  // namespace

FormulaInfo formula_alpha_test() {
    return {.id = "alpha_test",
            .name = "alpha test",
            .make = tested,
            .weighs_by_alpha = false,
            .variants = {{{"reference", 0.25}}, {{"reference", 0.5}}, {{"reference", 0.75}}, {{"reference", 0}}}};
}

}  // namespace sheer::litmus
