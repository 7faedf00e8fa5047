#pragma once
#include <string>
#include <vector>

#include "renderer/litmus/scenes.h"
#include "tests/render/method_row.h"

namespace sheer::test {

/// A scene made to hurt methods that stop early.
struct EarlyExitScene {
    std::string name, what;
    LitmusScene scene;
};

const std::vector<EarlyExitScene>& early_exit_scenes();

/// The section of docs/litmus.md that says what each method shades there.
std::string early_exit_section(const std::vector<MethodRow>& rows);

}  // namespace sheer::test
