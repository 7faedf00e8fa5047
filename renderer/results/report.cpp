#include "renderer/results/report.h"

#include <algorithm>

#include "renderer/results/schemas.h"

namespace sheer::report {

const Result* Run::find(const std::string& label) const {
    const auto found = std::ranges::find(results, label, &report::Result::label);
    return found == results.end() ? nullptr : &*found;
}

CheckOutcome Check::came_out() const {
    return outcome.value_or(passed ? CheckOutcome::passed : CheckOutcome::failed);
}

std::string Report::title() const {
    return spec.value("title", "");
}

std::string Report::baseline() const {
    return spec.value("baseline", "");
}

std::vector<Picture> Report::pictures() const {
    std::vector<Picture> all;
    for (const Run& run : runs) {
        for (const auto& [key, picture] : run.reference.images) all.push_back(picture);
        for (const Result& result : run.results)
            for (const auto& [key, picture] : result.images) all.push_back(picture);
    }
    return all;
}

}  // namespace sheer::report

namespace sheer {

using nlohmann::json;

template <>
const Description<report::Rounded>& description_of() {
    static const auto description =
        Description<report::Rounded>("Rounded", "the error of the image format alone")
            .member(&report::Rounded::label, "label", "such as \"exact in rgba8\"")
            .member(&report::Rounded::format, "format", "")
            .member(&report::Rounded::metrics, "metrics",
                    "of the reference, rounded like the methods' pictures, compared with the unrounded one");
    return description;
}

template <>
const Description<report::Residual>& description_of() {
    static const auto description =
        Description<report::Residual>("Residual", "the difference between the reference and another one")
            .member(&report::Residual::depth_peeling, "depth_peeling",
                    "greatest difference of a channel from depth peeling, 0..1");
    return description;
}

template <>
const Description<report::Reference>& description_of() {
    static const auto description =
        Description<report::Reference>("Reference", "the picture with which those of the methods are compared")
            .member(&report::Reference::method, "method", "its id")
            .json(&report::Reference::parameters, "parameters", "with defaults filled in", parameters_schema)
            .member(&report::Reference::status, "status", "without a reference nothing has metrics")
            .text_or_null(&report::Reference::reason, "reason", "why the status is not ok")
            .member(&report::Reference::images, "images",
                    "color: rounded like the methods' pictures; linear: in 32-bit floats; opacity: how much of the "
                    "background each channel hides")
            .json(&report::Reference::findings, "findings", "values that only this method reports", findings_schema)
            .member(&report::Reference::residual, "residual", "")
            .maybe(&report::Reference::residual_reason, "residual_reason", "why residual.depth_peeling is null")
            .maybe(&report::Reference::rounded, "rounded", "absent if the reference has no metrics");
    return description;
}

template <>
const Description<report::Rounds>& description_of() {
    static const auto description =
        Description<report::Rounds>("Rounds", "timed frames of each method")
            .member(&report::Rounds::asked, "asked", "number in the spec")
            .member(&report::Rounds::done, "done", "fewer if max_seconds ended them, more if checks were undecided")
            .member(&report::Rounds::needed, "needed", "number without which speedups have no intervals")
            .member(&report::Rounds::looks, "looks",
                    "how often checks on times were judged, each time with twice the rounds; all intervals are so wide "
                    "that those of all looks hold together (docs/measuring.md); 0 without such checks");
    return description;
}

template <>
const Description<report::Dominated>& description_of() {
    static const auto description = Description<report::Dominated>("Dominated", "a method that another one beats")
                                        .member(&report::Dominated::method, "method", "its label")
                                        .member(&report::Dominated::by, "by", "label of the other one")
                                        .member(&report::Dominated::reason, "reason", "");
    return description;
}

template <>
const Description<report::Winner>& description_of() {
    static const auto description =
        Description<report::Winner>("Winner", "a method and those with which it ties")
            .member(&report::Winner::method, "method", "its label; null if none may be called first")
            .member(&report::Winner::tied, "tied", "labels of those whose difference from it is not resolved");
    return description;
}

template <>
const Description<report::FastestUnder>& description_of() {
    static const auto description =
        Description<report::FastestUnder>("FastestUnder", "the fastest method under an error")
            .with(description_of<report::Winner>())
            .member(&report::FastestUnder::error, "error", "greatest mean FLIP error");
    return description;
}

template <>
const Description<report::ClosestWithin>& description_of() {
    static const auto description =
        Description<report::ClosestWithin>("ClosestWithin", "the method closest to the reference at a speed")
            .with(description_of<report::Winner>())
            .member(&report::ClosestWithin::speed, "speed", "least speed, as a factor of the baseline's");
    return description;
}

template <>
const Description<report::LeastMemoryUnder>& description_of() {
    static const auto description =
        Description<report::LeastMemoryUnder>("LeastMemoryUnder", "the method with the least memory under an error")
            .with(description_of<report::Winner>())
            .member(&report::LeastMemoryUnder::error, "error", "greatest mean FLIP error")
            .member(&report::LeastMemoryUnder::memory_bytes, "memory_bytes", "what it needs");
    return description;
}

template <>
const Description<report::Frontier>& description_of() {
    static const auto description =
        Description<report::Frontier>("Frontier", "the methods that no other one beats in time, error and memory")
            .member(&report::Frontier::error, "error", "the metric used as the error")
            .member(&report::Frontier::fastest, "fastest", "labels of the methods that may be called fastest")
            .member(&report::Frontier::methods, "methods", "labels of those that none beats, by increasing time")
            .member(&report::Frontier::dominated, "dominated", "the others")
            .member(&report::Frontier::fastest_under, "fastest_under", "")
            .member(&report::Frontier::closest_within, "closest_within", "")
            .maybe(&report::Frontier::least_memory_under, "least_memory_under",
                   "absent if the memory of a method is not known")
            .member(&report::Frontier::sentences, "sentences", "the same in words");
    return description;
}

template <>
const Description<report::Run>& description_of() {
    static const auto description =
        Description<report::Run>("Run", "the comparison at one point of the sweep")
            .json(&report::Run::point, "point",
                  "the values that are set, by JSON pointer into the spec; {} without a sweep; of several devices, "
                  "/device is the label",
                  point_schema)
            .member(&report::Run::reference, "reference", "")
            .member(&report::Run::rounds, "rounds", "")
            .member(&report::Run::noise_floor, "noise_floor", "null if the baseline did not run")
            .text_or_null(&report::Run::nothing_drawn, "nothing_drawn",
                          "why there is nothing to compare; null if there is something")
            .member(&report::Run::notes, "notes", "on the scene and its files")
            .member(&report::Run::files, "files", "from which the scene was made")
            .member(&report::Run::results, "results", "in the order of the spec's methods")
            .member(&report::Run::frontier, "frontier", "null if fewer than two methods have a time and an error");
    return description;
}

template <>
const Description<report::Growth>& description_of() {
    static const auto description =
        Description<report::Growth>("Growth", "how a method's median time or memory grows along an axis of the sweep")
            .member(&report::Growth::metric, "metric", "timing.median or memory_bytes")
            .member(&report::Growth::pointer, "pointer",
                    "of the field, which is a number above 0 at these points; the first one if the axis sets "
                    "several together")
            .json(&report::Growth::at, "at", "the values of the other fields of the sweep", point_schema)
            .member(&report::Growth::method, "method", "label")
            .member(&report::Growth::exponent, "exponent",
                    "p of y = a x^p, by least squares of the logarithms: 1 if twice the value takes twice the time or "
                    "memory")
            .member(&report::Growth::ci95, "ci95",
                    "its 95 % interval by Student's t, from how far the points lie from the line")
            .member(&report::Growth::points, "points", "number of points, at least 3");
    return description;
}

template <>
const Description<report::Check>& description_of() {
    static const auto description =
        Description<report::Check>("Check", "a check of the spec, at one point of the sweep")
            .member(&report::Check::metric, "metric", "the number that is checked, such as flip.mean")
            .member(&report::Check::method, "method", "label")
            .json(&report::Check::at, "at", "the point of the sweep", point_schema)
            .member(&report::Check::min, "min", "least value that passes; null for no limit")
            .member(&report::Check::max, "max", "greatest value that passes; null for no limit")
            .member(&report::Check::value, "value",
                    "the measured value; null if nothing was measured, and for an infinite PSNR")
            .member(&report::Check::outcome, "outcome", "a time is undecided if the limit lies within its interval")
            .member(&report::Check::passed, "passed", "whether the outcome is passed")
            .text_or_null(&report::Check::reason, "reason", "explains the outcome if the value does not");
    return description;
}

template <>
const Description<report::Device>& description_of() {
    static const auto description =
        Description<report::Device>("Device", "the device that rendered")
            .member(&report::Device::context, "context", "egl, osmesa or glfw")
            .member(&report::Device::index, "index", "index among the devices of this context, from 0")
            .member(&report::Device::name, "name", "its name for --device")
            .member(&report::Device::renderer, "renderer", "GL_RENDERER")
            .member(&report::Device::vendor, "vendor", "GL_VENDOR")
            .member(&report::Device::gl_version, "gl_version", "GL_VERSION")
            .member(&report::Device::glsl_version, "glsl_version", "GL_SHADING_LANGUAGE_VERSION")
            .member(&report::Device::platform, "platform", "how the context was made")
            .member(&report::Device::software, "software",
                    "whether it is a software rasteriser, whose times do not predict a GPU's")
            .member(&report::Device::driver, "driver", "name and version")
            .member(&report::Device::cpu, "cpu", "model name of the processor")
            .member(&report::Device::workarounds, "workarounds", "names of the driver workarounds in use");
    return description;
}

template <>
const Description<report::ColorSpace>& description_of() {
    static const auto description =
        Description<report::ColorSpace>("ColorSpace", "what the numbers of the pictures mean")
            .member(&report::ColorSpace::values, "values", "")
            .member(&report::ColorSpace::blending, "blending", "")
            .member(&report::ColorSpace::quantised_metrics, "quantised_metrics", "")
            .member(&report::ColorSpace::float_metrics, "float_metrics", "");
    return description;
}

template <>
const Description<report::Load>& description_of() {
    static const auto description =
        Description<report::Load>("Load", "how busy the machine was")
            .member(&report::Load::start, "start",
                    "mean number of runnable processes over the last 1, 5 and 15 minutes when the report was started")
            .member(&report::Load::end, "end", "the same at its end")
            .maybe(&report::Load::reason, "reason", "why one of them is null");
    return description;
}

template <>
const Description<report::Provenance>& description_of() {
    static const auto description =
        Description<report::Provenance>("Provenance", "how the report was made, and the state of the machine")
            .member(&report::Provenance::version, "version", "of Sheer")
            .member(&report::Provenance::commit, "commit", "of Sheer's source")
            .member(&report::Provenance::rerun, "rerun", "a command that makes the report again")
            .maybe(&report::Provenance::spec, "spec", "path of the spec's file; only of `sheer compare`")
            .member(&report::Provenance::cores, "cores", "number of the processor's cores")
            .member(&report::Provenance::load, "load", "")
            .member(&report::Provenance::governor, "governor", "what sets the clock of the CPUs");
    return description;
}

template <>
const Description<report::QualifiedSlowdown>& description_of() {
    using report::QualifiedSlowdown;
    static const auto description =
        Description<QualifiedSlowdown>("QualifiedSlowdown", "how often a slowdown of a known size was found")
            .member(&QualifiedSlowdown::more_work, "more_work", "share of iterations that the shading does more")
            .member(&QualifiedSlowdown::slowdown, "slowdown", "median of its time over that of the original")
            .member(&QualifiedSlowdown::found, "found", "share of the comparisons whose verdict was slower")
            .member(&QualifiedSlowdown::comparisons, "comparisons", "");
    return description;
}

template <>
const Description<report::Qualification>& description_of() {
    using report::Qualification;
    static const auto description =
        Description<Qualification>("Qualification", "how far verdicts on times can be trusted on a device")
            .member(&Qualification::at, "at", "UTC, RFC 3339")
            .member(&Qualification::renderer, "renderer", "GL_RENDERER")
            .member(&Qualification::cpu, "cpu", "model name of the processor")
            .member(&Qualification::comparisons, "comparisons", "of a shading with itself")
            .member(&Qualification::false_changes, "false_changes", "how many of them were called faster or slower")
            .member(&Qualification::false_change_rate, "false_change_rate", "their share")
            .member(&Qualification::false_change_ci95, "false_change_ci95", "its Wilson interval")
            .member(&Qualification::slowdowns, "slowdowns", "the smallest first")
            .member(&Qualification::found_from, "found_from",
                    "the slowdown from which on at least 95 % were found; null if the largest was not");
    return description;
}

template <>
const Description<report::Points>& description_of() {
    static const auto description = Description<report::Points>("Points", "number of points of the sweep")
                                        .member(&report::Points::asked, "asked", "")
                                        .member(&report::Points::done, "done", "fewer if the report was ended early");
    return description;
}

template <>
const Description<report::Figure>& description_of() {
    static const auto description =
        Description<report::Figure>("Figure", "a published figure beside the one measured here")
            .json(&report::Figure::at, "at", "the point of the sweep", point_schema)
            .member(&report::Figure::method, "method", "label")
            .member(&report::Figure::metric, "metric", "")
            .json(&report::Figure::published, "published", "a number, or a range [low, high]",
                  [](SchemaBook&) {
                      return json{{"type", {"number", "array"}},
                                  {"items", {{"type", "number"}}},
                                  {"minItems", 2},
                                  {"maxItems", 2}};
                  })
            .member(&report::Figure::measured, "measured", "null if it was not measured")
            .member(&report::Figure::ci95, "ci95", interval_text);
    return description;
}

template <>
const Description<report::Trend>& description_of() {
    static const auto description =
        Description<report::Trend>("Trend", "a statement of the publication on its figures")
            .member(&report::Trend::text, "text", "")
            .member(&report::Trend::verdict, "verdict",
                    "holds if the measurement resolves it, fails if it resolves the opposite")
            .member(&report::Trend::detail, "detail", "the values");
    return description;
}

template <>
const Description<report::Suite>& description_of() {
    static const auto description =
        Description<report::Suite>("SuiteResult", "the published measurement that the report repeats")
            .member(&report::Suite::id, "id", "")
            .member(&report::Suite::title, "title", "")
            .member(&report::Suite::source, "source", "")
            .member(&report::Suite::device, "device", "the device on which the published figures were measured")
            .member(&report::Suite::figures, "figures", "")
            .member(&report::Suite::trends, "trends", "");
    return description;
}

template <>
const Description<report::NotAgainst>& description_of() {
    static const auto description =
        Description<report::NotAgainst>("NotAgainst", "an accepted report with which this one is not compared")
            .member(&report::NotAgainst::report, "report", "its id")
            .member(&report::NotAgainst::reason, "reason", "a sentence")
            .member(&report::NotAgainst::differing, "differing",
                    "JSON pointers into the specs of what differs although `under_test` does not list it");
    return description;
}

template <>
const Description<report::Against>& description_of() {
    static const auto description =
        Description<report::Against>("Against", "the report with which this one was compared: docs/ci.md")
            .member(&report::Against::asked, "asked", "what the spec asked for: baseline:NAME, or the id of a report")
            .member(&report::Against::report, "report", "id of the report; null if there was none to compare with")
            .text_or_null(&report::Against::accepted_at, "accepted_at",
                          "when it was accepted, UTC, RFC 3339; null if the spec names the report itself")
            .member(&report::Against::text, "text", "why this report was chosen, or why there was none: a sentence")
            .member(&report::Against::refused, "refused", "accepted reports that were tried before, and why not these");
    return description;
}

template <>
const Description<report::DevicePart>& description_of() {
    using report::DevicePart;
    static const auto description =
        Description<DevicePart>("DevicePart", "one of several devices that render a report")
            .member(&DevicePart::label, "label", "of its workers")
            .member(&DevicePart::status, "status", "queued, running, done or failed")
            .maybe(&DevicePart::reason, "reason", "why it failed")
            .maybe(&DevicePart::device, "device", "absent until the report is done, and if it failed")
            .maybe(&DevicePart::provenance, "provenance", "absent as `device` is")
            .maybe(&DevicePart::qualification, "qualification",
                   "the device's last one before this report; absent if there was none");
    return description;
}

template <>
const Description<report::AcrossDevice>& description_of() {
    using report::AcrossDevice;
    static const auto description =
        Description<AcrossDevice>("AcrossDevice", "a method on one of several devices")
            .member(&AcrossDevice::device, "device", "its label")
            .member(&AcrossDevice::median, "median", "of the method's times in ms")
            .maybe(&AcrossDevice::ci95, "ci95", "the 95 % interval of the median")
            .member(&AcrossDevice::flip, "flip",
                    "mean FLIP error of its picture beside that of the first device of the spec; null on this one")
            .maybe(&AcrossDevice::differing_pixels, "differing_pixels", "between the same two pictures");
    return description;
}

template <>
const Description<report::AcrossRow>& description_of() {
    using report::AcrossRow;
    static const auto description =
        Description<AcrossRow>("AcrossRow", "a method at one point of the sweep, on several devices")
            .json(&AcrossRow::at, "at", "the point of the sweep", point_schema)
            .member(&AcrossRow::method, "method", "label")
            .member(&AcrossRow::devices, "devices", "in the order of the spec");
    return description;
}

template <>
const Description<report::Head>& description_of() {
    static const auto description =
        Description<report::Head>("ReportHead", "the members of every report")
            .maybe(&report::Head::id, "id", "absent in the file of `sheer compare`")
            .member(&report::Head::status, "status", "")
            .member(&report::Head::progress, "progress", "fraction that is done, 0..1")
            .member(&report::Head::error, "error", "null unless the report failed or was cancelled")
            .member(&report::Head::created_at, "created_at", "UTC, RFC 3339")
            .text_or_null(&report::Head::finished_at, "finished_at", "UTC, RFC 3339; null until it is finished")
            .member(&report::Head::spec_sha256, "spec_sha256",
                    "SHA-256 of the spec with defaults filled in, keys sorted, no spaces")
            .json(&report::Head::spec, "spec", "with defaults filled in", spec_reference);
    return description;
}

template <>
const Description<report::UnfinishedReport>& description_of() {
    static const auto description =
        Description<report::UnfinishedReport>("UnfinishedReport",
                                              "a report that is queued or running, or that ended without being done")
            .with(description_of<report::Head>())
            .member(&report::UnfinishedReport::stage, "stage", "the current stage of the renderer")
            .maybe(&report::UnfinishedReport::devices, "devices", "absent unless the spec lists several")
            .member(&report::UnfinishedReport::notes, "notes", "why a queued report may have to wait long");
    return description;
}

template <>
const Description<report::Report>& description_of() {
    static const auto description =
        Description<report::Report>("Report", "a comparison of transparency methods")
            .with(description_of<report::Head>())
            .member(&report::Report::device, "device", "of several, the first one that rendered")
            .maybe(&report::Report::devices, "devices", "absent unless the spec lists several")
            .maybe(&report::Report::across_devices, "across_devices",
                   "each method at each point of the sweep, on every device; absent unless the spec lists several")
            .member(&report::Report::color_space, "color_space", "")
            .member(&report::Report::provenance, "provenance", "")
            .member(&report::Report::qualification, "qualification",
                    "the device's last qualification before this report; null if there was none: `sheer qualify`")
            .member(&report::Report::runs, "runs",
                    "one for each point of the sweep; of several devices, one for each of them and each point, in the "
                    "order of the spec")
            .member(&report::Report::growth, "growth", "for each axis of the sweep and method with enough points")
            .maybe(&report::Report::suite, "suite", "absent if the spec names no suite")
            .maybe(&report::Report::against, "against", "absent if the spec names nothing to compare with")
            .member(&report::Report::checks, "checks",
                    "each check of the spec, at each point to which it applies; then those of the comparison with the "
                    "report of `against`: against.flip.mean and against.slowdown")
            .member(&report::Report::verdict, "verdict",
                    "failed if a check failed or something could not be rendered, otherwise undecided if a check is "
                    "undecided; none without checks")
            .text_or_null(&report::Report::verdict_reason, "verdict_reason", "")
            .member(&report::Report::notes, "notes", "every note of the runs and their results, each once")
            .member(&report::Report::files, "files", "every file of the runs, each once")
            .member(&report::Report::points, "points", "");
    return description;
}

}  // namespace sheer
