#include "renderer/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>

#include "renderer/frame/depth_peeler.h"
#include "renderer/frame/loop_check.h"
#include "renderer/frame/needed.h"
#include "renderer/frame/overdraw.h"
#include "renderer/methods/method.h"
#include "renderer/number_text.h"
#include "renderer/scene/random.h"

namespace sheer {

namespace {

/// Fractions of the job at which each stage begins, for the progress bar.
constexpr double references_begin = 0.05, methods_begin = 0.15, timing_begin = 0.3, counting_begin = 0.8,
                 metrics_begin = 0.9;

/// The stages of one point; each fills in its part of the run.
class Comparer {
  public:
    Comparer(const Spec& spec, gl::Context& context, AssetReader& assets, const ProgressFunction& progress)
        : m_spec(spec),
          m_context(context),
          m_assets(assets),
          m_progress(progress),
          m_timer(context),
          m_early_tests(context) {}

    Run run() {
        m_progress(0, "building the scene");
        const Geometry geometry = build_geometry(m_spec.scene, m_spec.image, m_assets);
        Scene scene(m_context.gl(), geometry, m_spec.scene);
        check_loops(m_context.gl(), scene, m_spec.image);
        Run run;
        run.notes = geometry.notes;
        run.files = source_files(m_spec.scene, m_assets);
        render_reference(scene, run);
        Target target(m_context.gl(), m_spec.image, m_spec.image.format);
        make_methods(scene, target, run);
        time_methods(run);
        count_fragments(scene, target, run);
        ask_methods();
        measure(target, run);
        m_contenders.clear();
        return run;
    }

  private:
    struct Contender {
        std::unique_ptr<Method> method;
        std::vector<gl::FrameSample>* samples;
        MethodResult* result;  ///< null for the second instance of the baseline
    };

    gl::FrameSample render(Method& method, bool timed) {
        m_timer.begin_frame(timed);
        try {
            method.render(m_timer);
        } catch (...) {
            m_timer.end_frame();
            throw;
        }
        return m_timer.end_frame();
    }

    std::unique_ptr<Method> make_method(const MethodSpec& spec, const Scene& scene, const Target& target) {
        return find_method(spec.id)->make({m_context, m_context.gl(), scene, target, spec.parameters});
    }

    Image picture(const MethodSpec& spec, const Scene& scene, const Target& target) {
        const auto method = make_method(spec, scene, target);
        render(*method, false);
        Image image = target.read();
        m_context.check("rendering " + spec.id);
        return image;
    }

    /// What the method makes of another background. `own` is its picture over that of the spec.
    Image over_background(const std::array<float, 3>& background, Method& method, Target& target, const Image& own) {
        if (background == m_spec.image.background) return own;
        target.set_background(background);
        method.restart();
        render(method, false);
        Image image = target.read();
        target.set_background(m_spec.image.background);
        return image;
    }

    Backdrops over_backdrops(Method& method, Target& target, const Image& own) {
        return {over_background({0, 0, 0}, method, target, own), over_background({1, 1, 1}, method, target, own)};
    }

    /// References are rendered in 32-bit floats, whatever the methods blend into.
    void render_reference(const Scene& scene, Run& run) {
        m_progress(references_begin, "rendering the reference " + m_spec.reference.id);
        Target target(m_context.gl(), m_spec.image, PixelFormat::rgba32f);
        run.reference = m_spec.reference;
        {
            const auto reference = make_method(m_spec.reference, scene, target);
            render(*reference, false);
            run.reference_image = target.read();
            m_reference_over = over_backdrops(*reference, target, run.reference_image);
            run.reference_findings = findings(*reference);
            m_context.check("rendering " + m_spec.reference.id);
        }
        check_reference(scene, target, run);
    }

    /// Against depth peeling, which shares nothing with the lists.
    void check_reference(const Scene& scene, const Target& target, Run& run) {
        m_timer.begin_frame(false);
        run.overdraw = count_overdraw(m_context.gl(), scene, target, m_timer);
        m_timer.end_frame();
        const double peeled = peeled_fragments(run.overdraw);
        if (peeled > max_peeled_fragments) {
            run.no_residual_reason = fmt::format("depth peeling would draw {} fragments; the limit is {}",
                                                 number_text(peeled), number_text(max_peeled_fragments));
            return;
        }
        m_progress(references_begin, "checking the reference against depth peeling");
        const Image peeled_image = picture({"depth_peeling", "", nlohmann::json::object()}, scene, target);
        double greatest = 0;
        for (std::size_t i = 0; i < peeled_image.rgba.size(); ++i)
            if (i % 4 != 3)
                greatest = std::max(greatest, std::abs(double{peeled_image.rgba[i]} - run.reference_image.rgba[i]));
        run.residual = greatest;
    }

    std::unique_ptr<Method> make_warm(const MethodSpec& spec, const Scene& scene, const Target& target) {
        auto method = make_method(spec, scene, target);
        for (int frame = 0; frame < m_spec.timing.warmup; ++frame) render(*method, false);
        return method;
    }

