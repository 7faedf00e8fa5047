#pragma once
#include <string>
#include <vector>

#include "renderer/spec/spec.h"

namespace sheer {

/// The body of a user's own shading.
struct SpecShader {
    std::string pointer;  ///< where a spec has it
    std::string glsl;
};

/// Every shader of a spec once: of its scene, its methods, and the points of its sweep, of which the pointer is the
/// axis.
std::vector<SpecShader> shaders_of(const Spec& spec);

}  // namespace sheer
