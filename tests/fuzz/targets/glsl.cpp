#include "renderer/glsl/own_shading.h"
#include "tests/fuzz/target.h"

namespace sheer::test {

namespace {

/// Lines of the function are those of the text, or the driver's errors would name others.
void read_glsl(std::string_view input) {
    const auto lines = [](std::string_view text) {
        std::size_t count = 0;
        for (const char c : text) count += c == '\n';
        return count;
    };
    read_or_refuse<GlslError>([&] {
        const GlslShading shading = make_glsl_shading(std::string(input));
        require(lines(shading.function) >= lines(input), "a function that lacks lines");
    });
    user_messages(std::string(input));
}

}  // namespace

FuzzTarget fuzz_glsl() {
    return {"glsl", read_glsl};
}

}  // namespace sheer::test
