#include "renderer/litmus/formula.h"

namespace sheer::litmus {

FormulaInfo formula_b2f() {
    return {.id = "b2f",
            .name = "the over operator, primitives sorted",
            .make = [](const nlohmann::json&) -> Formula { return over_by_depth; },
            .sorts_primitives = true};
}

}  // namespace sheer::litmus
