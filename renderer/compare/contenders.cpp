#include "renderer/compare/contenders.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <numeric>

#include "renderer/compare/progress.h"

namespace sheer {

namespace {

constexpr int most_looks = 16;
constexpr int most_retakes = 3;

}  // namespace

void Contenders::attempt_for(MethodResult& result, const std::string& doing, const std::function<void()>& step) {
    if (m_bench.attempt_for(result, doing, step) || result.method.label != m_spec.baseline) return;
    m_run.baseline_again.clear();
    m_run.baseline_again_sort_ms.clear();
}

/// Frees the resources of failed methods.
void Contenders::drop_failed() {
    std::erase_if(m_all,
                  [](const Contender& contender) { return contender.result->status != report::ResultStatus::ok; });
}

std::unique_ptr<Method> Contenders::make_warm(const MethodSpec& method) {
    auto made = m_bench.make_method(method, *m_looks.of(method).scene, m_target);
    for (int frame = 0; frame < m_spec.timing.warmup; ++frame) m_bench.render(*made, false);
    return made;
}

void Contenders::make() {
    m_run.results.resize(m_spec.methods.size());
    for (std::size_t i = 0; i < m_run.results.size(); ++i) {
        MethodResult& result = m_run.results[i];
        result.method = m_spec.methods[i];
        const std::string& label = result.method.label;
        m_bench.tell(methods_begin, timing_begin, i, m_run.results.size(), "warming up " + label);
        attempt_for(result, "rendering " + label, [&] {
            auto method = make_warm(result.method);
            result.image = m_target.read();
            result.memory_bytes = method->memory_bytes();
            result.sorts =
                find_method(result.method.id)->sorts(*m_looks.of(result.method).scene, result.method.parameters);
            m_all.push_back({std::move(method), &result, false});
        });
        if (label == m_spec.baseline && result.status == report::ResultStatus::ok)
            attempt_for(result, "rendering " + label + " a second time, for the noise floor", [&] {
                m_all.push_back({make_warm(result.method), &result, true});
            });
        drop_failed();
    }
}

void Contenders::prepare_sorting(const Geometry& geometry) {
    if (std::ranges::none_of(m_all, [](const Contender& contender) { return contender.result->sorts; })) return;
    if (std::ranges::all_of(geometry.primitives, &Primitive::opaque)) {
        m_run.no_sort_reason = "there is nothing transparent to sort";
        return;
    }
    const auto trouble = m_bench.attempt("preparing the sort", [&] {
        m_sort.emplace(m_bench.gl(), geometry);
        m_sort->time_next_ms();
    });
    if (!trouble) return;
    m_run.no_sort_reason = trouble->reason;
    m_sort.reset();
}

void Contenders::time(const UndecidedFunction& is_undecided) {
    Random random(1);
    RoundClock clock;
    bool has_time = time_rounds(m_spec.timing.rounds, random, clock);
    if (!is_undecided) return;
    m_run.looks = 1;
    while (has_time && !m_all.empty() && m_run.looks < most_looks && is_undecided(m_run)) {
        const int before = m_run.rounds_done;
        has_time = time_rounds(2 * before, random, clock);
        if (m_run.rounds_done > before) ++m_run.looks;
    }
}

bool Contenders::time_rounds(int count, Random& random, RoundClock& clock) {
    while (m_run.rounds_done < count && !m_all.empty()) {
        if (m_run.rounds_done > 0 && clock.done_s + clock.longest_s > m_spec.timing.max_seconds) return false;
        m_bench.tell(timing_begin, counting_begin, static_cast<std::size_t>(m_run.rounds_done),
                     static_cast<std::size_t>(count),
                     fmt::format("timing round {} of {}", m_run.rounds_done + 1, count));
        time_round(random);
        const double now_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock.begin).count();
        clock.longest_s = std::max(clock.longest_s, now_s - clock.done_s);
        clock.done_s = now_s;
        ++m_run.rounds_done;
    }
    return true;
}

void Contenders::time_round(Random& random) {
    std::vector<std::size_t> order(m_all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    for (const std::size_t i : order) {
        const Contender& contender = m_all[i];
        if (contender.result->status != report::ResultStatus::ok) continue;
        attempt_for(*contender.result, "timing " + contender.result->method.label, [&] {
            if (m_sort && contender.result->sorts) contender.sort_ms(m_run).push_back(m_sort->time_next_ms());
            contender.samples(m_run).push_back(timed_frame(contender));
        });
    }
    drop_failed();
}

gl::FrameSample Contenders::timed_frame(const Contender& contender) {
    ClockLog& log = contender.result->clock;
    for (int again = 0;; ++again) {
        const gl::FrameSample sample = m_bench.render(*contender.method, true);
        if (!m_clock) return sample;
        const ClockReading reading = m_clock->read();
        log.lowered_by.insert(reading.lowered_by.begin(), reading.lowered_by.end());
        if (reading.lowered_by.empty() || again == most_retakes) {
            if (!reading.lowered_by.empty())
                add_note(contender.result->notes,
                         {"lowered-clock",
                          fmt::format("The GPU's clock stayed lowered while this method was timed: {}.",
                                      fmt::join(reading.lowered_by, ", ")),
                          ""});
            if (!contender.again) log.sm_mhz.push_back(reading.sm_mhz);
            return sample;
        }
        ++log.retaken;
    }
}

void Contenders::for_each(double from, double to, const std::string& doing,
                          const std::function<void(Method&, MethodResult&)>& step) {
    for (std::size_t i = 0; i < m_all.size(); ++i) {
        const Contender& contender = m_all[i];
        if (contender.again) continue;
        const std::string stage = doing + " " + contender.result->method.label;
        m_bench.tell(from, to, i, m_all.size(), stage);
        attempt_for(*contender.result, stage, [&] { step(*contender.method, *contender.result); });
    }
    drop_failed();
}

}  // namespace sheer
