#pragma once
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/frame/image.h"
#include "renderer/frame/pixel_counts.h"
#include "renderer/frame/shading_counter.h"
#include "renderer/gl/context.h"
#include "renderer/gl/timer.h"
#include "renderer/metrics/metric.h"
#include "renderer/scene/assets.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/spec.h"

namespace sheer {

/// What a method shaded, and what it had to. Counted in frames of their own, none of which is timed.
struct FragmentCounts : ShadingCount {
    std::optional<PixelCounts> needed;  ///< fragments before the transmittance is under the method's threshold
    std::string no_needed_reason;
    std::optional<PixelCounts> saturation;  ///< the fragment that saturated the pixel, from 1; methods with a threshold
};

/// What one method gave at one point.
struct MethodResult {
    MethodSpec method;
    std::string status = "ok";  ///< ok, unsupported, failed
    std::string reason;         ///< why not ok
    Image image;
    std::vector<gl::FrameSample> samples;  ///< every timed frame, in the order of the rounds
    bool sorts = false;                    ///< it draws in an order of depths
    std::vector<double> sort_ms;           ///< wall time of sorting for each of these frames (DepthSort); empty: none
    std::optional<Metrics> metrics;        ///< absent where the method has none
    std::string no_metrics_reason;
    std::int64_t memory_bytes = 0;  ///< GL objects the method made for itself
    FragmentCounts fragments;
    nlohmann::json findings = nlohmann::json::object();  ///< see Method::findings
    std::vector<Note> notes;                             ///< what makes this result other than it was meant
};

/// One point of the sweep.
struct Run {
    SweepPoint point = nlohmann::json::object();
    ImageSpec image;
    MethodSpec reference;
    std::string reference_status = "ok";  ///< ok, unsupported, failed; without a reference nothing has metrics
    std::string reference_reason;         ///< why not ok
    Image reference_image;                ///< in 32-bit floats
    Image reference_as_shown;             ///< the same, rounded by the device to the format that the methods blend into
    /// What that rounding alone costs: of `reference_as_shown` against `reference_image`. Absent for a reference that
    /// has no metrics.
    std::optional<Metrics> format_cost;
    std::optional<double> residual;  ///< greatest difference of the two references, in 0..1
    std::string no_residual_reason;
    nlohmann::json reference_findings = nlohmann::json::object();  ///< see Method::findings
    std::vector<MethodResult> results;                             ///< in the order of the spec's methods
    PixelCounts overdraw;  ///< transparent fragments that opaque geometry does not hide
    /// Frames of a second instance of the baseline, in the same rounds; none where the baseline cannot run.
    std::vector<gl::FrameSample> baseline_again;
    std::vector<double> baseline_again_sort_ms;  ///< as MethodResult::sort_ms
    std::string no_sort_reason;                  ///< why no sorting was timed though a method sorts
    std::string nothing_drawn;                   ///< why there is nothing to compare, a sentence; "" where there is
    int rounds_done = 0;
    std::vector<Note> notes;        ///< of the scene and its files
    std::vector<SourceFile> files;  ///< that the scene is made from
};

/// What a comparison runs on.
struct Device {
    gl::DeviceInfo info;
    std::vector<std::string> workarounds;
};
Device describe_device(const gl::Context& context);

/// How far a comparison is. Called from the rendering thread; may throw Cancelled.
using ProgressFunction = std::function<void(double fraction, const std::string& stage)>;
/// Takes a run when it is finished. Its pictures are freed afterwards: those of a whole sweep would not fit.
using RunFunction = std::function<void(const Run& run)>;

/// At every point of the sweep: renders every method of the spec and its reference, times them, and measures the
/// difference.
///
/// A method, or the reference, that this device cannot run or that fails in any stage is reported as `unsupported` or
/// `failed` with the reason, and the others go on; the baseline must run twice. Throws RenderError if rendering fails
/// as a whole: the scene cannot be made, or the device is lost (ContextLost). Throws SpecError for a file of the spec
/// that `assets` cannot read, and for shading of the user's own that does not compile.
void compare(const Spec& spec, gl::Context& context, AssetReader& assets, const ProgressFunction& progress,
             const RunFunction& take);

}  // namespace sheer
