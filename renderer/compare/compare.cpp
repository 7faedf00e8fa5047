#include "renderer/compare/compare.h"

#include <fmt/format.h>

#include <map>

#include "renderer/compare/contenders.h"
#include "renderer/compare/progress.h"
#include "renderer/compare/reference.h"
#include "renderer/compare/workbench.h"
#include "renderer/counting/loop_check.h"
#include "renderer/counting/needed.h"
#include "renderer/counting/nothing_drawn.h"

namespace sheer {

namespace {

/// Throws SpecError if the user's own shading has loops that do not end, in any method that draws with it.
void check_all_loops(const Spec& spec, Scene& scene, const Target& target, Workbench& bench) {
    for (const MethodSpec& method : spec.methods)
        check_loops_of(method.label, bench.gl(), scene,
                       [&] { bench.render(*bench.make_method(method, scene, target), false); });
}

/// A comparison without transparent fragments must not look as if all methods agreed.
void look_for_something(const Spec& spec, const Scene& scene, const Geometry& geometry, const Target& target,
                        Workbench& bench, Run& run) {
    const SceneInfo& type = *find_scene(spec.scene_type);
    bench.frame(false, [&](gl::FrameTimer& timer) {
        run.nothing_drawn = why_nothing_is_drawn(bench.gl(), scene, geometry, type, target, run.overdraw, timer);
    });
    bench.check("looking for transparent fragments");
    if (!run.nothing_drawn.empty()) add_note(run.notes, {"nothing-transparent", run.nothing_drawn, "/scene"});
}

/// The fragments that a method needs depend only on its threshold: `known` has the counts made so far.
void count_needed_by(const MethodSpec& method, const Scene& scene, const Target& target,
                     std::map<float, NeededFragments>& known, Workbench& bench, const Run& run,
                     FragmentCounts& fragments) {
    const std::optional<double> saturation = find_method(method.id)->saturation_of(method.parameters);
    if (!saturation) {
        fragments.needed = run.overdraw;
        return;
    }
    fragments.no_needed_reason = why_needed_is_unknown(scene, run.overdraw);
    if (!fragments.no_needed_reason.empty()) return;
    const auto threshold = static_cast<float>(*saturation);
    if (!known.contains(threshold))
        bench.frame(false, [&](gl::FrameTimer& timer) {
            known[threshold] = count_needed(bench.gl(), scene, target, threshold, timer);
        });
    fragments.needed = known[threshold].needed;
    fragments.saturation = known[threshold].saturation;
}

void count_fragments(Scene& scene, const Target& target, EarlyTests& early_tests, Contenders& contenders,
                     Workbench& bench, const Run& run) {
    std::map<float, NeededFragments> needed;
    contenders.for_each(
        counting_begin, metrics_begin, "counting the fragments of", [&](Method& method, MethodResult& result) {
            FragmentCounts& fragments = result.fragments;
            static_cast<ShadingCount&>(fragments) =
                count_shaded(bench.gl(), scene, target, early_tests, [&] { bench.render(method, false); });
            count_needed_by(result.method, scene, target, needed, bench, run, fragments);
        });
}

/// While the methods exist, since they are rendered over other backgrounds; one at a time, to keep few pictures in
/// memory.
void measure(const Backdrops& reference_over, Target& target, Contenders& contenders, Workbench& bench,
             const Run& run) {
    contenders.for_each(metrics_begin, 1, "measuring", [&](Method& method, MethodResult& result) {
        result.no_metrics_reason = find_method(result.method.id)->no_metrics_reason;
        if (result.no_metrics_reason.empty() && run.reference_status != report::ResultStatus::ok)
            result.no_metrics_reason = fmt::format("the reference {} is {}: {}", run.reference.id,
                                                   word_of(run.reference_status), run.reference_reason);
        if (!result.no_metrics_reason.empty()) return;
        const Backdrops over = bench.over_backdrops(method, target, result.image);
        result.metrics =
            compute_metrics(run.reference_image, result.image, &reference_over, &over, &run.reference_as_shown);
    });
}

/// One point of the sweep: each stage, in order, fills in its part of the run.
Run compare_point(const Spec& spec, gl::Context& context, AssetReader& assets, const ProgressFunction& progress) {
    Run run;
    Workbench bench(spec, context, progress, run.notes);
    EarlyTests early_tests(context);
    bench.tell(0, 0, 0, 1, "building the scene");
    const Geometry geometry = build_geometry(spec.scene, spec.image, assets);
    Scene scene(context.gl(), geometry, spec.scene);
    check_loops(context.gl(), scene, spec.image);
    bench.check("building the scene");
    run.notes = geometry.notes;
    run.files = source_files(spec.scene, assets);

    const Backdrops reference_over = render_reference(spec, scene, bench, run);
    Target target(context.gl(), spec.image, spec.image.format);
    look_for_something(spec, scene, geometry, target, bench, run);
    check_all_loops(spec, scene, target, bench);

    Contenders contenders(spec, scene, target, bench, run);
    contenders.make();
    contenders.prepare_sorting(geometry);
    contenders.time();
    count_fragments(scene, target, early_tests, contenders, bench, run);
    contenders.for_each(metrics_begin, metrics_begin, "asking",
                        [&](Method& method, MethodResult& result) { result.findings = bench.findings(method); });
    measure(reference_over, target, contenders, bench, run);
    return run;
}

}  // namespace

Device describe_device(const gl::Context& context) {
    return {context.device(), context.workarounds().names()};
}

void compare(const Spec& spec, gl::Context& context, AssetReader& assets, const ProgressFunction& progress,
             const RunFunction& take) {
    const double share = 1.0 / static_cast<double>(spec.points.size());
    double begin = 0;
    for (const SweepPoint& point : spec.points) {
        const std::string where = describe_point(point);
        const ProgressFunction point_progress = [&](double fraction, const std::string& stage) {
            progress(begin + fraction * share, where.empty() ? stage : where + ": " + stage);
        };
        const Spec point_spec = spec_at(spec, point);
        Run run = compare_point(point_spec, context, assets, point_progress);
        run.point = point;
        run.image = point_spec.image;
        take(run);
        begin += share;
    }
}

}  // namespace sheer
