#include <array>
#include <stdexcept>

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

std::vector<ListedDevice> list_devices() {
    std::vector<ListedDevice> all;
    for (const Kind& kind : all_kinds) {
        for (const Candidate& candidate : kind.candidates()) {
            try {
                all.push_back({candidate.create(candidate.info, {})->device(), std::nullopt});
            } catch (const std::runtime_error& error) {
                all.push_back({candidate.info, error.what()});
            }
        }
    }
    return all;
}

}  // namespace sheer::gl
