#include "renderer/report/report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>

#include "renderer/core/clock.h"
#include "renderer/core/number_text.h"
#include "renderer/core/sha256.h"
#include "renderer/image/magma.h"
#include "renderer/report/frontier.h"
#include "renderer/report/growth.h"
#include "renderer/report/provenance.h"
#include "renderer/report/qualification.h"
#include "renderer/report/suite.h"
#include "renderer/report/timing.h"
#include "renderer/results/quantity.h"
#include "version.h"

namespace sheer {

using report::Report, report::Result, report::ResultStatus, report::Pictures;

namespace {

/// A file name: characters other than letters and digits become dashes.
std::string file_name(const std::string& label) {
    std::string name;
    for (const char c : label) name += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' ? c : '-';
    return name;
}

/// The prefix of the names of a run's pictures: its number, if there are several runs.
std::string run_prefix(const Spec& spec, std::size_t run) {
    return spec.points.size() > 1 ? fmt::format("{:03}-", run + 1) : "";
}

std::string result_name(std::size_t index, const MethodSpec& method) {
    return fmt::format("{}-{}", index + 1, method.label);
}

report::File told_file(const SourceFile& source) {
    return {source.pointer, source.file.name, source.file.of, source.file.sha256,
            static_cast<std::int64_t>(source.file.bytes)};
}

report::Device told_device(const Device& device) {
    report::Device told{device.info};
    told.extensions.clear();
    const std::string driver = driver_of(device.info.gl_version);
    if (driver.empty()) {
        told.driver.reason = "the version of OpenGL does not name it";
    } else {
        told.driver.value = driver;
    }
    told.cpu = cpu_name();
    told.workarounds = device.workarounds;
    return told;
}

/// How the report was made, and the state of the machine when it was started.
report::Provenance begin_provenance(const Device& device) {
    report::Provenance provenance;
    provenance.version = version;
    provenance.commit = commit;
    provenance.rerun = "sheer compare SPEC.json" + context_arguments(device);
    provenance.cores = std::thread::hardware_concurrency();
    provenance.load.start = load_average();
    provenance.governor = governor();
    return provenance;
}

report::Metrics told_metrics(const Metrics& metrics) {
    return {metrics.values};
}

OrReason<std::int64_t> count_of(const std::optional<PixelCounts>& counts, const std::string& why_not) {
    if (!counts) return {{}, why_not};
    return {static_cast<std::int64_t>(counts->total()), ""};
}

/// A run of the report; its pictures go into the sink, if there is one.
class RunWriter {
  public:
    /// `prefix` comes before the names of the pictures.
    RunWriter(const Spec& spec, const Run& run, bool software, PictureSink* pictures, const std::string& prefix)
        : m_spec(spec), m_run(run), m_pictures(pictures), m_prefix(prefix), m_timings(run, spec.baseline, software) {
        if (pictures && !run.overdraw.counts.empty()) m_overdraw = count_image(run.overdraw, prefix + "overdraw.png");
    }

    report::Run write() const {
        report::Run run;
        run.point = m_run.point;
        run.reference = reference();
        run.rounds = {static_cast<std::size_t>(m_spec.timing.rounds), static_cast<std::size_t>(m_run.rounds_done),
                      m_timings.needed_rounds(), static_cast<std::size_t>(m_run.looks)};
        run.noise_floor = m_timings.noise();
        run.nothing_drawn = m_run.nothing_drawn;
        run.notes = m_run.notes;
        for (const SourceFile& source : m_run.files) run.files.push_back(told_file(source));
        for (std::size_t i = 0; i < m_run.results.size(); ++i) {
            const MethodResult& of_method = m_run.results[i];
            run.results.push_back(result(of_method, result_name(i, of_method.method)));
        }
        run.frontier = frontier(run, m_spec.baseline);
        return run;
    }

  private:
    std::string picture_name(const std::string& label, const std::string& ending) const {
        return fmt::format("{}{}.{}", m_prefix, file_name(label), ending);
    }

    Pictures pictures(const Image& image, const std::string& label, bool linear) const {
        if (!m_pictures) return {};
        Pictures all{{"color", m_pictures->take(quantize(image), picture_name(label, "color.png"))}};
        if (linear) all["linear"] = m_pictures->take(image, picture_name(label, "linear.exr"));
        return all;
    }

