// In place of renderer/gl/all_contexts.cpp and tests/render/contexts.cpp, on a host whose only library is EGL.
#include <array>

#include "renderer/gl/context_kinds.h"
#include "tests/render/render_test.h"

namespace sheer {

std::unique_ptr<gl::Context> gl::create_context(const ContextRequest& request) {
    const std::array kinds{Kind{"egl", egl_candidates, true}};
    return create_context(request, kinds);
}

std::vector<std::string> test::contexts() {
    return {"egl"};
}

}  // namespace sheer
