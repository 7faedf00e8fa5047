#include "renderer/files/diff.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/files/diff_parts.h"
#include "renderer/report/measured.h"

namespace sheer {

using nlohmann::json;

namespace {

json text_at(const json& report, const char* pointer) {
    const json::json_pointer place(pointer);
    return report.contains(place) ? report[place] : json();
}

json side_json(const json& report) {
    return {{"id", text_at(report, "/id")},
            {"title", text_at(report, "/spec/title")},
            {"created_at", text_at(report, "/created_at")},
            {"version", text_at(report, "/provenance/version")},
            {"commit", text_at(report, "/provenance/commit")},
            {"renderer", text_at(report, "/device/renderer")},
            {"baseline", text_at(report, "/spec/baseline")}};
}

json differences_json(const std::vector<Difference>& differences) {
    json all = json::array();
    for (const Difference& one : differences) all.push_back({{"pointer", one.pointer}, {"a", one.a}, {"b", one.b}});
    return all;
}

const json* run_at(const json& report, const json& point) {
    const json& runs = report.at("runs");
    const auto found = std::ranges::find_if(runs, [&](const json& run) { return run.at("point") == point; });
    return found == runs.end() ? nullptr : &*found;
}

/// Methods and points that `of` has and `other` has not.
json only_in(const json& of, const json& other) {
    json methods = json::array(), points = json::array();
    const json& others = other.at("spec").at("methods");
    for (const json& method : of.at("spec").at("methods"))
        if (std::ranges::none_of(others, [&](const json& one) { return one.at("label") == method.at("label"); }))
            methods.push_back(method.at("label"));
    for (const json& run : of.at("runs"))
        if (!run_at(other, run.at("point"))) points.push_back(run.at("point"));
    return {{"methods", methods}, {"points", points}};
}

int side_px(const json& report, const json& point, const std::string& name) {
    const std::string swept = "/image/" + name;
    return point.contains(swept) ? point[swept].get<int>() : report.at("spec").at("image").at(name).get<int>();
}

/// One run of both reports, method by method.
class RunDiff {
  public:
    /// `report` is either of the two; their pictures have the same size.
    RunDiff(const json& report, const RunPair& runs, PictureDiff& pictures, std::size_t index)
        : m_runs(runs),
          m_pictures(pictures),
          m_index(index),
          m_width_px(side_px(report, runs.a.at("point"), "width")),
          m_height_px(side_px(report, runs.a.at("point"), "height")) {}

    json write() {
        m_runs.compared = 0;
        for (const json& result : m_runs.a.at("results"))
            if (const json* other = other_result(result)) m_runs.compared += ran(result) && ran(*other);
        json results = json::array();
        for (const json& result : m_runs.a.at("results"))
            if (const json* other = other_result(result))
                results.push_back(result_json(result, *other, results.size()));
        return {{"point", m_runs.a.at("point")},
                {"image", {{"width", m_width_px}, {"height", m_height_px}}},
                {"compared", m_runs.compared},
                {"reference", reference_json()},
                {"results", results}};
    }

  private:
    static bool ran(const json& result) { return result.at("status") == "ok"; }

    const json* other_result(const json& result) const {
        return find_result(m_runs.b, result.at("label").get<std::string>());
    }

    json picture_json(const json& a, const json& b, const std::string& name) {
        return m_pictures.compare(a.at("images"), b.at("images"), m_width_px, m_height_px,
                                  fmt::format("{:03}-{}", m_index + 1, name));
    }

    json reference_json() {
        const json &a = m_runs.a.at("reference"), &b = m_runs.b.at("reference");
        return {{"method", {{"a", a.at("method")}, {"b", b.at("method")}}},
                {"picture", picture_json(a, b, "reference")}};
    }

    json result_json(const json& a, const json& b, std::size_t index) {
        json result = {{"label", a.at("label")},
                       {"method", a.at("method")},
                       {"status", {{"a", a.at("status")}, {"b", b.at("status")}}},
                       {"picture", nullptr},
                       {"time", nullptr}};
        if (ran(a) && ran(b)) {
            result["picture"] = picture_json(a, b, std::to_string(index + 1));
            result["time"] = time_diff(m_runs, a, b);
        } else {
            result["reason"] = {{"a", a.at("reason")}, {"b", b.at("reason")}};
        }
        return result;
    }

    RunPair m_runs;
    PictureDiff& m_pictures;
    std::size_t m_index;
    int m_width_px, m_height_px;
};

json summary_of(const json& runs) {
    json pictures = {{"identical", 0}, {"different", 0}, {"not examined", 0}};
    json times = {{"faster", 0}, {"slower", 0}, {"not resolved", 0}};
    int changed = 0;
    const auto count = [](json& counts, const json& verdict) {
        json& number = counts[verdict.get<std::string>()];
        number = number.get<int>() + 1;
    };
    for (const json& run : runs) {
        if (run["reference"]["picture"].is_object()) count(pictures, run["reference"]["picture"]["verdict"]);
        for (const json& result : run["results"]) {
            if (result["picture"].is_object()) count(pictures, result["picture"]["verdict"]);
            if (result["time"].is_object()) count(times, result["time"]["verdict"]);
            changed += result["status"]["a"] != result["status"]["b"];
        }
    }
    return {{"pictures", pictures}, {"times", times}, {"statuses_changed", changed}};
}

void check_done(const json& report, const char* which) {
    if (report.at("status") == "done") return;
    throw SpecError(std::vector<FieldError>{
        {"/status", fmt::format("the {} report is not done: it is {}", which, report["status"].get<std::string>())}});
}

/// The runs that both have.
std::vector<RunPair> pairs_of(const json& a, const json& b) {
    const bool same_device = is_same_device(a, b);
    std::vector<RunPair> pairs;
    for (const json& run : a.at("runs"))
        if (const json* other = run_at(b, run.at("point")))
            pairs.push_back({run, *other, a.at("spec").at("baseline"), b.at("spec").at("baseline"), same_device, 1});
    if (pairs.empty()) throw SpecError(std::vector<FieldError>{{"/spec/sweep", "the reports have no point in common"}});
    return pairs;
}

}  // namespace

json diff_reports(const DiffSide& a, const DiffSide& b, const DiffOptions& options) {
    check_done(a.report, "first");
    check_done(b.report, "second");
    const std::vector<Difference> differences = report_differences(a.report, b.report);
    if (const auto conflicts = spec_conflicts(a.report, b.report, differences); !conflicts.empty())
        throw SpecError(conflicts);
    const std::vector<RunPair> pairs = pairs_of(a.report, b.report);
    if (options.run && *options.run >= pairs.size())
        throw SpecError(std::vector<FieldError>{{"/run", fmt::format("must be less than {}", pairs.size())}});
    PictureDiff pictures(a, b, options);
    json runs = json::array();
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (!options.run || *options.run == i) runs.push_back(RunDiff(a.report, pairs[i], pictures, i).write());
    return {{"a", side_json(a.report)},
            {"b", side_json(b.report)},
            {"same_device", is_same_device(a.report, b.report)},
            {"differences", differences_json(differences)},
            {"only_in", {{"a", only_in(a.report, b.report)}, {"b", only_in(b.report, a.report)}}},
            {"summary", summary_of(runs)},
            {"runs", runs}};
}

bool is_worse(const json& diff) {
    const json& summary = diff.at("summary");
    return summary["pictures"]["different"] > 0 || summary["times"]["slower"] > 0 || summary["statuses_changed"] > 0;
}

}  // namespace sheer
