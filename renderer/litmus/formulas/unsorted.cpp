#include "renderer/litmus/formula.h"

namespace sheer::litmus {

FormulaInfo formula_unsorted() {
    return {.id = "unsorted",
            .name = "the over operator, as submitted",
            .make = [](const nlohmann::json&) -> Formula { return over; },
            .depends_on_order = true};
}

}  // namespace sheer::litmus
