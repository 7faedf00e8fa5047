// What one method gave, as a report tells it, and what its metrics look like.
#include <stdexcept>

#include "renderer/metrics/shared/metric.h"
#include "renderer/results/report.h"
#include "renderer/results/schemas.h"

namespace sheer {

using nlohmann::json;

namespace {

json field_schema(const MetricField& field) {
    switch (field.kind) {
        case MetricField::Kind::number:
            return {{"type", {"number", "null"}}};
        case MetricField::Kind::count:
            return {{"type", {"integer", "null"}}};
        case MetricField::Kind::text:
            return {{"type", {"string", "null"}}};
        case MetricField::Kind::pixel:
            return {{"type", {"array", "null"}}, {"items", {{"type", "integer"}}}, {"minItems", 2}, {"maxItems", 2}};
    }
    throw std::logic_error("a metric has a field of an unknown kind");
}

json metric_schema(const MetricInfo& metric) {
    json schema = {{"type", "object"}, {"properties", json::object()}, {"additionalProperties", false}};
    for (const MetricField& field : metric.fields) {
        json one = field_schema(field);
        one["description"] = field.summary + (field.unit.empty() ? "" : " (" + field.unit + ")");
        if (field.name.empty()) return one;
        schema["properties"][field.name] = one;
        schema["required"].push_back(field.name);
    }
    schema["properties"]["reason"] = {{"type", "string"}, {"description", "why its values are null"}};
    schema["description"] = metric.summary;
    return schema;
}

}  // namespace

namespace detail {

void Codec<report::Metrics>::read(const json& from, report::Metrics& to) {
    if (!from.is_object()) throw_wrong_type("an object", from);
    to.values = from;
}

json Codec<report::Metrics>::schema(SchemaBook& book) {
    return book.reference("Metrics", [](SchemaBook&) {
        json schema = {{"type", "object"},
                       {"description", "the metrics by their ids: docs/metrics.md"},
                       {"properties", json::object()},
                       {"additionalProperties", false}};
        for (const MetricInfo& metric : all_metrics()) schema["properties"][metric.id] = metric_schema(metric);
        return schema;
    });
}

}  // namespace detail

template <>
const Description<Note>& description_of() {
    static const auto description =
        Description<Note>("Note", "a part of the input that was ignored or not read as intended")
            .member(&Note::code, "code", "for programs, such as extension-ignored")
            .member(&Note::text, "text", "a sentence")
            .text_or_null(&Note::where, "where", "the part that it is about; null if it is about the whole");
    return description;
}

template <>
const Description<report::Error>& description_of() {
    static const auto description = Description<report::Error>("Error", "why a report is not done")
                                        .member(&report::Error::title, "title", "")
                                        .member(&report::Error::detail, "detail", "");
    return description;
}

template <>
const Description<report::File>& description_of() {
    static const auto description =
        Description<report::File>("File", "a file from which the scene was made")
            .member(&report::File::pointer, "pointer",
                    "JSON pointer of the field of the spec that refers to it, directly or through another file")
            .member(&report::File::name, "name", "as in the spec or in the file that refers to it")
            .text_or_null(&report::File::of, "of", "the file that refers to it; null if the spec itself does")
            .member(&report::File::sha256, "sha256", "of its bytes, 64 hexadecimal digits")
            .member(&report::File::bytes, "bytes", "its length");
    return description;
}

template <>
const Description<report::Picture>& description_of() {
    static const auto description =
        Description<report::Picture>("Picture", "a picture of the report")
            .member(&report::Picture::sha256, "sha256", "of the file's bytes, 64 hexadecimal digits")
            .member(&report::Picture::url, "url",
                    "of the file: relative to the report's folder, or a path of the service")
            .member(&report::Picture::media_type, "media_type",
                    "image/png for 8-bit levels, image/x-exr for floats and counts")
            .maybe(&report::Picture::greatest, "greatest", "of a picture of counts: the greatest count in it")
            .maybe(&report::Picture::full_scale, "full_scale",
                   "of a picture of counts: the count that the last color represents, the same for all such pictures "
                   "of a run");
    return description;
}

template <>
const Description<report::PassTime>& description_of() {
    static const auto description =
        Description<report::PassTime>("PassTime", "GPU time of a pass of the method")
            .member(&report::PassTime::name, "name", "passes with the same name are added up")
            .member(&report::PassTime::median, "median", "over the frames, in ms");
    return description;
}

template <>
const Description<report::TimeSummary>& description_of() {
    static const auto description =
        Description<report::TimeSummary>("TimeSummary", "a summary of the times of a method's frames")
            .member(&report::TimeSummary::samples, "samples", "every time, in the order of the rounds")
            .member(
                &report::TimeSummary::outliers, "outliers",
                "indices in `samples`, from 0, of times whose modified z-score is over 3.5; they count like all others")
            .member(&report::TimeSummary::median, "median", "")
            .member(&report::TimeSummary::mad, "mad", "median absolute deviation from the median, unscaled")
            .member(&report::TimeSummary::min, "min", "")
            .member(&report::TimeSummary::p95, "p95", "95th percentile, nearest rank")
            .member(&report::TimeSummary::ci95, "ci95", interval_text)
            .member(&report::TimeSummary::unit, "unit", "the unit of all these times: ms")
            .member(&report::TimeSummary::clock, "clock",
                    "gpu: sum of the passes' GL_TIME_ELAPSED; wall: time from one idle pipeline to the next");
    return description;
}

template <>
const Description<report::Timing>& description_of() {
    static const auto description =
        Description<report::Timing>("Timing", "how long the method's frames took: docs/measuring.md")
            .with(description_of<report::TimeSummary>())
            .member(&report::Timing::initialization, "initialization",
                    "median GPU time of preparing the method's own targets, in ms")
            .member(&report::Timing::finalization, "finalization",
                    "median GPU time of writing the result into the image, in ms")
            .member(&report::Timing::passes, "passes", "in the order in which they are drawn")
            .member(&report::Timing::gpu_samples, "gpu_samples", "by the GPU's clock, in ms")
            .member(&report::Timing::wall_samples, "wall_samples", "by the wall clock, in ms")
            .member(&report::Timing::disagreeing_samples, "disagreeing_samples",
                    "frames over 5 ms for which the two clocks differ by more than 10 %")
            .member(&report::Timing::gpu_clock_mhz, "gpu_clock_mhz",
                    "clock of the GPU's shader cores after each frame, from NVML; null if nothing tells it")
            .member(&report::Timing::retaken_samples, "retaken_samples",
                    "frames that were thrown away and timed again, since the GPU's clock was lowered")
            .member(&report::Timing::clock_lowered_by, "clock_lowered_by",
                    "what lowered the GPU's clock during any frame, such as heat")
            .member(&report::Timing::sort, "sort",
                    "time to recompute the order in each frame; not included in `samples`");
    return description;
}

template <>
const Description<report::Speedup>& description_of() {
    static const auto description =
        Description<report::Speedup>("Speedup", "the baseline's time over the method's")
            .member(&report::Speedup::value, "value", "median of the ratios round by round")
            .member(&report::Speedup::ci95, "ci95",
                    "interval of the median ratio, [low, high]; all compared methods' intervals together have 95 % "
                    "confidence; null if there are too few rounds")
            .member(&report::Speedup::verdict, "verdict",
                    "resolved if the whole interval is on one side of 1 and outside the noise floor")
            .text_or_null(&report::Speedup::reason, "reason", "why it is not resolved")
            .member(&report::Speedup::compared, "compared", "how many methods are compared with the baseline");
    return description;
}

template <>
const Description<report::NoiseFloor>& description_of() {
    static const auto description =
        Description<report::NoiseFloor>("NoiseFloor", "the baseline compared with a second instance of itself")
            .member(&report::NoiseFloor::method, "method", "label of the baseline")
            .member(&report::NoiseFloor::value, "value", "median of the ratios round by round")
            .member(&report::NoiseFloor::ci95, "ci95", interval_text)
            .member(&report::NoiseFloor::factor, "factor",
                    "a ratio of times from 1 / factor to factor is never resolved; at least 1; null: infinite")
            .member(&report::NoiseFloor::samples, "samples", "the ratios");
    return description;
}

template <>
const Description<report::Fragments>& description_of() {
    static const auto description =
        Description<report::Fragments>("Fragments",
                                       "transparent fragments of a frame, counted in frames that are not timed")
            .member(&report::Fragments::submitted, "submitted", "those that opaque geometry does not hide")
            .member(&report::Fragments::shaded, "shaded", "runs of the scene's shading for a transparent fragment")
            .text_or_null(&report::Fragments::shaded_by, "shaded_by", "what counted them")
            .member(&report::Fragments::visible, "visible",
                    "those of the shaded fragments that pass the depth and stencil tests: the least that any device "
                    "has to shade")
            .member(&report::Fragments::needed, "needed",
                    "those from front to back until the transmittance is under the method's threshold")
            .member(&report::Fragments::quads, "quads",
                    "groups of 2 x 2 pixels in which fragments of a primitive start, on a device that tests depth and "
                    "stencil early")
            .member(&report::Fragments::live_quads, "live_quads", "those in which the shading runs for a fragment")
            .member(&report::Fragments::warps, "warps", "the same of 8 x 4 pixels: 32 threads that end together")
            .member(&report::Fragments::live_warps, "live_warps", "those in which the shading runs for a fragment")
            .member(
                &report::Fragments::model_speedup, "model_speedup",
                "a model, not measured: the baseline's cost over its own, where a started warp costs as much as one "
                "texture read and a live one as many more as its shading makes (docs/measuring.md)")
            .member(&report::Fragments::efficiency, "efficiency",
                    "ideal time (that of f2b for only the needed fragments) over the method's own time");
    return description;
}

template <>
const Description<report::Change>& description_of() {
    static const auto description =
        Description<report::Change>("Change", "what a look of its own changes in a method: docs/ci.md")
            .member(&report::Change::from, "from",
                    "label of the method with the same id and parameters with which it is compared")
            .member(&report::Change::is_identical, "identical", "whether the pictures are the same, bit for bit")
            .member(&report::Change::metrics, "metrics", "of its picture, compared with the other one's")
            .member(&report::Change::speedup, "speedup",
                    "the other one's time over its own, round by round; `compared` is the number of such changes");
    return description;
}

template <>
const Description<report::Result>& description_of() {
    static const auto description =
        Description<report::Result>("Result", "the result of one method")
            .member(&report::Result::method, "method", "its id")
            .member(&report::Result::label, "label", "its name in this report, unique")
            .json(&report::Result::parameters, "parameters", "with defaults filled in", parameters_schema)
            .member(&report::Result::status, "status", "")
            .text_or_null(&report::Result::reason, "reason", "why the status is not ok")
            .member(&report::Result::images, "images",
                    "by their content: color, linear, opacity (how much of the background each channel hides), "
                    "overdraw, shaded, saturation, and the maps of the metrics")
            .member(&report::Result::timing, "timing", "null if the status is not ok")
            .member(&report::Result::speedup, "speedup", "over the baseline")
            .member(&report::Result::speedup_with_sort, "speedup_with_sort",
                    "the same, if each frame of a method that sorts includes the sort")
            .member(&report::Result::fragments, "fragments", "null if the status is not ok")
            .member(&report::Result::metrics, "metrics",
                    "of the picture, compared with the reference; in the method's own look, if it has one")
            .member(&report::Result::change, "change",
                    "what its own shading or texture changes in it; null for methods that have none")
            .member(&report::Result::memory_bytes, "memory_bytes", "of GL objects that the method made for its own use")
            .json(&report::Result::findings, "findings", "values that only this method reports", findings_schema)
            .member(&report::Result::notes, "notes", "reasons why this result is not as intended");
    return description;
}

}  // namespace sheer
