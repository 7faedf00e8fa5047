#pragma once
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/frame/image.h"
#include "renderer/gl/context.h"
#include "renderer/gl/timer.h"
#include "renderer/metrics/metric.h"
#include "renderer/scene/assets.h"
#include "renderer/spec/spec.h"

namespace sheer {

/// What one method gave at one point.
struct MethodResult {
    MethodSpec method;
    std::string status = "ok";  ///< ok, unsupported, failed
    std::string reason;         ///< why not ok
    Image image;
    std::vector<gl::FrameSample> samples;  ///< every timed frame, in the order of the rounds
    std::optional<Metrics> metrics;        ///< absent where the method has none
    std::string no_metrics_reason;
    std::int64_t memory_bytes = 0;  ///< GL objects the method made for itself
};

/// One point of the sweep.
struct Run {
    nlohmann::json point = nlohmann::json::object();
    MethodSpec reference;
    Image reference_image;
    std::optional<double> residual;  ///< greatest difference of the two references, in 0..1
    std::string no_residual_reason;
    std::vector<MethodResult> results;  ///< in the order of the spec's methods
};

struct Comparison {
    gl::DeviceInfo device;
    std::vector<std::string> workarounds;
    std::vector<Run> runs;
};

/// How far a comparison is. Called from the rendering thread; may throw Cancelled.
using ProgressFunction = std::function<void(double fraction, const std::string& stage)>;

/// Renders every method of the spec and its reference, times them, and measures the difference.
/// A method that this device cannot run is reported as unsupported. Throws RenderError if rendering fails as a whole.
/// Throws SpecError for a file of the spec that `assets` cannot read.
Comparison compare(const Spec& spec, gl::Context& context, AssetReader& assets, const ProgressFunction& progress);

}  // namespace sheer
