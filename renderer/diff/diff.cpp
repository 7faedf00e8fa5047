#include "renderer/diff/diff.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/core/number_text.h"
#include "renderer/diff/diff_parts.h"
#include "renderer/files/report_document.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using nlohmann::json;

namespace {

std::optional<std::string> text_in(const json& spec, const char* name) {
    return spec.contains(name) ? std::optional(spec[name].get<std::string>()) : std::nullopt;
}

diff::Side side_of(const report::Report& report) {
    return {.id = report.id,
            .title = text_in(report.spec, "title"),
            .created_at = report.created_at,
            .version = report.provenance.version,
            .commit = report.provenance.commit,
            .renderer = report.device ? report.device->renderer : "",
            .baseline = text_in(report.spec, "baseline")};
}

/// Null if there is no run at this point.
const report::Run* run_at(const report::Report& report, const report::Point& point) {
    const auto found = std::ranges::find(report.runs, point, &report::Run::point);
    return found == report.runs.end() ? nullptr : &*found;
}

/// Methods and points that `of` has and `other` does not.
diff::OnlyIn only_in(const report::Report& of, const report::Report& other) {
    diff::OnlyIn only;
    const std::vector<std::string> others = method_labels(other);
    for (const std::string& label : method_labels(of))
        if (std::ranges::find(others, label) == others.end()) only.methods.push_back(label);
    for (const report::Run& run : of.runs)
        if (!run_at(other, run.point)) only.points.push_back(run.point);
    return only;
}

/// One run of both reports, method by method.
class RunComparison {
  public:
    /// The pictures of both have this size.
    RunComparison(const RunPair& runs, std::array<int, 2> size_px, PictureComparison& pictures, std::size_t index)
        : m_runs(runs), m_size_px{size_px[0], size_px[1]}, m_pictures(pictures), m_index(index) {}

    diff::RunDiff compare() {
        m_runs.compared = 0;
        for (const report::Result& result : m_runs.a.results)
            if (const report::Result* other = m_runs.b.find(result.label))
                m_runs.compared += ran(result) && ran(*other);
        diff::RunDiff run;
        run.point = m_runs.a.point;
        run.image = m_size_px;
        run.compared = m_runs.compared;
        run.reference = reference();
        for (const report::Result& one : m_runs.a.results)
            if (const report::Result* other = m_runs.b.find(one.label))
                run.results.push_back(result(one, *other, run.results.size()));
        return run;
    }

  private:
    static bool ran(const report::Result& result) { return result.status == report::ResultStatus::ok; }

    static std::optional<std::string> reason(const report::Result& result) {
        return result.reason.empty() ? std::nullopt : std::optional(result.reason);
    }

    std::optional<diff::PictureDiff> picture(const report::Pictures& a, const report::Pictures& b,
                                             const std::string& name) {
        return m_pictures.compare(a, b, m_size_px, fmt::format("{:03}-{}", m_index + 1, name));
    }

    diff::ReferenceDiff reference() {
        const report::Reference &a = m_runs.a.reference, &b = m_runs.b.reference;
        return {.method = {a.method, b.method}, .picture = picture(a.images, b.images, "reference")};
    }

    diff::ResultDiff result(const report::Result& a, const report::Result& b, std::size_t index) {
        diff::ResultDiff result;
        result.label = a.label;
        result.method = a.method;
        result.status = {a.status, b.status};
        if (ran(a) && ran(b)) {
            result.picture = picture(a.images, b.images, std::to_string(index + 1));
            result.time = time_diff(m_runs, a, b);
        } else {
            result.reason = diff::Reasons{reason(a), reason(b)};
        }
        return result;
    }

    RunPair m_runs;
    diff::Size m_size_px;
    PictureComparison& m_pictures;
    std::size_t m_index;
};

void count(const std::optional<diff::PictureDiff>& picture, diff::PictureCounts& counts) {
    if (!picture) return;
    counts.identical += picture->verdict == diff::PictureVerdict::identical;
    counts.different += picture->verdict == diff::PictureVerdict::different;
    counts.not_examined += picture->verdict == diff::PictureVerdict::not_examined;
}

void count(const std::optional<diff::TimeDiff>& time, diff::TimeCounts& counts) {
    if (!time) return;
    counts.faster += time->verdict == report::SpeedVerdict::faster;
    counts.slower += time->verdict == report::SpeedVerdict::slower;
    counts.not_resolved += time->verdict == report::SpeedVerdict::not_resolved;
}

diff::Summary summary_of(const std::vector<diff::RunDiff>& runs) {
    diff::Summary summary;
    for (const diff::RunDiff& run : runs) {
        count(run.reference.picture, summary.pictures);
        for (const diff::ResultDiff& result : run.results) {
            count(result.picture, summary.pictures);
            count(result.time, summary.times);
            summary.statuses_changed += result.status.a != result.status.b;
        }
    }
    return summary;
}

void check_done(const report::Report& report, const char* which) {
    if (report.status == report::Status::done) return;
    throw SpecError(std::vector<FieldError>{
        {"/status", fmt::format("the {} report is not done: it is {}", which, word_of(report.status))}});
}

/// The runs that both have.
std::vector<RunPair> pairs_of(const report::Report& a, const report::Report& b) {
    const bool same_device = is_same_device(a, b);
    std::vector<RunPair> pairs;
    for (const report::Run& run : a.runs)
        if (const report::Run* other = run_at(b, run.point))
            pairs.push_back({run, *other, a.baseline(), b.baseline(), same_device, 1});
    if (pairs.empty()) throw SpecError(std::vector<FieldError>{{"/spec/sweep", "the reports have no point in common"}});
    return pairs;
}

}  // namespace

