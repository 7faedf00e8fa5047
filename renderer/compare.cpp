#include "renderer/compare.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <new>
#include <numeric>

#include "renderer/frame/depth_peeler.h"
#include "renderer/frame/float_opaque.h"
#include "renderer/frame/loop_check.h"
#include "renderer/frame/needed.h"
#include "renderer/frame/nothing_drawn.h"
#include "renderer/frame/overdraw.h"
#include "renderer/methods/method.h"
#include "renderer/number_text.h"
#include "renderer/scene/depth_sort.h"
#include "renderer/scene/random.h"

namespace sheer {

namespace {

/// Fractions of the job at which each stage begins, for the progress bar.
constexpr double references_begin = 0.05, methods_begin = 0.15, timing_begin = 0.3, counting_begin = 0.8,
                 metrics_begin = 0.9;

/// Puts the spec's background back, also after a failure.
class OtherBackground {
  public:
    OtherBackground(Target& target, const std::array<float, 3>& other, const std::array<float, 3>& own)
        : m_target(target), m_own(own) {
        m_target.set_background(other);
    }
    ~OtherBackground() { m_target.set_background(m_own); }
    OtherBackground(const OtherBackground&) = delete;
    OtherBackground& operator=(const OtherBackground&) = delete;

  private:
    Target& m_target;
    const std::array<float, 3>& m_own;
};

/// How something did not go well that is no reason to stop.
struct Trouble {
    std::string status;  ///< unsupported, failed
    std::string reason;
};

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
        m_context.check("building the scene");
        m_run.notes = geometry.notes;
        m_run.files = source_files(m_spec.scene, m_assets);
        render_reference(scene);
        Target target(m_context.gl(), m_spec.image, m_spec.image.format);
        look_for_something(scene, geometry, target);
        for (const MethodSpec& method : m_spec.methods) check_loops_of(method, m_context, scene, target, m_timer);
        make_methods(scene, target);
        prepare_sorting(geometry);
        time_methods();
        count_fragments(scene, target);
        ask_methods();
        measure(target);
        m_contenders.clear();
        m_sort.reset();
        return std::move(m_run);
    }

  private:
    struct Contender {
        std::unique_ptr<Method> method;
        MethodResult* result;
        bool again;  ///< it is the second instance of the baseline, for whose result the first one answers

        std::vector<gl::FrameSample>& samples(Run& run) const { return again ? run.baseline_again : result->samples; }
        std::vector<double>& sort_ms(Run& run) const { return again ? run.baseline_again_sort_ms : result->sort_ms; }
    };

    /// Takes `step`; what goes wrong in it is no reason for anything else to stop, but what the caller asked for (an
    /// end, or shading that does not compile) and the end of the device are. `doing` says what it is, for the reason.
    template <typename Step>
    std::optional<Trouble> attempt(const std::string& doing, const Step& step) {
        try {
            step();
            m_context.check(doing);
            return std::nullopt;
        } catch (const Cancelled&) {
            throw;
        } catch (const SpecError&) {
            throw;
        } catch (const ContextLost&) {
            throw;
        } catch (const Unsupported& unsupported) {
            return after(doing, {"unsupported", unsupported.what()});
        } catch (const RenderError& error) {
            return after(doing, {"failed", error.what()});
        } catch (const std::bad_alloc&) {
            return after(doing, {"failed", "memory ran out"});
        } catch (const std::exception& error) {
            // What it says may name files and libraries of the host.
            spdlog::error("{}: {}", doing, error.what());
            return after(doing, {"failed", "an error within the renderer; its log says more"});
        }
    }

    /// Errors that are still kept belong to what failed, not to whoever comes next.
    Trouble after(const std::string& doing, Trouble trouble) {
        try {
            m_context.check(doing);
        } catch (const ContextLost&) {
            throw;
        } catch (const RenderError& error) {
            trouble.reason += fmt::format("; {}", error.what());
        }
        if (trouble.status == "failed" && !trouble.reason.starts_with(doing))
            trouble.reason = fmt::format("{}: {}", doing, trouble.reason);
        if (trouble.reason.find("GL_OUT_OF_MEMORY") != std::string::npos)
            add_note(m_run.notes, {"out-of-memory",
                                   "Memory ran out while " + doing +
                                       "; OpenGL does not promise what is drawn after that, so look at the pictures.",
                                   ""});
        return trouble;
    }

