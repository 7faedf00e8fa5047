#pragma once
#include "renderer/litmus/formula.h"

namespace sheer::litmus {

/// Of the fragments with any alpha: their number, the sum of their weights and of these times their colors, and how
/// much of the background they let through.
struct WeightedSums {
    double count = 0, weights = 0, revealage = 1;
    Color colors = {};
};

WeightedSums weighted_sums(const Stack& stack, const nlohmann::json& parameters);

}  // namespace sheer::litmus
