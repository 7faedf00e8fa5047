#pragma once
#include "tests/render/render_test.h"

namespace sheer::test {

/// How many fragments of a frame pass every test and discard, in all passes together. The second frame is counted,
/// because the first one may do more.
inline std::int64_t samples_of_frame(gl::Context& context, Stage& stage, Method& method) {
    const gl::Functions& gl = context.gl();
    const gl::Query query = gl::make_query(gl, "samples", GL_SAMPLES_PASSED);
    stage.frame(method);
    gl.BeginQuery(GL_SAMPLES_PASSED, query.id());
    stage.frame(method);
    gl.EndQuery(GL_SAMPLES_PASSED);
    GLuint samples = 0;
    gl.GetQueryObjectuiv(query.id(), GL_QUERY_RESULT, &samples);
    return samples;
}

/// A layer over the whole picture.
inline nlohmann::json full_layer(double depth, const std::array<double, 3>& color, double alpha, bool opaque = false) {
    return {{"rect", {0, 0, 1, 1}}, {"depth", depth}, {"color", color}, {"alpha", alpha}, {"opaque", opaque}};
}

inline nlohmann::json layers_scene(const nlohmann::json& layers) {
    return {{"type", "layers"}, {"layers", layers}};
}

}  // namespace sheer::test
