#include "renderer/litmus/formula.h"

namespace sheer::litmus {

namespace {

Formula emitted_and_covered(const nlohmann::json& parameters) {
    return [coverage = parameters.value("coverage", 0.0)](const Stack& stack) {
        Color sum = {};
        double transmittance = 1;
        for (const Fragment& fragment : stack.fragments) {
            for (std::size_t i = 0; i < 3; ++i) sum[i] += fragment.alpha * fragment.color[i];
            transmittance *= 1 - coverage * fragment.alpha;
        }
        for (std::size_t i = 0; i < 3; ++i) sum[i] += transmittance * stack.below[i];
        return sum;
    };
}

}  // namespace

FormulaInfo formula_premultiplied_additive() {
    return {.id = "premultiplied_additive",
            .name = "additive blending",
            .make = emitted_and_covered,
            .variants = {nlohmann::json::object(), {{"coverage", 0.5}}, {{"coverage", 1}}}};
}

}  // namespace sheer::litmus
