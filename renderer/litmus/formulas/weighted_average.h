#pragma once
#include "renderer/litmus/formula.h"

namespace sheer::litmus {

/// The sums of a pixel; fragments of alpha 0 are dropped.
struct AverageSums {
    double count = 0, alphas = 0;
    Color colors = {};
};

AverageSums average_sums(const Stack& stack);

}  // namespace sheer::litmus