    /// The same for a step of one method, whose result then says what went wrong and nothing else.
    template <typename Step>
    bool attempt_for(MethodResult& result, const std::string& doing, const Step& step) {
        std::optional<Trouble> trouble = attempt(doing, step);
        if (!trouble) return true;
        const MethodSpec method = result.method;
        result = {};
        result.method = method;
        result.status = trouble->status;
        result.reason = trouble->reason;
        if (method.label != m_spec.baseline) return false;
        m_run.baseline_again.clear();
        m_run.baseline_again_sort_ms.clear();
        return false;
    }

    /// Frees what the failed methods hold.
    void drop_failed() {
        std::erase_if(m_contenders, [](const Contender& contender) { return contender.result->status != "ok"; });
    }

    template <typename Draw>
    gl::FrameSample frame(bool timed, const Draw& draw) {
        m_timer.begin_frame(timed);
        try {
            draw();
        } catch (...) {
            m_timer.end_frame();
            throw;
        }
        return m_timer.end_frame();
    }

    gl::FrameSample render(Method& method, bool timed) {
        return frame(timed, [&] { method.render(m_timer); });
    }

    std::unique_ptr<Method> make_method(const MethodSpec& spec, const Scene& scene, const Target& target) {
        return find_method(spec.id)->make({m_context, m_context.gl(), scene, target, spec.parameters});
    }

    Image picture(const MethodSpec& spec, const Scene& scene, const Target& target) {
        const auto method = make_method(spec, scene, target);
        render(*method, false);
        return target.read();
    }

    /// What the method makes of another background. `own` is its picture over that of the spec.
    Image over_background(const std::array<float, 3>& background, Method& method, Target& target, const Image& own) {
        if (background == m_spec.image.background) return own;
        const OtherBackground other(target, background, m_spec.image.background);
        method.restart();
        render(method, false);
        return target.read();
    }

    Backdrops over_backdrops(Method& method, Target& target, const Image& own) {
        return {over_background({0, 0, 0}, method, target, own), over_background({1, 1, 1}, method, target, own)};
    }

    /// References are rendered in 32-bit floats, whatever the methods blend into. Without one the methods are still
    /// timed and counted.
    void render_reference(const Scene& scene) {
        m_progress(references_begin, "rendering the reference " + m_spec.reference.id);
        Target target(m_context.gl(), m_spec.image, PixelFormat::rgba32f);
        m_run.reference = m_spec.reference;
        frame(false, [&] { m_run.overdraw = count_overdraw(m_context.gl(), scene, target, m_timer); });
        m_context.check("counting the fragments");
        const auto trouble = attempt("rendering the reference " + m_spec.reference.id, [&] {
            const auto reference = make_method(m_spec.reference, scene, target);
            render(*reference, false);
            m_run.reference_image = target.read();
            m_reference_over = over_backdrops(*reference, target, m_run.reference_image);
            round_reference();
            m_run.reference_findings = findings(*reference);
        });
        if (trouble) {
            m_run.reference_status = trouble->status;
            m_run.reference_reason = m_run.no_residual_reason = trouble->reason;
            m_run.reference_image = m_run.reference_as_shown = {};
            m_run.format_cost.reset();
            m_run.reference_findings = nlohmann::json::object();
        } else {
            check_reference(scene, target);
        }
    }

    void round_reference() {
        const auto rounded = [&](const Image& image) { return rounded_to(m_spec.image.format, m_context.gl(), image); };
        m_run.reference_as_shown = rounded(m_run.reference_image);
        const Backdrops over = {rounded(m_reference_over.black), rounded(m_reference_over.white)};
        m_run.format_cost = compute_metrics(m_run.reference_image, m_run.reference_as_shown, &m_reference_over, &over);
        m_run.format_cost->pictures.clear();
    }

