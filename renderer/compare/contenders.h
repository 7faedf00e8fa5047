#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/compare/gpu_clock.h"
#include "renderer/compare/looks.h"
#include "renderer/compare/workbench.h"
#include "renderer/core/random.h"
#include "renderer/scene/depth_sort.h"

namespace sheer {

/// The running methods of a spec, and the rounds in which they are timed side by side. A method that fails is removed,
/// and its result says why.
class Contenders {
  public:
    /// All references must outlive it; `run` has the methods' results.
    Contenders(const Spec& spec, const Looks& looks, const Target& target, Workbench& bench, Run& run)
        : m_spec(spec),
          m_looks(looks),
          m_target(target),
          m_bench(bench),
          m_run(run),
          m_clock(open_gpu_clock(bench.device().renderer)) {}

    /// Renders each method until it is warm, and keeps its picture. The baseline is made twice: how much it differs
    /// from itself is the noise with which every other difference is compared.
    void make();
    /// Times the sorting that the methods that sort would need in every frame if the camera moved.
    void prepare_sorting(const Geometry& geometry);
    /// Rounds in which every method renders one frame, each round in a new random order: frames close in time share the
    /// state of the machine, and no method always follows the same other one. No round begins that would exceed the
    /// time limit if it took as long as the longest so far. If there is `is_undecided`, it is asked after the spec's
    /// rounds, and again each time that their number has doubled.
    void time(const UndecidedFunction& is_undecided);
    /// Runs `step` for each remaining method; this takes the job's progress from the fraction `from` to `to`.
    void for_each(double from, double to, const std::string& doing,
                  const std::function<void(Method&, MethodResult&)>& step);

  private:
    struct Contender {
        std::unique_ptr<Method> method;
        MethodResult* result;
        bool again;  ///< it is the second instance of the baseline, which shares the first one's result

        std::vector<gl::FrameSample>& samples(Run& run) const { return again ? run.baseline_again : result->samples; }
        std::vector<double>& sort_ms(Run& run) const { return again ? run.baseline_again_sort_ms : result->sort_ms; }
    };

    /// The time that the rounds take.
    struct RoundClock {
        std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
        double done_s = 0, longest_s = 0;
    };

    void attempt_for(MethodResult& result, const std::string& doing, const std::function<void()>& step);
    std::unique_ptr<Method> make_warm(const MethodSpec& method);
    void time_round(Random& random);
    /// A timed frame. It is rendered again while the GPU's clock is lowered, but not without end.
    gl::FrameSample timed_frame(const Contender& contender);
    /// Until there are this many rounds, or the time is over, which it returns.
    bool time_rounds(int count, Random& random, RoundClock& clock);
    void drop_failed();

    const Spec& m_spec;
    const Looks& m_looks;
    const Target& m_target;
    Workbench& m_bench;
    Run& m_run;
    std::unique_ptr<GpuClock> m_clock;  ///< null if nothing tells it
    std::optional<DepthSort> m_sort;    ///< if a method sorts
    std::vector<Contender> m_all;
};

}  // namespace sheer
