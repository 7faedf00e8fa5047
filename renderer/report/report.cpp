#include "renderer/report/report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>

#include "renderer/frame/magma.h"
#include "renderer/number_text.h"
#include "renderer/report/frontier.h"
#include "renderer/report/measured.h"
#include "renderer/report/provenance.h"
#include "renderer/report/suite.h"
#include "renderer/report/timing.h"
#include "version.h"

namespace sheer {

using nlohmann::json;

namespace {

/// A name for files: what is neither letter nor digit becomes a dash.
std::string file_name(const std::string& label) {
    std::string name;
    for (const char c : label) name += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' ? c : '-';
    return name;
}

/// What the names of a run's pictures begin with: its number, where there are several.
std::string run_prefix(const Spec& spec, std::size_t run) {
    return spec.points.size() > 1 ? fmt::format("{:03}-", run + 1) : "";
}

std::string result_name(std::size_t index, const MethodSpec& method) {
    return fmt::format("{}-{}", index + 1, method.label);
}

json device_json(const Device& device) {
    json object = gl::to_json(device.info);
    const std::string driver = driver_of(device.info.gl_version);
    object["driver"] = driver.empty() ? json() : json(driver);
    if (driver.empty()) object["driver_reason"] = "the version of OpenGL does not name it";
    object["cpu"] = cpu_name();
    object["workarounds"] = device.workarounds;
    return object;
}

/// What made the report, and in which state the machine was when it began.
json provenance_json(const Device& device) {
    json object = {{"version", version},
                   {"commit", commit},
                   {"rerun", "sheer compare SPEC.json" + context_arguments(device)},
                   {"cores", std::thread::hardware_concurrency()},
                   {"load", {{"start", load_average()}, {"end", nullptr}}}};
    object.update(governor());
    return object;
}

/// A run as JSON; its pictures go into the sink, if there is one.
class RunWriter {
  public:
    /// `prefix` comes before the names of the pictures.
    RunWriter(const Spec& spec, const Run& run, bool software, PictureSink* pictures, const std::string& prefix)
        : m_spec(spec), m_run(run), m_pictures(pictures), m_prefix(prefix), m_timings(run, spec.baseline, software) {
        if (pictures && !run.overdraw.counts.empty()) m_overdraw = count_image(run.overdraw, prefix + "overdraw.png");
    }

    json write() const {
        json reference = {{"method", m_run.reference.id},
                          {"parameters", m_run.reference.parameters},
                          {"images", reference_pictures()},
                          {"findings", m_run.reference_findings},
                          {"residual", {{"depth_peeling", m_run.residual ? json(*m_run.residual) : json()}}}};
        if (!m_run.residual) reference["residual_reason"] = m_run.no_residual_reason;
        reference["status"] = m_run.reference_status;
        reference["reason"] = m_run.reference_reason.empty() ? json() : json(m_run.reference_reason);
        if (m_run.format_cost)
            reference["rounded"] = {
                {"label", fmt::format("{} in {}", m_run.reference.id, to_string(m_run.image.format))},
                {"format", to_string(m_run.image.format)},
                {"metrics", m_run.format_cost->values}};
        json results = json::array();
        for (std::size_t i = 0; i < m_run.results.size(); ++i) {
            const MethodResult& result = m_run.results[i];
            results.push_back(result_json(result, result_name(i, result.method)));
        }
        json run = {
            {"point", m_run.point},
            {"reference", reference},
            {"rounds",
             {{"asked", m_spec.timing.rounds}, {"done", m_run.rounds_done}, {"needed", m_timings.needed_rounds()}}},
            {"noise_floor", m_timings.noise()},
            {"nothing_drawn", m_run.nothing_drawn.empty() ? json() : json(m_run.nothing_drawn)},
            {"notes", to_json(m_run.notes)},
            {"files", to_json(m_run.files)},
            {"results", results}};
        run["frontier"] = frontier(run, m_spec.baseline);
        return run;
    }

  private:
    std::string picture_name(const std::string& label, const std::string& ending) const {
        return fmt::format("{}{}.{}", m_prefix, file_name(label), ending);
    }

    json pictures(const Image& image, const std::string& label, bool linear) const {
        if (!m_pictures) return json::object();
        json all = {{"color", m_pictures->take(quantize(image), picture_name(label, "color.png"))}};
        if (linear) all["linear"] = m_pictures->take(image, picture_name(label, "linear.exr"));
        return all;
    }

