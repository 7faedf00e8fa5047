#include "renderer/litmus/formula.h"

namespace sheer::litmus {

FormulaInfo formula_hashed_alpha() {
    return {.id = "hashed_alpha",
            .name = "hashed alpha testing",
            .make = [](const nlohmann::json&) -> Formula { return over_by_depth; },
            .variance = [](const nlohmann::json& parameters) -> Formula {
                return [frames = parameters.value("frames", 1)](const Stack& stack) {
                    Color variance = variance_of_sample(stack);
                    for (double& channel : variance) channel /= frames;
                    return variance;
                };
            },
            .weighs_by_alpha = false,
            .variants = {{{"hash", "position_and_primitive"}, {"frames", 1}}}};
}

}  // namespace sheer::litmus
