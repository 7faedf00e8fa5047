#include "server/jobs/foreign_input.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "renderer/core/sha256.h"

namespace sheer {

bool has_foreign_input(const nlohmann::json& spec) {
    if (spec.is_string()) return is_sha256(spec.get_ref<const std::string&>());
    if (spec.is_object() && spec.contains("glsl")) return true;
    return spec.is_structured() && std::ranges::any_of(spec, has_foreign_input);
}

}  // namespace sheer
