#include <array>

#include "renderer/gl/context_kinds.h"

namespace sheer::gl {
namespace {

constexpr std::array all_kinds{
    Kind{"egl", egl_candidates, true},
    Kind{"osmesa", osmesa_candidates, true},
    Kind{"glfw", glfw_candidates, false},
};

}  // namespace

std::unique_ptr<Context> create_context(const ContextRequest& request) {
    return create_context(request, all_kinds);
}

std::unique_ptr<Context> open_device(const ContextRequest& request) {
    return open_device(request, all_kinds);
}

void require_sound_window() {
    ContextRequest request;
    request.context = "glfw";
    require_sound(request, all_kinds);
}

std::vector<ListedDevice> list_devices() {
    return list_devices(all_kinds);
}

}  // namespace sheer::gl
