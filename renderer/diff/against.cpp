#include "renderer/diff/against.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "renderer/core/number_text.h"
#include "renderer/diff/diff_parts.h"
#include "renderer/files/report_document.h"
#include "renderer/report/report.h"

namespace sheer {

using nlohmann::json;
using report::Check, report::CheckOutcome, report::Report;

namespace {

/// Fields that determine neither a picture nor what is timed.
bool is_remark(const std::string& pointer) {
    static const std::set<std::string> remarks = {"title",      "tags",      "checks", "timing",      "against",
                                                  "under_test", "tolerance", "suite",  "on_undecided"};
    const std::size_t begin = std::string("/spec/").size();
    return !pointer.starts_with("/spec/") || remarks.contains(pointer.substr(begin, pointer.find('/', begin) - begin));
}

bool lies_in(const std::string& pointer, const std::vector<std::string>& fields) {
    return std::ranges::any_of(
        fields, [&](const std::string& field) { return pointer == field || pointer.starts_with(field + "/"); });
}

std::string field_of_file(const FieldDifference& difference) {
    return (difference.a.is_object() ? difference.a : difference.b).value("pointer", "");
}

std::string device_text(const Report& report) {
    return report.device ? fmt::format("{} on {}", report.device->renderer, report.device->cpu) : "an unknown device";
}

/// The checks of one method at one point.
class MethodChecks {
  public:
    /// `by_own_time`: the baseline method changed too, so that times cannot be compared with it.
    MethodChecks(const diff::RunDiff& run, const diff::ResultDiff& result, double max_flip, double max_slowdown,
                 bool by_own_time)
        : m_run(run),
          m_result(result),
          m_max_flip(max_flip),
          m_max_slowdown(max_slowdown),
          m_by_own_time(by_own_time) {}

    void add_to(std::vector<Check>& checks) const {
        checks.push_back(of_picture());
        if (!m_result.time) return;
        // The time of the baseline method is what the others' times are compared with, unless it changed.
        if (m_by_own_time && m_result.time->absolute)
            checks.push_back(of_time(*m_result.time, *m_result.time->absolute, m_result.time->absolute->verdict));
        if (!m_by_own_time && m_result.time->relative)
            checks.push_back(of_time(*m_result.time, *m_result.time->relative, m_result.time->verdict));
    }

  private:
    Check begin(const std::string& metric, double limit) const {
        return {.metric = metric, .method = m_result.label, .at = m_run.point, .max = limit};
    }

    static Check end(Check check, CheckOutcome outcome, const std::string& reason = "") {
        check.outcome = outcome;
        check.passed = outcome == CheckOutcome::passed;
        check.reason = reason;
        return check;
    }

    Check of_picture() const {
        using enum CheckOutcome;
        Check check = begin("against.flip.mean", m_max_flip);
        if (m_result.status.a != m_result.status.b)
            return end(
                check, failed,
                fmt::format("its status was {} and is {}", word_of(m_result.status.a), word_of(m_result.status.b)));
        // Neither has a picture, for the same cause.
        if (!m_result.picture) return end(check, passed, fmt::format("it is {} in both", word_of(m_result.status.b)));
        if (m_result.picture->verdict == diff::PictureVerdict::identical) {
            check.value = 0;
            return end(check, passed, "the pictures are identical");
        }
        if (!m_result.picture->flip) return end(check, failed, m_result.picture->reason);
        check.value = m_result.picture->flip->mean;
        return end(check, *check.value <= m_max_flip && m_max_flip > 0 ? passed : failed,
                   fmt::format("{} pixels differ", m_result.picture->differing_pixels.value_or(0)));
    }

    Check of_time(const diff::TimeDiff& time, const diff::Judged& speedup, report::SpeedVerdict verdict) const {
        using enum CheckOutcome;
        Check check = begin("against.slowdown", m_max_slowdown);
        check.value = speedup.value > 0 ? std::optional(1 / speedup.value) : std::nullopt;
        if (!speedup.ci95) return end(check, undecided, "there are too few rounds for an interval");
        const double least = 1 / (*speedup.ci95)[1], greatest = 1 / (*speedup.ci95)[0];
        const std::string interval = fmt::format("[{}, {}]", number_text(least), number_text(greatest));
        if (greatest <= m_max_slowdown) return end(check, passed);
        if (least <= m_max_slowdown)
            return end(check, undecided, fmt::format("the limit lies within its interval {}", interval));
        if (verdict != report::SpeedVerdict::slower)
            return end(check, undecided,
                       fmt::format("its interval {} is over the limit, but {}", interval,
                                   time.reason.empty() ? "its own time is not" : time.reason));
        return end(check, failed, fmt::format("its interval is {}", interval));
    }

