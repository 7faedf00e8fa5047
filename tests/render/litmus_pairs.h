#pragma once
#include <string>
#include <vector>

#include "tests/render/method_row.h"

namespace sheer::test {

/// Litmus entries whose formulas give the same picture of every litmus scene, to within three 8-bit levels.
struct FormulaGroup {
    std::vector<std::string> entries;
};

/// Which litmus scene tells two formulas apart.
struct FormulaPairs {
    struct Cell {
        std::string scene;      ///< the id of the one on which they differ most
        double difference = 0;  ///< of a color there, 0 to 1
    };
    std::vector<FormulaGroup> groups;
    std::vector<std::vector<Cell>> cells;  ///< by two groups; symmetric
};

/// Computed on the CPU from the rows' formulas alone.
FormulaPairs compare_formulas(const std::vector<MethodRow>& rows);

/// The part of docs/litmus.md about them.
std::string pairs_section(const FormulaPairs& pairs);

}  // namespace sheer::test