    /// Renders each method until it is warm, and keeps its picture. The baseline is made twice: how far it is from
    /// itself is the noise that every other difference is seen against.
    void make_methods(const Scene& scene, const Target& target, Run& run) {
        run.results.resize(m_spec.methods.size());
        for (std::size_t i = 0; i < run.results.size(); ++i) {
            MethodResult& result = run.results[i];
            result.method = m_spec.methods[i];
            step(methods_begin, timing_begin, i, run.results.size(), "warming up " + result.method.label);
            try {
                auto method = make_warm(result.method, scene, target);
                result.image = target.read();
                result.memory_bytes = method->memory_bytes();
                m_context.check("rendering " + result.method.label);
                m_contenders.push_back({std::move(method), &result.samples, &result});
                if (result.method.label == m_spec.baseline)
                    m_contenders.push_back({make_warm(result.method, scene, target), &run.baseline_again, nullptr});
            } catch (const Unsupported& unsupported) {
                result.status = "unsupported";
                result.reason = unsupported.what();
            }
        }
    }

    /// Rounds in which every method renders one frame, in an order that is drawn anew: neighbours in time share the
    /// machine's mood, and no method always follows the same other one. No round is begun that would go over the time,
    /// if it took as long as the longest yet.
    void time_methods(Run& run) {
        using Clock = std::chrono::steady_clock;
        const auto begin = Clock::now();
        double done_s = 0, longest_s = 0;
        Random random(1);
        std::vector<std::size_t> order(m_contenders.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        for (int round = 0; round < m_spec.timing.rounds; ++round) {
            if (round > 0 && done_s + longest_s > m_spec.timing.max_seconds) break;
            step(timing_begin, counting_begin, static_cast<std::size_t>(round),
                 static_cast<std::size_t>(m_spec.timing.rounds),
                 fmt::format("timing round {} of {}", round + 1, m_spec.timing.rounds));
            for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
            for (const std::size_t i : order) m_contenders[i].samples->push_back(render(*m_contenders[i].method, true));
            const double now_s = std::chrono::duration<double>(Clock::now() - begin).count();
            longest_s = std::max(longest_s, now_s - done_s);
            done_s = now_s;
            run.rounds_done = round + 1;
        }
        m_context.check("timing");
    }

    void count_fragments(Scene& scene, const Target& target, Run& run) {
        std::map<float, NeededFragments> needed;
        for (std::size_t i = 0; i < m_contenders.size(); ++i) {
            const Contender& contender = m_contenders[i];
            if (!contender.result) continue;
            const std::string& label = contender.result->method.label;
            step(counting_begin, metrics_begin, i, m_contenders.size(), "counting the fragments of " + label);
            FragmentCounts& fragments = contender.result->fragments;
            static_cast<ShadingCount&>(fragments) =
                count_shaded(m_context.gl(), scene, target, m_early_tests, [&] { render(*contender.method, false); });
            count_needed_by(contender.result->method, scene, target, run.overdraw, needed, fragments);
            m_context.check("counting the fragments of " + label);
        }
    }

    void ask_methods() {
        for (const Contender& contender : m_contenders) {
            if (!contender.result) continue;
            contender.result->findings = findings(*contender.method);
        }
        m_context.check("the methods' findings");
    }

    nlohmann::json findings(Method& method) {
        m_timer.begin_frame(false);
        nlohmann::json found = method.findings(m_timer);
        m_timer.end_frame();
        return found;
    }

    /// `known` holds what has been counted already, by threshold.
    void count_needed_by(const MethodSpec& method, const Scene& scene, const Target& target,
                         const PixelCounts& overdraw, std::map<float, NeededFragments>& known,
                         FragmentCounts& fragments) {
        if (!method.parameters.contains("threshold")) {
            fragments.needed = overdraw;
            return;
        }
        fragments.no_needed_reason = why_needed_is_unknown(scene, overdraw);
        if (!fragments.no_needed_reason.empty()) return;
        const auto threshold = method.parameters.at("threshold").get<float>();
        if (!known.contains(threshold)) {
            m_timer.begin_frame(false);
            known[threshold] = count_needed(m_context.gl(), scene, target, threshold, m_timer);
            m_timer.end_frame();
        }
        fragments.needed = known[threshold].needed;
        fragments.saturation = known[threshold].saturation;
    }

    /// While the methods live, since they are rendered over other backgrounds: one at a time, to hold few pictures.
    void measure(Target& target, Run& run) {
        for (std::size_t i = 0; i < m_contenders.size(); ++i) {
            if (!m_contenders[i].result) continue;
            MethodResult& result = *m_contenders[i].result;
            const auto say = [&](const char* what) {
                step(metrics_begin, 1, i, m_contenders.size(), what + result.method.label);
            };
            result.no_metrics_reason = find_method(result.method.id)->no_metrics_reason;
            if (!result.no_metrics_reason.empty()) continue;
            say("rendering over other backgrounds ");
            const Backdrops over = over_backdrops(*m_contenders[i].method, target, result.image);
            say("measuring ");
            result.metrics = compute_metrics(run.reference_image, result.image, &m_reference_over, &over);
        }
        m_context.check("rendering over other backgrounds");
    }

    void step(double from, double to, std::size_t index, std::size_t count, const std::string& stage) const {
        m_progress(from + (to - from) * static_cast<double>(index) / static_cast<double>(count), stage);
    }

    const Spec& m_spec;
    gl::Context& m_context;
    AssetReader& m_assets;
    const ProgressFunction& m_progress;
    gl::FrameTimer m_timer;
    EarlyTests m_early_tests;
    std::vector<Contender> m_contenders;
    Backdrops m_reference_over;
};

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
        Run run = Comparer(point_spec, context, assets, point_progress).run();
        run.point = point;
        run.image = point_spec.image;
        take(run);
        begin += share;
    }
}

}  // namespace sheer