    void add_opacity(const Image8& opacity, const std::string& label, Pictures& images) const {
        if (m_pictures && !opacity.rgb.empty())
            images["opacity"] = m_pictures->take(opacity, picture_name(label, "opacity.png"));
    }

    report::Reference reference() const {
        report::Reference reference;
        reference.method = m_run.reference.id;
        reference.parameters = m_run.reference.parameters;
        reference.status = m_run.reference_status;
        reference.reason = m_run.reference_reason;
        reference.images = reference_pictures();
        reference.findings = m_run.reference_findings;
        reference.residual.depth_peeling = m_run.residual;
        if (!m_run.residual) reference.residual_reason = m_run.no_residual_reason;
        if (m_run.format_cost)
            reference.rounded = {fmt::format("{} in {}", m_run.reference.id, to_string(m_run.image.format)),
                                 to_string(m_run.image.format), told_metrics(*m_run.format_cost)};
        return reference;
    }

    /// The reference's picture as shown is rounded like the methods' pictures, which are compared with it.
    Pictures reference_pictures() const {
        if (m_run.reference_status != report::ResultStatus::ok) return {};
        const std::string label = "reference-" + m_run.reference.id;
        const Image& shown = m_run.format_cost ? m_run.reference_as_shown : m_run.reference_image;
        Pictures all = pictures(shown, label, false);
        if (m_pictures) all["linear"] = m_pictures->take(m_run.reference_image, picture_name(label, "linear.exr"));
        add_opacity(m_run.reference_opacity, label, all);
        return all;
    }

    Result result(const MethodResult& of_method, const std::string& name) const {
        Result result{.method = of_method.method.id, .label = of_method.method.label};
        result.parameters = of_method.method.parameters;
        result.status = of_method.status;
        result.reason = of_method.reason;
        result.speedup = m_timings.speedup(of_method);
        result.speedup_with_sort = m_timings.speedup_with_sort(of_method);
        result.findings = of_method.findings;
        result.notes = of_method.notes;
        if (result.status != ResultStatus::ok) return result;
        result.images = pictures(of_method.image, name, m_run.image.format != PixelFormat::rgba8);
        add_opacity(of_method.opacity, name, result.images);
        add_count_images(of_method, name, result.images);
        result.timing = m_timings.timing(of_method);
        result.fragments = fragments(of_method);
        result.memory_bytes = of_method.memory_bytes;
        if (of_method.metrics) {
            result.metrics.value = told_metrics(*of_method.metrics);
            if (m_pictures)
                for (const auto& [key, picture] : of_method.metrics->pictures)
                    result.images[key] = m_pictures->take(picture, picture_name(name, key + ".png"));
        } else {
            result.metrics.reason = of_method.no_metrics_reason;
        }
        add_change(of_method, name, result);
        return result;
    }

    /// What the method's own look changes, and the pictures that only such a method has.
    void add_change(const MethodResult& of_method, const std::string& name, Result& result) const {
        result.change.reason = of_method.no_change_reason;
        if (m_pictures && !of_method.own_reference.rgba.empty())
            result.images["exact"] =
                m_pictures->take(quantize(of_method.own_reference), picture_name(name, "exact.png"));
        if (!of_method.change) return;
        result.change.value = report::Change{.from = of_method.change->from,
                                             .is_identical = of_method.change->is_identical,
                                             .metrics = told_metrics(of_method.change->metrics),
                                             .speedup = m_timings.change(of_method)};
        if (!m_pictures) return;
        for (const auto& [key, picture] : of_method.change->metrics.pictures)
            result.images["change_" + key] = m_pictures->take(picture, picture_name(name, "change_" + key + ".png"));
    }

    /// The ideal time (that of f2b for only the needed fragments) over the method's own.
    OrReason<double> efficiency(const MethodResult& result) const {
        const auto f2b = std::ranges::find_if(m_run.results, [](const MethodResult& other) {
            return other.method.id == "f2b" && other.status == report::ResultStatus::ok;
        });
        const double own_ms = m_timings.median_ms(result);
        if (f2b == m_run.results.end()) return {{}, "f2b is not among the methods that ran"};
        if (!result.fragments.needed) return {{}, result.fragments.no_needed_reason};
        if (m_run.overdraw.total() == 0) return {{}, "no fragment is submitted"};
        if (own_ms <= 0) return {{}, "the method took no time"};
        return {m_timings.median_ms(*f2b) * static_cast<double>(result.fragments.needed->total()) /
                    static_cast<double>(m_run.overdraw.total()) / own_ms,
                ""};
    }

