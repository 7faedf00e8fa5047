#include "renderer/compare/shading_check.h"

#include "renderer/scene/scene.h"

namespace sheer {

std::string compile_shading(gl::Context& context, const std::string& glsl) {
    constexpr const char* main_source =
        "layout(location = 0) out vec4 o_color;\n"
        "void main() {\n"
        "    begin_fragment();\n"
        "    o_color = real_work(v_uv, v_tint);\n"
        "}\n";
    Geometry geometry;
    geometry.add_rect(0, 0, 1, 1, 0.5f, {1, 1, 1, 0.5f}, false);
    try {
        const Scene scene(context.gl(), geometry,
                          {{"shading", {{"glsl", glsl}}}, {"texture", {{"image", "leaf"}, {"size", 1}}}});
        scene.make_program("check of the shading", main_source);
        context.check("compiling the shading");
        return "";
    } catch (const SpecError& error) {
        return error.errors().front().detail;
    }
}

}  // namespace sheer
