#include "renderer/compare/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/compare/opacity.h"
#include "renderer/compare/progress.h"
#include "renderer/core/number_text.h"
#include "renderer/passes/depth_peeler.h"
#include "renderer/passes/float_opaque.h"
#include "renderer/passes/overdraw.h"

namespace sheer {

namespace {

/// The error of rounding to the format of the methods' target alone.
void round_reference(const Spec& spec, const Backdrops& reference_over, Workbench& bench, Run& run) {
    const auto rounded = [&](const Image& image) { return rounded_to(spec.image.format, bench.gl(), image); };
    run.reference_as_shown = rounded(run.reference_image);
    const Backdrops over = {rounded(reference_over.black), rounded(reference_over.white)};
    run.format_cost = compute_metrics(run.reference_image, run.reference_as_shown,
                                      {.reference_over = &reference_over, .test_over = &over});
    run.format_cost->pictures.clear();
}

/// Greatest difference of two pictures of the same size, over red, green and blue.
double greatest_difference(const Image& a, const Image& b) {
    double greatest = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        if (i % 4 != 3) greatest = std::max(greatest, std::abs(double{a.rgba[i]} - b.rgba[i]));
    return greatest;
}

void check_by_peeling(const Scene& scene, const Target& target, Workbench& bench, Run& run) {
    const double peeled = peeled_fragments(run.overdraw);
    if (peeled > max_peeled_fragments) {
        run.no_residual_reason = fmt::format("depth peeling would draw {} fragments; the limit is {}",
                                             number_text(peeled), number_text(max_peeled_fragments));
        return;
    }
    const std::string doing = "checking the reference against depth peeling";
    bench.tell(references_begin, references_begin, 0, 1, doing);
    const auto trouble = bench.attempt(doing, [&] {
        const auto peeler = bench.make_method({"depth_peeling", "", nlohmann::json::object()}, scene, target);
        bench.render(*peeler, false);
        run.residual = greatest_difference(target.read(), run.reference_image);
    });
    if (!trouble) return;
    run.residual.reset();
    run.no_residual_reason = trouble->reason;
}

void forget_reference(const Trouble& trouble, Run& run) {
    run.reference_status = trouble.status;
    run.reference_reason = run.no_residual_reason = trouble.reason;
    run.reference_image = run.reference_as_shown = {};
    run.reference_opacity = {};
    run.format_cost.reset();
    run.reference_findings = nlohmann::json::object();
}

}  // namespace

Backdrops render_reference(const Spec& spec, const Scene& scene, Workbench& bench, Run& run) {
    const std::string doing = "rendering the reference " + spec.reference.id;
    bench.tell(references_begin, references_begin, 0, 1, doing);
    Target target(bench.gl(), spec.image, PixelFormat::rgba32f);
    run.reference = spec.reference;
    bench.frame(false, [&](gl::FrameTimer& timer) { run.overdraw = count_overdraw(bench.gl(), scene, target, timer); });
    bench.check("counting the fragments");
    Backdrops over;
    const auto trouble = bench.attempt(doing, [&] {
        const auto reference = bench.make_method(spec.reference, scene, target);
        bench.render(*reference, false);
        run.reference_image = target.read();
        over = bench.over_backdrops(*reference, target, run.reference_image);
        run.reference_opacity = opacity_of(over);
        round_reference(spec, over, bench, run);
        run.reference_findings = bench.findings(*reference);
    });
    if (trouble) {
        forget_reference(*trouble, run);
    } else {
        check_by_peeling(scene, target, bench, run);
    }
    return over;
}

}  // namespace sheer