    /// What is shown is what the methods' pictures are compared with: rounded as they are.
    json reference_pictures() const {
        if (m_run.reference_status != "ok") return json::object();
        const std::string label = "reference-" + m_run.reference.id;
        const Image& shown = m_run.format_cost ? m_run.reference_as_shown : m_run.reference_image;
        json all = pictures(shown, label, false);
        if (m_pictures) all["linear"] = m_pictures->take(m_run.reference_image, picture_name(label, "linear.exr"));
        return all;
    }

    json result_json(const MethodResult& result, const std::string& name) const {
        json object = {{"method", result.method.id},
                       {"label", result.method.label},
                       {"parameters", result.method.parameters},
                       {"status", result.status},
                       {"reason", result.reason.empty() ? json() : json(result.reason)},
                       {"images", json::object()},
                       {"timing", nullptr},
                       {"speedup", m_timings.speedup(result)},
                       {"fragments", nullptr},
                       {"metrics", nullptr},
                       {"memory_bytes", nullptr},
                       {"findings", result.findings},
                       {"notes", to_json(result.notes)}};
        object["speedup_with_sort"] = m_timings.speedup_with_sort(result);
        for (const std::string kind : {"speedup", "speedup_with_sort"})
            if (object[kind].is_null()) object[kind + "_reason"] = m_timings.no_speedup_reason(result);
        if (result.status != "ok") return object;
        object["images"] = pictures(result.image, name, m_run.image.format != PixelFormat::rgba8);
        object["images"].update(count_images(result, name));
        object["timing"] = m_timings.timing(result);
        object["fragments"] = fragments(result);
        object["memory_bytes"] = result.memory_bytes;
        if (result.metrics) {
            object["metrics"] = result.metrics->values;
            if (m_pictures)
                for (const auto& [key, picture] : result.metrics->pictures)
                    object["images"][key] = m_pictures->take(picture, picture_name(name, key + ".png"));
        } else {
            object["metrics_reason"] = result.no_metrics_reason;
        }
        return object;
    }

    /// The ideal time, that of f2b for the fragments that are needed, over the method's own.
    json efficiency(const MethodResult& result, std::string& reason) const {
        const auto f2b = std::ranges::find_if(
            m_run.results, [](const MethodResult& other) { return other.method.id == "f2b" && other.status == "ok"; });
        const double own_ms = m_timings.median_ms(result);
        if (f2b == m_run.results.end()) {
            reason = "f2b is not among the methods that ran";
        } else if (!result.fragments.needed) {
            reason = result.fragments.no_needed_reason;
        } else if (m_run.overdraw.total() == 0) {
            reason = "no fragment is submitted";
        } else if (own_ms <= 0) {
            reason = "the method took no time";
        } else {
            return m_timings.median_ms(*f2b) * static_cast<double>(result.fragments.needed->total()) /
                   static_cast<double>(m_run.overdraw.total()) / own_ms;
        }
        return nullptr;
    }

    json fragments(const MethodResult& result) const {
        std::string reason;
        json object = {{"submitted", m_run.overdraw.total()},
                       {"shaded", nullptr},
                       {"shaded_by", nullptr},
                       {"visible", nullptr},
                       {"needed", nullptr},
                       {"efficiency", efficiency(result, reason)}};
        if (!reason.empty()) object["efficiency_reason"] = reason;
        const auto set = [&](const std::string& key, const std::optional<PixelCounts>& counts,
                             const std::string& why_not) {
            if (counts) {
                object[key] = counts->total();
            } else {
                object[key + "_reason"] = why_not;
            }
        };
        set("shaded", result.fragments.shaded, result.fragments.no_shaded_reason);
        if (result.fragments.shaded) object["shaded_by"] = result.fragments.shaded_by;
        set("visible", result.fragments.visible, result.fragments.no_visible_reason);
        set("needed", result.fragments.needed, result.fragments.no_needed_reason);
        return object;
    }

    /// All of a run share one scale, so that equal colours are equal numbers from picture to picture.
    std::uint32_t count_scale() const {
        std::uint32_t scale = m_run.overdraw.greatest();
        for (const MethodResult& result : m_run.results)
            if (result.fragments.shaded) scale = std::max(scale, result.fragments.shaded->greatest());
        return scale;
    }