    /// What its warps cost, in texture reads: one for the start of each and its test, and the shading of the live ones.
    static OrReason<double> model_cost(const MethodResult& result) {
        const FragmentCounts& counts = result.fragments;
        if (!counts.warps) return {{}, counts.no_warps_reason};
        if (!counts.reads) return {{}, "how many textures the shading reads depends on the fragment"};
        return {static_cast<double>(counts.warps->warps + counts.warps->live_warps * *counts.reads), ""};
    }

    OrReason<double> model_speedup(const MethodResult& result) const {
        const auto baseline = std::ranges::find_if(m_run.results, [this](const MethodResult& other) {
            return other.method.label == m_spec.baseline && other.status == report::ResultStatus::ok;
        });
        if (baseline == m_run.results.end()) return {{}, "the baseline did not run"};
        const OrReason<double> of_baseline = model_cost(*baseline), own = model_cost(result);
        if (!own) return own;
        if (!of_baseline) return {{}, "of the baseline: " + of_baseline.reason};
        if (*own == 0) return {{}, "no warp starts"};
        return {*of_baseline / *own, ""};
    }

    static OrReason<std::int64_t> warps_of(const FragmentCounts& counts, std::int64_t WarpCounts::*which) {
        if (!counts.warps) return {{}, counts.no_warps_reason};
        return {(*counts.warps).*which, ""};
    }

    report::Fragments fragments(const MethodResult& result) const {
        const FragmentCounts& counts = result.fragments;
        return {.submitted = static_cast<std::int64_t>(m_run.overdraw.total()),
                .shaded = count_of(counts.shaded, counts.no_shaded_reason),
                .visible = count_of(counts.visible, counts.no_visible_reason),
                .needed = count_of(counts.needed, counts.no_needed_reason),
                .shaded_by = counts.shaded ? counts.shaded_by : "",
                .quads = warps_of(counts, &WarpCounts::quads),
                .live_quads = warps_of(counts, &WarpCounts::live_quads),
                .warps = warps_of(counts, &WarpCounts::warps),
                .live_warps = warps_of(counts, &WarpCounts::live_warps),
                .model_speedup = model_speedup(result),
                .efficiency = efficiency(result)};
    }

    /// All pictures of a run share one scale, so that equal colors are equal numbers in all of them.
    std::uint32_t count_scale() const {
        std::uint32_t scale = m_run.overdraw.greatest();
        for (const MethodResult& result : m_run.results)
            if (result.fragments.shaded) scale = std::max(scale, result.fragments.shaded->greatest());
        return scale;
    }

    report::Picture count_image(const PixelCounts& counts, const std::string& name) const {
        const std::uint32_t scale = count_scale();
        report::Picture image = m_pictures->take(count_picture(counts, scale), name);
        image.greatest = counts.greatest();
        image.full_scale = scale;
        return image;
    }

    void add_count_images(const MethodResult& result, const std::string& name, Pictures& images) const {
        if (!m_pictures) return;
        if (m_overdraw) images["overdraw"] = *m_overdraw;
        const auto add = [&](const std::string& key, const std::optional<PixelCounts>& counts) {
            if (!counts) return;
            images[key] = count_image(*counts, picture_name(name, key + ".png"));
            // A picture with 256 colors cannot distinguish more counts.
            if (count_scale() > most_counts_in_colors)
                images[key + "_counts"] = m_pictures->take(*counts, picture_name(name, key + ".exr"));
        };
        add("shaded", result.fragments.shaded);
        add("saturation", result.fragments.saturation);
    }

