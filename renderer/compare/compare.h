#pragma once
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "renderer/counting/shading_counter.h"
#include "renderer/gl/context.h"
#include "renderer/gl/timer.h"
#include "renderer/image/image.h"
#include "renderer/image/pixel_counts.h"
#include "renderer/metrics/shared/metric.h"
#include "renderer/results/report.h"
#include "renderer/scene/assets.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/spec.h"

namespace sheer {

/// The fragments that a method shaded, and those that it needed to shade. Counted in separate, untimed frames.
struct FragmentCounts : ShadingCount {
    std::optional<PixelCounts> needed;  ///< fragments until the transmittance is under the method's threshold
    std::string no_needed_reason;
    std::optional<PixelCounts>
        saturation;            ///< the fragment that saturated the pixel, from 1; of methods with a threshold
    std::optional<int> reads;  ///< of textures by each shaded fragment
};

/// The picture of a method with its own look, compared with the same method's without it.
struct PictureChange {
    std::string from;  ///< label of the other one
    bool is_identical = false;
    Metrics metrics;
};

/// The GPU's clock while a method was timed.
struct ClockLog {
    std::vector<unsigned> sm_mhz;  ///< after each timed frame; empty if there is nothing that tells it
    int retaken = 0;               ///< frames that were timed again as the clock was lowered
    std::set<std::string> lowered_by;
};

/// The result of one method at one point.
struct MethodResult {
    MethodSpec method;
    report::ResultStatus status = report::ResultStatus::ok;
    std::string reason;  ///< why it is not ok
    Image image;
    std::vector<gl::FrameSample> samples;  ///< every timed frame, in the order of the rounds
    ClockLog clock;
    bool sorts = false;  ///< it draws in depth order
    std::vector<double>
        sort_ms;  ///< wall time of sorting for each of these frames (DepthSort); empty if there was none
    std::optional<Metrics> metrics;  ///< absent if the method has none
    std::string no_metrics_reason;
    std::optional<PictureChange> change;  ///< only if the method has its own look
    std::string no_change_reason;
    Image own_reference;            ///< of a method with its own look: the reference in that look, as shown
    Image8 opacity;                 ///< see opacity_of(); empty if it has no metrics
    std::int64_t memory_bytes = 0;  ///< GL objects that the method made for its own use
    FragmentCounts fragments;
    nlohmann::json findings = nlohmann::json::object();  ///< see Method::findings
    std::vector<Note> notes;                             ///< reasons why this result is not as intended
};

/// One point of the sweep.
struct Run {
    SweepPoint point = nlohmann::json::object();
    ImageSpec image;
    MethodSpec reference;
    report::ResultStatus reference_status = report::ResultStatus::ok;  ///< without a reference nothing has metrics
    std::string reference_reason;                                      ///< why it is not ok
    Image reference_image;                                             ///< in 32-bit floats
    Image reference_as_shown;  ///< the same, rounded by the device to the format that the methods blend into
    Image8 reference_opacity;  ///< see opacity_of()
    /// The error of that rounding alone: `reference_as_shown` compared with `reference_image`. Absent if the reference
    /// has no metrics.
    std::optional<Metrics> format_cost;
    std::optional<double> residual;  ///< greatest difference of the two references, in 0..1
    std::string no_residual_reason;
    nlohmann::json reference_findings = nlohmann::json::object();  ///< see Method::findings
    std::vector<MethodResult> results;                             ///< in the order of the spec's methods
    PixelCounts overdraw;  ///< transparent fragments that opaque geometry does not hide
    /// Frames of a second instance of the baseline, in the same rounds; none if the baseline cannot run.
    std::vector<gl::FrameSample> baseline_again;
    std::vector<double> baseline_again_sort_ms;  ///< as MethodResult::sort_ms
    std::string no_sort_reason;                  ///< why no sorting was timed although a method sorts
    std::string nothing_drawn;  ///< why there is nothing to compare, a sentence; "" if there is something
    int rounds_done = 0;
    int looks = 0;  ///< how often the times were judged to see whether more rounds are needed; 0 if they never are
    std::vector<Note> notes;        ///< on the scene and its files
    std::vector<SourceFile> files;  ///< from which the scene is made
};

/// The device and context of a comparison.
struct Device {
    gl::DeviceInfo info;
    std::vector<std::string> workarounds;
};
Device describe_device(const gl::Context& context);

/// Reports the progress of a comparison. Called from the rendering thread. An exception from it ends the comparison.
using ProgressFunction = std::function<void(double fraction, const std::string& stage)>;
/// Takes a run: each finished one, whose pictures are freed afterwards, as those of a whole sweep would not fit in
/// memory.
using RunFunction = std::function<void(const Run& run)>;
/// Whether a check on a time of this run, whose times are those of the rounds so far, is undecided.
using UndecidedFunction = std::function<bool(const Run& run)>;

/// At every point of the sweep, renders every method of the spec and the reference, times the methods, and measures the
/// differences.
///
/// If this device cannot run a method or the reference, or one fails in any stage, it is reported as `unsupported` or
/// `failed` with the reason, and the others go on; the baseline must run twice. Throws RenderError if rendering fails
/// as a whole: the scene cannot be made, or the device is lost (ContextLost). Throws SpecError for a file of the spec
/// that `assets` cannot read, and if the user's own shading does not compile.
///
/// `early` gets each run when its pictures are drawn and nothing is timed yet. While `is_undecided` says so, the rounds
/// are doubled, as long as the spec's time allows; without this function the spec's rounds are all.
void compare(const Spec& spec, gl::Context& context, AssetReader& assets, const ProgressFunction& progress,
             const RunFunction& take, const UndecidedFunction& is_undecided = {}, const RunFunction& early = {});

}  // namespace sheer
