#include "renderer/methods/method.h"
#include "renderer/spec/names.h"

namespace sheer {

std::vector<MethodInfo> make_methods();

const std::vector<MethodInfo>& all_methods() {
    static const std::vector<MethodInfo> methods = make_methods();
    return methods;
}

const MethodInfo* find_method(const std::string& id) {
    return find_by_id(all_methods(), id);
}

}  // namespace sheer