    /// Against depth peeling, which shares nothing with the lists.
    void check_reference(const Scene& scene, const Target& target) {
        const double peeled = peeled_fragments(m_run.overdraw);
        if (peeled > max_peeled_fragments) {
            m_run.no_residual_reason = fmt::format("depth peeling would draw {} fragments; the limit is {}",
                                                   number_text(peeled), number_text(max_peeled_fragments));
            return;
        }
        m_progress(references_begin, "checking the reference against depth peeling");
        const auto trouble = attempt("checking the reference against depth peeling", [&] {
            const Image peeled_image = picture({"depth_peeling", "", nlohmann::json::object()}, scene, target);
            double greatest = 0;
            for (std::size_t i = 0; i < peeled_image.rgba.size(); ++i)
                if (i % 4 != 3)
                    greatest =
                        std::max(greatest, std::abs(double{peeled_image.rgba[i]} - m_run.reference_image.rgba[i]));
            m_run.residual = greatest;
        });
        if (!trouble) return;
        m_run.residual.reset();
        m_run.no_residual_reason = trouble->reason;
    }

    /// A comparison of nothing must not look like one in which all methods agree.
    void look_for_something(const Scene& scene, const Geometry& geometry, const Target& target) {
        const SceneInfo& type = *find_scene(m_spec.scene_type);
        frame(false, [&] {
            m_run.nothing_drawn =
                why_nothing_is_drawn(m_context.gl(), scene, geometry, type, target, m_run.overdraw, m_timer);
        });
        m_context.check("looking for transparent fragments");
        if (!m_run.nothing_drawn.empty()) add_note(m_run.notes, {"nothing-transparent", m_run.nothing_drawn, "/scene"});
    }

    /// What the methods that sort would pay for it in every frame, were the camera to move.
    void prepare_sorting(const Geometry& geometry) {
        const bool needed =
            std::ranges::any_of(m_contenders, [](const Contender& contender) { return contender.result->sorts; });
        if (!needed) return;
        if (std::ranges::all_of(geometry.primitives, &Primitive::opaque)) {
            m_run.no_sort_reason = "there is nothing transparent to sort";
            return;
        }
        const auto trouble = attempt("preparing the sort", [&] {
            m_sort.emplace(m_context.gl(), geometry);
            m_sort->time_next_ms();
        });
        if (!trouble) return;
        m_run.no_sort_reason = trouble->reason;
        m_sort.reset();
    }

    std::unique_ptr<Method> make_warm(const MethodSpec& spec, const Scene& scene, const Target& target) {
        auto method = make_method(spec, scene, target);
        for (int frame = 0; frame < m_spec.timing.warmup; ++frame) render(*method, false);
        return method;
    }

    /// Renders each method until it is warm, and keeps its picture. The baseline is made twice: how far it is from
    /// itself is the noise that every other difference is seen against.
    void make_methods(const Scene& scene, const Target& target) {
        m_run.results.resize(m_spec.methods.size());
        for (std::size_t i = 0; i < m_run.results.size(); ++i) {
            MethodResult& result = m_run.results[i];
            result.method = m_spec.methods[i];
            const std::string& label = result.method.label;
            step(methods_begin, timing_begin, i, m_run.results.size(), "warming up " + label);
            attempt_for(result, "rendering " + label, [&] {
                auto method = make_warm(result.method, scene, target);
                result.image = target.read();
                result.memory_bytes = method->memory_bytes();
                result.sorts = find_method(result.method.id)->sorts(scene, result.method.parameters);
                m_contenders.push_back({std::move(method), &result, false});
            });
            if (label == m_spec.baseline && result.status == "ok")
                attempt_for(result, "rendering " + label + " a second time, for the noise floor", [&] {
                    m_contenders.push_back({make_warm(result.method, scene, target), &result, true});
                });
            drop_failed();
        }
    }

    /// Rounds in which every method renders one frame, in an order that is drawn anew: neighbours in time share the
    /// machine's mood, and no method always follows the same other one. No round is begun that would go over the time,
    /// if it took as long as the longest yet.
    void time_methods() {
        using Clock = std::chrono::steady_clock;
        const auto begin = Clock::now();
        double done_s = 0, longest_s = 0;
        Random random(1);
        for (int round = 0; round < m_spec.timing.rounds && !m_contenders.empty(); ++round) {
            if (round > 0 && done_s + longest_s > m_spec.timing.max_seconds) break;
            const std::string stage = fmt::format("timing round {} of {}", round + 1, m_spec.timing.rounds);
            step(timing_begin, counting_begin, static_cast<std::size_t>(round),
                 static_cast<std::size_t>(m_spec.timing.rounds), stage);
            time_round(random);
            const double now_s = std::chrono::duration<double>(Clock::now() - begin).count();
            longest_s = std::max(longest_s, now_s - done_s);
            done_s = now_s;
            m_run.rounds_done = round + 1;
        }
    }