    const Spec& m_spec;
    const Run& m_run;
    PictureSink* m_pictures;  ///< may be null
    const std::string m_prefix;
    const Timings m_timings;
    std::optional<report::Picture> m_overdraw;  ///< the same for every method; none if it was not counted
};

std::optional<double> number_or_none(const nlohmann::json& limit) {
    return limit.is_number() ? std::optional(limit.get<double>()) : std::nullopt;
}

/// A time passes or fails by its interval: if that contains the limit, the check is undecided. Everything else is
/// exact.
void decide(report::Check& check, const Quantity& quantity, const report::Run& run, const Result& result) {
    const auto end = [&check](report::CheckOutcome outcome, const std::string& reason) {
        check.outcome = outcome;
        check.passed = outcome == report::CheckOutcome::passed;
        check.reason = reason;
    };
    using enum report::CheckOutcome;
    if (!run.nothing_drawn.empty()) return end(failed, run.nothing_drawn);
    const std::optional<Measured> value = quantity.measure(result);
    if (!value) {
        // PSNR is null if the pictures are identical, which passes any minimum.
        const bool is_identical =
            (check.metric == "psnr" && result.metrics) || (check.metric == "change.psnr" && result.change);
        if (is_identical && !check.max) return end(passed, "");
        return end(failed, quantity.no_value_reason(result));
    }
    const double least = check.min.value_or(-std::numeric_limits<double>::infinity()),
                 greatest = check.max.value_or(std::numeric_limits<double>::infinity());
    if (value->low >= least && value->high <= greatest) return end(passed, "");
    if (value->high < least || value->low > greatest) return end(failed, "");
    if (std::isinf(value->low)) return end(undecided, "there are too few rounds for an interval");
    end(undecided,
        fmt::format("the limit lies within its interval [{}, {}]", number_text(value->low), number_text(value->high)));
}

std::vector<report::Check> check_all(const std::vector<CheckSpec>& checks, const std::vector<report::Run>& runs) {
    std::vector<report::Check> all;
    for (const CheckSpec& wanted : checks) {
        const Quantity* quantity = find_quantity(wanted.metric);
        if (!quantity) throw std::logic_error("a check names no number of the report");
        for (const report::Run& run : runs) {
            const Result* result = run.find(wanted.method);
            if (!result || !lies_at(run.point, wanted.at)) continue;
            report::Check check{.metric = wanted.metric, .method = wanted.method, .at = run.point};
            check.min = number_or_none(wanted.min);
            check.max = number_or_none(wanted.max);
            check.value = quantity->value(*result);
            decide(check, *quantity, run, *result);
            all.push_back(check);
        }
    }
    return all;
}

/// Appends those of `more` that are still missing.
template <typename T>
void add_new(std::vector<T>& all, const std::vector<T>& more) {
    for (const T& one : more)
        if (std::ranges::find(all, one) == all.end()) all.push_back(one);
}

/// Every note and every file of the runs and their results, each once.
void collect(Report& report) {
    for (const report::Run& run : report.runs) {
        add_new(report.notes, run.notes);
        for (const Result& result : run.results) add_new(report.notes, result.notes);
        add_new(report.files, run.files);
    }
}

/// Of several devices.
const report::DevicePart* failed_device(const Report& report, const report::Run& run) {
    const std::string label = run.point.value(device_pointer, "");
    const auto found = std::ranges::find(report.devices, label, &report::DevicePart::label);
    return found != report.devices.end() && found->status == report::Status::failed ? &*found : nullptr;
}

/// A sentence for each failure to render; one for a device that rendered nothing.
std::vector<std::string> failures(const Report& report) {
    std::vector<std::string> all;
    for (const report::DevicePart& part : report.devices)
        if (part.status == report::Status::failed)
            all.push_back(fmt::format("the device {} failed: {}", part.label, part.reason));
    const auto add = [&](const report::Run& run, const std::string& what, const auto& one) {
        if (one.status != ResultStatus::failed) return;
        const std::string at = run.point.empty() ? "" : " at " + describe_point(run.point);
        all.push_back(fmt::format("{} failed{}: {}", what, at, one.reason.empty() ? "no reason" : one.reason));
    };
    for (const report::Run& run : report.runs) {
        if (failed_device(report, run)) continue;
        add(run, "the reference " + run.reference.method, run.reference);
        for (const Result& result : run.results) add(run, result.label, result);
    }
    return all;
}

}  // namespace

void judge(Report& report) {
    using enum report::ReportVerdict;
    const std::size_t checks = report.checks.size();
    const auto count = [&](report::CheckOutcome outcome) {
        return std::ranges::count(report.checks, outcome, &report::Check::came_out);
    };
    const auto failed_checks = count(report::CheckOutcome::failed), open = count(report::CheckOutcome::undecided);
    std::vector<std::string> reasons = failures(report);
    const std::string on_undecided = report.spec.value("on_undecided", "neutral");
    const bool fails = failed_checks > 0 || !reasons.empty() || (open > 0 && on_undecided == "fail");
    report.verdict = fails ? failed : open > 0 && on_undecided == "neutral" ? undecided : checks == 0 ? none : passed;
    for (const report::Run& run : report.runs)
        if (!run.nothing_drawn.empty() && !failed_device(report, run)) {
            const std::string at = run.point.empty() ? "" : "at " + describe_point(run.point) + ": ";
            reasons.push_back(at + run.nothing_drawn);
        }
    if (open > 0) {
        const std::string counts = on_undecided == "fail"   ? ", which counts as failed"
                                   : on_undecided == "pass" ? ", which counts as passed"
                                                            : "";
        reasons.insert(reasons.begin(), fmt::format("{} of {} checks undecided{}", open, checks, counts));
    }
    if (failed_checks > 0)
        reasons.insert(reasons.begin(), fmt::format("{} of {} checks failed", failed_checks, checks));
    report.verdict_reason = fmt::format("{}", fmt::join(reasons, "; "));
}

void require_checks(Report& report) {
    if (!report.checks.empty()) return;
    report.checks.push_back({.metric = "checks",
                             .method = "the gate",
                             .outcome = report::CheckOutcome::failed,
                             .reason = "the spec has none, so the gate would let everything pass"});
    judge(report);
}

ReportMaker::ReportMaker(const Spec& spec, const Device& device, PictureSink* pictures, const std::string& created_at)
    : m_spec(spec), m_software(device.info.software), m_pictures(pictures) {
    m_report.created_at = created_at;
    m_report.spec = spec.normalised;
    m_report.spec_sha256 = sha256_hex(spec.canonical_text());
    m_report.device = told_device(device);
    m_report.color_space = color_space();
    m_report.provenance = begin_provenance(device);
}

void ReportMaker::add(const Run& run) {
    m_report.runs.push_back(RunWriter(m_spec, run, m_software, m_pictures, run_prefix(m_spec, runs())).write());
}

UndecidedFunction ReportMaker::undecided() const {
    std::vector<CheckSpec> timed;
    for (const CheckSpec& check : m_spec.checks)
        if (const Quantity* quantity = find_quantity(check.metric); quantity && quantity->has_interval)
            timed.push_back(check);
    if (timed.empty()) return {};
    return [this, timed](const Run& run) {
        const std::vector<report::Check> checks =
            check_all(timed, {RunWriter(m_spec, run, m_software, nullptr, "").write()});
        return std::ranges::count(checks, report::CheckOutcome::undecided, &report::Check::came_out) > 0;
    };
}

Report ReportMaker::finish() {
    if (const Suite* suite = find_suite(m_spec.suite)) m_report.suite = suite_report(*suite, m_report.runs);
    m_report.growth = growth_of(m_report.spec.value("sweep", json::array()), m_report.runs);
    m_report.checks = check_all(m_spec.checks, m_report.runs);
    judge(m_report);
    collect(m_report);
    m_report.points = {m_spec.points.size(), runs()};
    report::Load& load = m_report.provenance.load;
    load.end = load_average();
    if (!load.start || !load.end) load.reason = "/proc/loadavg does not say";
    if (m_report.device) m_report.qualification = last_qualification(qualifications_file(), *m_report.device);
    m_report.finished_at = utc_now();
    return std::move(m_report);
}

Report ReportMaker::finish_early(report::Status status, const std::string& title, const std::string& detail) {
    const std::size_t asked = m_spec.points.size(), done = runs();
    Report report = finish();
    report.status = status;
    report.verdict = report::ReportVerdict::failed;
    report.progress = static_cast<double>(done) / static_cast<double>(asked);
    report.error = report::Error{title, detail};
    const std::string text = fmt::format("Only {} of {} points were rendered: {}", done, asked, detail);
    report.notes.insert(report.notes.begin(), {"incomplete", text, ""});
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

}  // namespace sheer
