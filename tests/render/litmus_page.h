#pragma once
#include <string>
#include <vector>

#include "renderer/litmus/scenes.h"
#include "tests/render/method_row.h"

namespace sheer::test {

/// The entry's name, or the method's id if it has none.
std::string entry_name(const MethodRow& row, const LitmusEntry& entry);

/// docs/litmus.md: what the scenes are, which method passes which, and why.
std::string litmus_page(const std::vector<LitmusSceneInfo>& scenes, const std::vector<MethodRow>& rows);

}  // namespace sheer::test
