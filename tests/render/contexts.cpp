#include <cstdlib>

#include "tests/render/render_test.h"

namespace sheer::test {

std::vector<std::string> contexts() {
    std::vector<std::string> all = {"egl", "osmesa"};
    if (std::getenv("DISPLAY") != nullptr) all.emplace_back("glfw");
    return all;
}

}  // namespace sheer::test