    const diff::RunDiff& m_run;
    const diff::ResultDiff& m_result;
    double m_max_flip, m_max_slowdown;
    bool m_by_own_time;
};

std::vector<std::string> under_test_of(const Report& report) {
    return report.spec.value("under_test", std::vector<std::string>());
}

std::string chosen_text(const Report& now, const Accepted& accepted) {
    const std::vector<std::string> under_test = under_test_of(now);
    const std::string with = accepted.baseline.empty()
                                 ? accepted.report.id
                                 : fmt::format("{} of {}, accepted {} ago{}", accepted.report.id, accepted.baseline,
                                               accepted.age, accepted.by.empty() ? "" : " by " + accepted.by);
    return fmt::format("compared with {}, because it was made by the same device, {}, from the same spec{}", with,
                       device_text(now),
                       under_test.empty() ? "" : fmt::format(" except for {}", fmt::join(under_test, ", ")));
}

/// The check that fails if there is nothing to compare with.
Check without_report(const std::string& asked, const std::string& reason) {
    return {.metric = "against",
            .method = asked,
            .outcome = CheckOutcome::failed,
            .reason = "there is no report to compare with: " + reason};
}

/// Whether the scene, the picture or the baseline method differ, which change the time of the baseline method.
bool has_other_baseline_time(const Report& before, const Report& now) {
    const json& methods = before.spec.at("methods");
    std::string baseline = "/methods";
    for (std::size_t i = 0; i < methods.size(); ++i)
        if (methods[i].value("label", "") == before.baseline()) baseline = fmt::format("/spec/methods/{}", i);
    return std::ranges::any_of(report_differences(before, now), [&](const FieldDifference& one) {
        return lies_in(one.pointer, {"/spec/scene", "/spec/image", baseline}) || one.pointer.starts_with("/files/");
    });
}

void add_checks(Report& now, const Report& before, const diff::Diff& diff) {
    const json tolerance = now.spec.value("tolerance", json::object());
    const bool by_own_time = has_other_baseline_time(before, now);
    for (const diff::RunDiff& run : diff.runs)
        for (const diff::ResultDiff& result : run.results)
            MethodChecks(run, result, tolerance.value("max_flip", 0.0), tolerance.value("max_slowdown", 1.1),
                         by_own_time)
                .add_to(now.checks);
    if (before.runs.size() != now.runs.size())
        now.checks.push_back(without_report(
            before.id, fmt::format("it has {} points and this one has {}", before.runs.size(), now.runs.size())));
}

}  // namespace

std::string why_not_against(const Report& before, const Report& now, std::vector<std::string>& differing) {
    if (before.status != report::Status::done) return "it is not done";
    if (!is_same_device(before, now))
        return fmt::format("it was made by {}, and this one by {}", device_text(before), device_text(now));
    const std::vector<std::string> under_test = under_test_of(now);
    for (const FieldDifference& one : report_differences(before, now)) {
        const bool is_file = one.pointer.starts_with("/files/");
        if (!is_file && is_remark(one.pointer)) continue;
        const std::string field = is_file ? field_of_file(one) : one.pointer.substr(std::string("/spec").size());
        if (!lies_in(field, under_test) && std::ranges::find(differing, field) == differing.end())
            differing.push_back(field);
    }
    if (differing.empty()) return "";
    return fmt::format("its spec differs in {}, which `under_test` does not list", fmt::join(differing, ", "));
}

void compare_against(Report& now, const std::vector<Accepted>& accepted, const report::PictureReader& read_picture,
                     const report::PictureReader& read_accepted) {
    report::Against against{.asked = now.spec.value("against", "")};
    std::string reason = fmt::format("{} has no accepted report", against.asked);
    for (const Accepted& one : accepted) {
        report::NotAgainst refused{.report = one.report.id};
        refused.reason = why_not_against(one.report, now, refused.differing);
        if (refused.reason.empty()) {
            try {
                const DiffOptions options{.allow = under_test_of(now)};
                add_checks(now, one.report, diff_reports({one.report, read_accepted}, {now, read_picture}, options));
                against.report = one.report.id;
                against.accepted_at = one.accepted_at;
                against.text = chosen_text(now, one);
                break;
            } catch (const SpecError& conflict) {
                // Pictures of different sizes, for example.
                refused.reason = conflict.what();
            }
        }
        if (against.refused.empty()) reason = fmt::format("{}: {}", refused.report, refused.reason);
        against.refused.push_back(std::move(refused));
    }
    if (!against.report) {
        against.text = reason;
        now.checks.push_back(without_report(against.asked, reason));
    }
    now.against = std::move(against);
    judge(now);
}

}  // namespace sheer
