#include "renderer/litmus/formula.h"

namespace sheer::litmus {

FormulaInfo formula_exact() {
    return {.id = "exact",
            .name = "the over operator, fragments of each pixel sorted",
            .make = [](const nlohmann::json&) -> Formula { return over_by_depth; }};
}

}  // namespace sheer::litmus
