#include "renderer/methods/shared/method.h"

#include <algorithm>
#include <stdexcept>

#include "renderer/core/names.h"

namespace sheer {

std::vector<MethodInfo> make_methods();

const Param* MethodInfo::saturation() const {
    if (saturation_parameter.empty()) return nullptr;
    const auto found = std::ranges::find(parameters, saturation_parameter, &Param::name);
    if (found == parameters.end()) throw std::logic_error(id + " has no parameter " + saturation_parameter);
    return &*found;
}

std::optional<double> MethodInfo::saturation_of(const nlohmann::json& parameters_here) const {
    const Param* param = saturation();
    return param ? std::optional(parameters_here.at(param->name).get<double>()) : std::nullopt;
}

const std::vector<MethodInfo>& all_methods() {
    static const std::vector<MethodInfo> methods = make_methods();
    return methods;
}

const MethodInfo* find_method(const std::string& id) {
    return find_by_id(all_methods(), id);
}

}  // namespace sheer