    void time_round(Random& random) {
        std::vector<std::size_t> order(m_contenders.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
        for (const std::size_t i : order) {
            const Contender& contender = m_contenders[i];
            if (contender.result->status != "ok") continue;
            attempt_for(*contender.result, "timing " + contender.result->method.label, [&] {
                if (m_sort && contender.result->sorts) contender.sort_ms(m_run).push_back(m_sort->time_next_ms());
                contender.samples(m_run).push_back(render(*contender.method, true));
            });
        }
        drop_failed();
    }

    /// Calls `step(method, result)` for each method that is still there, with its progress.
    template <typename Step>
    void for_each_method(double from, double to, const std::string& doing, const Step& take_step) {
        for (std::size_t i = 0; i < m_contenders.size(); ++i) {
            const Contender& contender = m_contenders[i];
            if (contender.again) continue;
            const std::string stage = doing + " " + contender.result->method.label;
            step(from, to, i, m_contenders.size(), stage);
            attempt_for(*contender.result, stage, [&] { take_step(*contender.method, *contender.result); });
        }
        drop_failed();
    }

    void count_fragments(Scene& scene, const Target& target) {
        std::map<float, NeededFragments> needed;
        for_each_method(
            counting_begin, metrics_begin, "counting the fragments of", [&](Method& method, MethodResult& result) {
                FragmentCounts& fragments = result.fragments;
                static_cast<ShadingCount&>(fragments) =
                    count_shaded(m_context.gl(), scene, target, m_early_tests, [&] { render(method, false); });
                count_needed_by(result.method, scene, target, needed, fragments);
            });
    }

    void ask_methods() {
        for_each_method(metrics_begin, metrics_begin, "asking",
                        [&](Method& method, MethodResult& result) { result.findings = findings(method); });
    }

    nlohmann::json findings(Method& method) {
        nlohmann::json found;
        frame(false, [&] { found = method.findings(m_timer); });
        return found;
    }

    /// `known` holds what has been counted already, by threshold.
    void count_needed_by(const MethodSpec& method, const Scene& scene, const Target& target,
                         std::map<float, NeededFragments>& known, FragmentCounts& fragments) {
        if (!method.parameters.contains("threshold")) {
            fragments.needed = m_run.overdraw;
            return;
        }
        fragments.no_needed_reason = why_needed_is_unknown(scene, m_run.overdraw);
        if (!fragments.no_needed_reason.empty()) return;
        const auto threshold = method.parameters.at("threshold").get<float>();
        if (!known.contains(threshold))
            frame(false, [&] { known[threshold] = count_needed(m_context.gl(), scene, target, threshold, m_timer); });
        fragments.needed = known[threshold].needed;
        fragments.saturation = known[threshold].saturation;
    }

    /// While the methods live, since they are rendered over other backgrounds: one at a time, to hold few pictures.
    void measure(Target& target) {
        for_each_method(metrics_begin, 1, "measuring", [&](Method& method, MethodResult& result) {
            result.no_metrics_reason = find_method(result.method.id)->no_metrics_reason;
            if (result.no_metrics_reason.empty() && m_run.reference_status != "ok")
                result.no_metrics_reason = fmt::format("the reference {} is {}: {}", m_run.reference.id,
                                                       m_run.reference_status, m_run.reference_reason);
            if (!result.no_metrics_reason.empty()) return;
            const Backdrops over = over_backdrops(method, target, result.image);
            result.metrics = compute_metrics(m_run.reference_image, result.image, &m_reference_over, &over,
                                             &m_run.reference_as_shown);
        });
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
    Run m_run;
    std::optional<DepthSort> m_sort;  ///< where a method sorts
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
