#include "renderer/results/diff_types.h"

#include "renderer/results/schemas.h"

namespace sheer {

namespace {

/// A field can have a value of any type, but all values in an array are of one type.
nlohmann::json any_value_schema() {
    nlohmann::json schema = {{"anyOf", {{{"type", {"null", "boolean", "number", "string", "object"}}}}}};
    for (const char* type : {"boolean", "number", "string", "object"})
        schema["anyOf"].push_back({{"type", "array"}, {"items", {{"type", {type, "null"}}}}});
    schema["anyOf"].push_back(
        {{"type", "array"}, {"items", {{"type", {"array", "null"}}, {"items", nlohmann::json::object()}}}});
    return schema;
}

}  // namespace

template <>
const Description<diff::Side>& description_of() {
    using diff::Side;
    static const auto description =
        Description<Side>("DiffSide", "one of the two compared reports")
            .text_or_null(&Side::id, "id", "null in the file of `sheer compare`")
            .member(&Side::title, "title", "of its spec; null if the spec has none")
            .text_or_null(&Side::created_at, "created_at", "UTC, RFC 3339")
            .text_or_null(&Side::version, "version", "version of Sheer that made it")
            .text_or_null(&Side::commit, "commit", "of that version's source")
            .text_or_null(&Side::renderer, "renderer", "GL_RENDERER of its device; null if the report has no device")
            .member(&Side::baseline, "baseline", "label of the method with which its times are compared");
    return description;
}

template <>
const Description<diff::Difference>& description_of() {
    using diff::Difference;
    const auto any = [](SchemaBook&) { return any_value_schema(); };
    static const auto description =
        Description<Difference>("Difference",
                                "a field of spec, device or provenance, or a file, that differs between the reports")
            .member(&Difference::pointer, "pointer",
                    "JSON pointer into the first report, or into the second one if only that has it")
            .json(&Difference::a, "a", "the value in the first report, of a file its whole entry; null if absent", any)
            .json(&Difference::b, "b", "the same in the second report", any)
            .maybe(&Difference::allowed, "allowed",
                   "true if the reports are compared because `allow` names it; otherwise absent");
    return description;
}

template <>
const Description<diff::OnlyIn>& description_of() {
    using diff::OnlyIn;
    static const auto description = Description<OnlyIn>("OnlyIn", "parts that only one of the two reports has")
                                        .member(&OnlyIn::methods, "methods", "labels")
                                        .json(&OnlyIn::points, "points", "of the sweep", [](SchemaBook& book) {
                                            return nlohmann::json{{"type", "array"}, {"items", point_schema(book)}};
                                        });
    return description;
}

template <>
const Description<diff::Both<diff::OnlyIn>>& description_of() {
    using diff::Both, diff::OnlyIn;
    static const auto description =
        Description<Both<OnlyIn>>("OnlyInEither", "parts that only one of the two reports has")
            .member(&Both<OnlyIn>::a, "a", "only the first")
            .member(&Both<OnlyIn>::b, "b", "only the second");
    return description;
}

template <>
const Description<diff::PictureCounts>& description_of() {
    using diff::PictureCounts;
    static const auto description =
        Description<PictureCounts>("PictureCounts",
                                   "the number of pictures with each verdict, including those of references")
            .member(&PictureCounts::identical, "identical", "")
            .member(&PictureCounts::different, "different", "")
            .member(&PictureCounts::not_examined, "not examined", "");
    return description;
}

template <>
const Description<diff::TimeCounts>& description_of() {
    using diff::TimeCounts;
    static const auto description =
        Description<TimeCounts>("TimeCounts", "the number of times of the second report with each verdict")
            .member(&TimeCounts::faster, "faster", "")
            .member(&TimeCounts::slower, "slower", "")
            .member(&TimeCounts::not_resolved, "not resolved", "");
    return description;
}

template <>
const Description<diff::Summary>& description_of() {
    using diff::Summary;
    static const auto description =
        Description<Summary>("DiffSummary", "counts over the runs of the diff")
            .member(&Summary::pictures, "pictures", "")
            .member(&Summary::times, "times", "")
            .member(&Summary::statuses_changed, "statuses_changed", "number of results whose status differs");
    return description;
}

template <>
const Description<diff::FlipError>& description_of() {
    using diff::FlipError;
    static const auto description = Description<FlipError>("FlipError", "FLIP between the two pictures, 0..1")
                                        .member(&FlipError::mean, "mean", "over all pixels")
                                        .member(&FlipError::max, "max", "at the worst pixel");
    return description;
}

template <>
const Description<diff::PictureDiff>& description_of() {
    using diff::PictureDiff;
    static const auto description =
        Description<PictureDiff>("PictureDiff", "how a picture changed")
            .member(&PictureDiff::verdict, "verdict",
                    "identical: every pixel is equal in 8-bit levels; not examined: see the reason")
            .maybe(&PictureDiff::reason, "reason", "why it was not examined; otherwise absent")
            .maybe(&PictureDiff::flip, "flip", "absent if it was not examined")
            .maybe(&PictureDiff::differing_pixels, "differing_pixels",
                   "pixels in which a channel differs; absent if it was not examined")
            .maybe(&PictureDiff::greatest_levels, "greatest_levels",
                   "greatest absolute difference of a channel, in 8-bit levels; absent if it was not examined")
            .maybe(&PictureDiff::worst_pixel, "worst_pixel",
                   "[x, y] from the top left, of the pixel that differs most; null if the pictures are identical, "
                   "absent if it was not examined")
            .maybe(&PictureDiff::flip_picture, "flip_picture",
                   "the FLIP map of a picture that differs; absent if no maps were requested")
            .member(&PictureDiff::linear, "linear",
                    "whether the files of the float pictures have the same bytes; null if a report has none")
            .member(&PictureDiff::a, "a", "in the first report")
            .member(&PictureDiff::b, "b", "in the second report");
    return description;
}

template <>
const Description<diff::TimesOf>& description_of() {
    using diff::TimesOf;
    static const auto description = Description<TimesOf>("TimesOf", "the times of a method in one report")
                                        .member(&TimesOf::median, "median", "in ms; null if there are no samples")
                                        .member(&TimesOf::samples, "samples", "number of samples");
    return description;
}

template <>
const Description<diff::Judged>& description_of() {
    using diff::Judged;
    static const auto description =
        Description<Judged>("Judged", "a ratio of times of the two reports; over 1 if the second one is faster")
            .member(&Judged::value, "value", "Hodges-Lehmann estimate")
            .member(&Judged::ci95, "ci95",
                    "[low, high]; the intervals of all methods of the run together have 95 % confidence; null if there "
                    "are too few rounds")
            .member(&Judged::verdict, "verdict",
                    "resolved if the whole interval is on one side of 1 and outside the noise of both "
                    "reports")
            .text_or_null(&Judged::reason, "reason", "why it is not resolved");
    return description;
}

template <>
const Description<diff::TimeDiff>& description_of() {
    using diff::TimeDiff;
    static const auto description =
        Description<TimeDiff>("TimeDiff", "how a method's time changed: docs/measuring.md")
            .member(&TimeDiff::clock, "clock", "the clock of both reports; wall if they have different ones")
            .member(&TimeDiff::a, "a", "in the first report")
            .member(&TimeDiff::b, "b", "in the second report")
            .member(&TimeDiff::absolute, "absolute",
                    "the times themselves, first over second; null if they are too short for the clock")
            .member(&TimeDiff::relative, "relative", "the same for the ratios to the report's own baseline")
            .member(&TimeDiff::verdict, "verdict",
                    "of the second report: on the same device that on which `absolute` and `relative` agree, otherwise "
                    "that of "
                    "`absolute`")
            .text_or_null(&TimeDiff::reason, "reason", "why it is not resolved");
    return description;
}

template <>
const Description<diff::Both<report::ResultStatus>>& description_of() {
    using Statuses = diff::Both<report::ResultStatus>;
    static const auto description = Description<Statuses>("BothStatuses", "the status of a method in both reports")
                                        .member(&Statuses::a, "a", "in the first report")
                                        .member(&Statuses::b, "b", "in the second report");
    return description;
}

template <>
const Description<diff::Reasons>& description_of() {
    using diff::Reasons;
    static const auto description = Description<Reasons>("BothReasons", "why a method did not run")
                                        .member(&Reasons::a, "a", "in the first report; null if it ran")
                                        .member(&Reasons::b, "b", "in the second report; null if it ran");
    return description;
}

template <>
const Description<diff::ResultDiff>& description_of() {
    using diff::ResultDiff;
    static const auto description = Description<ResultDiff>("ResultDiff", "how a method of both reports changed")
                                        .member(&ResultDiff::label, "label", "by which it is matched")
                                        .member(&ResultDiff::method, "method", "its id in the first report")
                                        .member(&ResultDiff::status, "status", "")
                                        .member(&ResultDiff::picture, "picture",
                                                "null unless the status is ok in both reports and both have pictures")
                                        .member(&ResultDiff::time, "time", "null unless the status is ok in both")
                                        .maybe(&ResultDiff::reason, "reason", "absent if the status is ok in both");
    return description;
}

template <>
const Description<diff::Both<std::string>>& description_of() {
    using Methods = diff::Both<std::string>;
    static const auto description = Description<Methods>("BothMethods", "the id of a method in both reports")
                                        .member(&Methods::a, "a", "in the first report")
                                        .member(&Methods::b, "b", "in the second report");
    return description;
}

template <>
const Description<diff::ReferenceDiff>& description_of() {
    using diff::ReferenceDiff;
    static const auto description =
        Description<ReferenceDiff>("ReferenceDiff", "how the reference changed")
            .member(&ReferenceDiff::method, "method", "")
            .member(&ReferenceDiff::picture, "picture", "null if a report has no picture of it");
    return description;
}

template <>
const Description<diff::Size>& description_of() {
    using diff::Size;
    static const auto description = Description<Size>("PictureSize", "of every picture of a run, in pixels")
                                        .member(&Size::width, "width", "")
                                        .member(&Size::height, "height", "");
    return description;
}

template <>
const Description<diff::RunDiff>& description_of() {
    using diff::RunDiff;
    static const auto description =
        Description<RunDiff>("RunDiff", "how a run of both reports changed")
            .json(&RunDiff::point, "point", "point of the sweep, by which runs are matched; {} without a sweep",
                  point_schema)
            .member(&RunDiff::image, "image", "")
            .member(&RunDiff::compared, "compared", "number of methods that ran in both")
            .member(&RunDiff::reference, "reference", "")
            .member(&RunDiff::results, "results", "of the methods of both reports, in the order of the first one");
    return description;
}

template <>
const Description<diff::Diff>& description_of() {
    using diff::Diff;
    static const auto description =
        Description<Diff>("Diff", "what changed between two reports of the same spec: docs/service.md")
            .member(&Diff::a, "a", "the earlier report")
            .member(&Diff::b, "b", "the later report")
            .member(&Diff::same_device, "same_device", "whether both have the same renderer and the same processor")
            .member(&Diff::differences, "differences",
                    "differing fields of spec, device and provenance, and differing files of the scenes")
            .member(&Diff::only_in, "only_in", "")
            .member(&Diff::summary, "summary", "")
            .member(&Diff::runs, "runs", "the runs of both reports, in the order of the first one");
    return description;
}

}  // namespace sheer
