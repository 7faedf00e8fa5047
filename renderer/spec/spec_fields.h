#pragma once
#include <cstddef>
#include <vector>

#include "renderer/params/param.h"

namespace sheer {

inline constexpr std::size_t max_methods = 64, max_looks = 8, max_tags = 32, max_under_test = 64, max_devices = 8,
                             max_text_bytes = 200;

/// The fields of a spec; scene, methods and reference are read by their own descriptions.
std::vector<Param> spec_fields();

}  // namespace sheer
