#include "renderer/compare/compare.h"

#include <fmt/format.h>

#include <map>

#include "renderer/compare/change.h"
#include "renderer/compare/contenders.h"
#include "renderer/compare/looks.h"
#include "renderer/compare/opacity.h"
#include "renderer/compare/progress.h"
#include "renderer/compare/workbench.h"
#include "renderer/counting/loop_check.h"
#include "renderer/counting/needed.h"
#include "renderer/counting/nothing_drawn.h"

namespace sheer {

namespace {

/// Throws SpecError if the user's own shading has loops that do not end, in any method that draws with it.
void check_all_loops(const Spec& spec, const Looks& looks, const Target& target, Workbench& bench) {
    for (const MethodSpec& method : spec.methods) {
        Scene& scene = *looks.of(method).scene;
        check_loops_of(method.label, bench.gl(), scene,
                       [&] { bench.render(*bench.make_method(method, scene, target), false); });
    }
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

/// Counts made so far, by the scene in a look and the threshold: on nothing else do the needed fragments depend.
using KnownNeeded = std::map<std::pair<const Scene*, float>, NeededFragments>;

void count_needed_by(const MethodSpec& method, const Scene& scene, const Target& target, KnownNeeded& known,
                     Workbench& bench, const Run& run, FragmentCounts& fragments) {
    const std::optional<double> saturation = find_method(method.id)->saturation_of(method.parameters);
    if (!saturation) {
        fragments.needed = run.overdraw;
        return;
    }
    fragments.no_needed_reason = why_needed_is_unknown(scene, run.overdraw);
    if (!fragments.no_needed_reason.empty()) return;
    const std::pair key(&scene, static_cast<float>(*saturation));
    if (!known.contains(key))
        bench.frame(false, [&](gl::FrameTimer& timer) {
            known[key] = count_needed(bench.gl(), scene, target, key.second, timer);
        });
    fragments.needed = known[key].needed;
    fragments.saturation = known[key].saturation;
}

void count_fragments(const Looks& looks, const Target& target, EarlyTests& early_tests, Contenders& contenders,
                     Workbench& bench, const Run& run) {
    KnownNeeded needed;
    contenders.for_each(
        counting_begin, metrics_begin, "counting the fragments of", [&](Method& method, MethodResult& result) {
            Scene& scene = *looks.of(result.method).scene;
            FragmentCounts& fragments = result.fragments;
            static_cast<ShadingCount&>(fragments) =
                count_shaded(bench.gl(), scene, target, early_tests, [&] { bench.render(method, false); });
            fragments.reads = scene.reads_of_fragment();
            count_needed_by(result.method, scene, target, needed, bench, run, fragments);
        });
}

/// While the methods exist, since they are rendered over other backgrounds; one at a time, to keep few pictures in
/// memory.
void measure(const Looks& looks, Target& target, Contenders& contenders, Workbench& bench) {
    contenders.for_each(metrics_begin, 1, "measuring", [&](Method& method, MethodResult& result) {
        const Look& look = looks.of(result.method);
        const Run& run = *look.run;
        result.no_metrics_reason = find_method(result.method.id)->no_metrics_reason;
        if (result.no_metrics_reason.empty() && run.reference_status != report::ResultStatus::ok)
            result.no_metrics_reason = fmt::format("the reference {} is {}: {}", run.reference.id,
                                                   word_of(run.reference_status), run.reference_reason);
        if (!result.no_metrics_reason.empty()) return;
        const Backdrops over = bench.over_backdrops(method, target, result.image);
        result.opacity = opacity_of(over);
        const std::vector<Image8> frames = bench.frames(method, target);
        result.metrics = compute_metrics(run.reference_image, result.image,
                                         {.reference_over = &look.reference_over,
                                          .test_over = &over,
                                          .reference_as_shown = &run.reference_as_shown,
                                          .test_frames = &frames});
        if (!look.changes.empty()) result.own_reference = run.reference_as_shown;
    });
}

/// One point of the sweep: each stage, in order, fills in its part of the run.
Run compare_point(const Spec& spec, const SweepPoint& point, gl::Context& context, AssetReader& assets,
                  const ProgressFunction& progress, const UndecidedFunction& is_undecided, const RunFunction& early) {
    Run run;
    run.point = point;
    run.image = spec.image;
    Workbench bench(spec, context, progress, run.notes);
    EarlyTests early_tests(context);
    bench.tell(0, 0, 0, 1, "building the scene");
    const Geometry geometry = build_geometry_of_looks(spec, assets);
    Looks looks(spec, context.gl(), geometry);
    bench.check("building the scene");
    run.notes = geometry.notes;
    run.files = source_files_of(spec, assets);

    looks.render_references(spec, bench, run);
    Target target(context.gl(), spec.image, spec.image.format);
    look_for_something(spec, looks.own_scene(), geometry, target, bench, run);
    check_all_loops(spec, looks, target, bench);

    Contenders contenders(spec, looks, target, bench, run);
    contenders.make();
    if (early) early(run);
    compare_with_counterparts(run);
    contenders.prepare_sorting(geometry);
    contenders.time(is_undecided);
    count_fragments(looks, target, early_tests, contenders, bench, run);
    contenders.for_each(metrics_begin, metrics_begin, "asking",
                        [&](Method& method, MethodResult& result) { result.findings = bench.findings(method); });
    measure(looks, target, contenders, bench);
    return run;
}

}  // namespace

Device describe_device(const gl::Context& context) {
    return {context.device(), context.workarounds().names()};
}

void compare(const Spec& spec, gl::Context& context, AssetReader& assets, const ProgressFunction& progress,
             const RunFunction& take, const UndecidedFunction& is_undecided, const RunFunction& early) {
    const double share = 1.0 / static_cast<double>(spec.points.size());
    double begin = 0;
    for (const SweepPoint& point : spec.points) {
        const std::string where = describe_point(point);
        const ProgressFunction point_progress = [&](double fraction, const std::string& stage) {
            progress(begin + fraction * share, where.empty() ? stage : where + ": " + stage);
        };
        take(compare_point(spec_at(spec, point), point, context, assets, point_progress, is_undecided, early));
        begin += share;
    }
}

}  // namespace sheer