diff::Diff diff_reports(const DiffSide& a, const DiffSide& b, const DiffOptions& options) {
    check_done(a.report, "first");
    check_done(b.report, "second");
    std::vector<FieldDifference> differences = report_differences(a.report, b.report);
    check_specs(a.report, b.report, options.allow, differences);
    const std::vector<RunPair> pairs = pairs_of(a.report, b.report);
    if (options.run && *options.run >= pairs.size())
        throw SpecError(std::vector<FieldError>{{"/run", fmt::format("must be less than {}", pairs.size())}});
    PictureComparison pictures(a, b, options);
    diff::Diff diff;
    diff.a = side_of(a.report);
    diff.b = side_of(b.report);
    diff.same_device = is_same_device(a.report, b.report);
    diff.differences.assign(differences.begin(), differences.end());
    diff.only_in = {only_in(a.report, b.report), only_in(b.report, a.report)};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (options.run && *options.run != i) continue;
        // The sizes are not in conflict, so both reports have the same.
        const std::array<int, 2> size_px = picture_size_px(a.report, pairs[i].a.point);
        diff.runs.push_back(RunComparison(pairs[i], size_px, pictures, i).compare());
    }
    diff.summary = summary_of(diff.runs);
    return diff;
}

namespace {

/// "" if it does not differ, or by no more than is tolerated.
std::string worse_picture(const diff::PictureDiff& picture, const DiffTolerance& tolerance) {
    if (picture.verdict != diff::PictureVerdict::different) return "";
    if (!picture.flip) return "its picture differs";
    if (picture.flip->mean <= tolerance.max_flip && tolerance.max_flip > 0) return "";
    return fmt::format("its picture differs by a mean FLIP of {}, at most {}", number_text(picture.flip->mean),
                       number_text(tolerance.max_flip));
}

/// Whether a speedup, which is the time before over the time now, is resolved to be a slowdown of more than `limit`.
bool is_slower_by(const diff::Judged& judged, double limit) {
    return judged.ci95 && (*judged.ci95)[1] < 1 / limit;
}

std::string slower_time(const diff::TimeDiff& time, bool same_device, const DiffTolerance& tolerance) {
    if (time.verdict != report::SpeedVerdict::slower || !time.absolute) return "";
    const bool is_beyond = is_slower_by(*time.absolute, tolerance.max_slowdown) &&
                           (!same_device || !time.relative || is_slower_by(*time.relative, tolerance.max_slowdown));
    if (!is_beyond) return "";
    return fmt::format("it takes {} times as long, at most {}", number_text(1 / time.absolute->value),
                       number_text(tolerance.max_slowdown));
}

}  // namespace

std::vector<std::string> changes_for_the_worse(const diff::Diff& diff, const DiffTolerance& tolerance) {
    std::vector<std::string> all;
    for (const diff::RunDiff& run : diff.runs) {
        const std::string at = run.point.empty() ? "" : " at " + describe_point(run.point);
        const auto add = [&](const std::string& what, const std::string& change) {
            if (!change.empty()) all.push_back(fmt::format("{}{}: {}", what, at, change));
        };
        if (run.reference.picture) add("the reference", worse_picture(*run.reference.picture, tolerance));
        for (const diff::ResultDiff& result : run.results) {
            if (result.status.a != result.status.b)
                add(result.label,
                    fmt::format("its status was {} and is {}", word_of(result.status.a), word_of(result.status.b)));
            if (result.picture) add(result.label, worse_picture(*result.picture, tolerance));
            if (result.time) add(result.label, slower_time(*result.time, diff.same_device, tolerance));
        }
    }
    return all;
}

}  // namespace sheer