    json count_image(const PixelCounts& counts, const std::string& name) const {
        const std::uint32_t scale = count_scale();
        json image = m_pictures->take(count_picture(counts, scale), name);
        image["greatest"] = counts.greatest();
        image["full_scale"] = scale;
        return image;
    }

    json count_images(const MethodResult& result, const std::string& name) const {
        json images = json::object();
        if (!m_pictures) return images;
        if (!m_overdraw.is_null()) images["overdraw"] = m_overdraw;
        const auto add = [&](const std::string& key, const std::optional<PixelCounts>& counts) {
            if (!counts) return;
            images[key] = count_image(*counts, picture_name(name, key + ".png"));
            // A picture of 256 colours cannot tell more counts apart.
            if (count_scale() > most_counts_in_colours)
                images[key + "_counts"] = m_pictures->take(*counts, picture_name(name, key + ".exr"));
        };
        add("shaded", result.fragments.shaded);
        add("saturation", result.fragments.saturation);
        return images;
    }

    const Spec& m_spec;
    const Run& m_run;
    PictureSink* m_pictures;  ///< may be null
    const std::string m_prefix;
    const Timings m_timings;
    json m_overdraw;  ///< the same for every method; null where it was not counted
};

/// What a check came to, and why where its value does not say it.
struct Outcome {
    std::string word;  ///< passed, failed, undecided
    json reason;
};

/// A time passes or fails by its interval: where that holds the limit, nothing is decided. All else is exact.
Outcome outcome_of(const CheckSpec& check, const json& run, const json& result) {
    if (run["nothing_drawn"].is_string()) return {"failed", run["nothing_drawn"]};
    const std::optional<Measured> value = measured_with_interval(result, check.metric);
    if (!value) {
        // PSNR is null where the pictures are identical, which passes any minimum.
        const bool identical = check.metric == "psnr" && result["metrics"].is_object();
        if (identical && check.max.is_null()) return {"passed", nullptr};
        return {"failed", no_measure_reason(result, check.metric)};
    }
    if ((check.min.is_null() || value->low >= check.min) && (check.max.is_null() || value->high <= check.max))
        return {"passed", nullptr};
    if ((!check.min.is_null() && value->high < check.min) || (!check.max.is_null() && value->low > check.max))
        return {"failed", nullptr};
    if (std::isinf(value->low)) return {"undecided", "there are too few rounds for an interval"};
    return {"undecided", fmt::format("the limit lies within its interval [{}, {}]", number_text(value->low),
                                     number_text(value->high))};
}

json check_all(const std::vector<CheckSpec>& checks, const json& runs) {
    json all = json::array();
    for (const CheckSpec& check : checks) {
        for (const json& run : runs) {
            const json* result = find_result(run, check.method);
            if (!result || !lies_at(run["point"], check.at)) continue;
            const Outcome outcome = outcome_of(check, run, *result);
            all.push_back({{"metric", check.metric},
                           {"method", check.method},
                           {"at", run["point"]},
                           {"min", check.min},
                           {"max", check.max},
                           {"value", measured(*result, check.metric)},
                           {"outcome", outcome.word},
                           {"passed", outcome.word == "passed"},
                           {"reason", outcome.reason}});
        }
    }
    return all;
}

/// Appends those of `more` that are not there yet.
void add_new(json& all, const json& more) {
    for (const json& one : more)
        if (std::ranges::find(all, one) == all.end()) all.push_back(one);
}

/// Every note of the runs and their results, each once.
json all_notes(const json& runs) {
    json all = json::array();
    for (const json& run : runs) {
        add_new(all, run["notes"]);
        for (const json& result : run["results"]) add_new(all, result["notes"]);
    }
    return all;
}

/// Every file of the runs, each once.
json all_files(const json& runs) {
    json all = json::array();
    for (const json& run : runs) add_new(all, run["files"]);
    return all;
}

/// What failed to render, a sentence each.
std::vector<std::string> failures(const json& runs) {
    std::vector<std::string> all;
    const auto add = [&](const json& run, const std::string& what, const json& one) {
        if (one["status"] != "failed") return;
        const std::string at = run["point"].empty() ? "" : " at " + describe_point(run["point"]);
        all.push_back(fmt::format("{} failed{}: {}", what, at,
                                  one["reason"].is_string() ? one["reason"].get<std::string>() : "no reason"));
    };
    for (const json& run : runs) {
        add(run, "the reference " + run["reference"]["method"].get<std::string>(), run["reference"]);
        for (const json& result : run["results"]) add(run, result["label"], result);
    }
    return all;
}

/// What could not be rendered is a failure whether or not a check asks for it.
void judge(json& report) {
    const json& checks = report["checks"];
    const auto count = [&](const std::string& outcome) {
        return std::ranges::count_if(checks, [&](const json& check) { return check["outcome"] == outcome; });
    };
    const auto failed = count("failed"), undecided = count("undecided");
    std::vector<std::string> reasons = failures(report["runs"]);
    report["verdict"] = failed > 0 || !reasons.empty() ? "failed"
                        : undecided > 0                ? "undecided"
                        : checks.empty()               ? "none"
                                                       : "passed";
    for (const json& run : report["runs"])
        if (run["nothing_drawn"].is_string()) {
            const std::string at = run["point"].empty() ? "" : "at " + describe_point(run["point"]) + ": ";
            reasons.push_back(at + run["nothing_drawn"].get<std::string>());
        }
    if (undecided > 0)
        reasons.insert(reasons.begin(), fmt::format("{} of {} checks undecided", undecided, checks.size()));
    if (failed > 0) reasons.insert(reasons.begin(), fmt::format("{} of {} checks failed", failed, checks.size()));
    report["verdict_reason"] = reasons.empty() ? json() : json(fmt::format("{}", fmt::join(reasons, "; ")));
}

}  // namespace

ReportMaker::ReportMaker(const Spec& spec, const Device& device, PictureSink* pictures, const std::string& created_at)
    : m_spec(spec), m_software(device.info.software), m_pictures(pictures) {
    m_report = {{"status", "done"},          {"progress", 1.0},
                {"error", nullptr},          {"created_at", created_at},
                {"spec", m_spec.normalised}, {"spec_sha256", sha256_hex(m_spec.canonical_text())},
                {"runs", json::array()},     {"device", device_json(device)}};
    m_report["color_space"] = color_space();
    m_report["provenance"] = provenance_json(device);
}

void ReportMaker::add(const Run& run) {
    json& runs = m_report["runs"];
    runs.push_back(RunWriter(m_spec, run, m_software, m_pictures, run_prefix(m_spec, runs.size())).write());
}

json ReportMaker::finish() {
    const json& runs = m_report["runs"];
    if (const Suite* suite = find_suite(m_spec.suite)) m_report["suite"] = suite_report(*suite, runs);
    m_report["checks"] = check_all(m_spec.checks, runs);
    judge(m_report);
    m_report["notes"] = all_notes(runs);
    m_report["files"] = all_files(runs);
    m_report["points"] = {{"asked", m_spec.points.size()}, {"done", runs.size()}};
    json& load = m_report["provenance"]["load"];
    load["end"] = load_average();
    if (load["start"].is_null() || load["end"].is_null()) load["reason"] = "/proc/loadavg does not say";
    m_report["finished_at"] = utc_now();
    return std::move(m_report);
}

json ReportMaker::finish_early(const std::string& status, const std::string& title, const std::string& detail) {
    const std::size_t asked = m_spec.points.size(), done = runs();
    json report = finish();
    report["status"] = status;
    report["verdict"] = "failed";
    report["progress"] = static_cast<double>(done) / static_cast<double>(asked);
    report["error"] = {{"title", title}, {"detail", detail}};
    const std::string text = fmt::format("Only {} of {} points were rendered: {}", done, asked, detail);
    report["notes"].insert(report["notes"].begin(), to_json({Note{"incomplete", text, ""}})[0]);
    return report;
}

std::vector<std::string> picture_stems(const Spec& spec) {
    std::vector<std::string> stems;
    for (std::size_t run = 0; run < spec.points.size(); ++run) {
        const std::string prefix = run_prefix(spec, run);
        stems.push_back(prefix + "overdraw");
        stems.push_back(prefix + file_name("reference-" + spec.reference.id));
        for (std::size_t i = 0; i < spec.methods.size(); ++i)
            stems.push_back(prefix + file_name(result_name(i, spec.methods[i])));
    }
    return stems;
}

std::string context_arguments(const Device& device) {
    if (device.info.context.empty() || device.info.name.empty()) return "";
    return fmt::format(" --context {} --device {}", device.info.context, device.info.name);
}

std::string utc_now() {
    const auto now = std::chrono::system_clock::now();
    const auto milliseconds =
        std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(now)),
                       milliseconds);
}

}  // namespace sheer
