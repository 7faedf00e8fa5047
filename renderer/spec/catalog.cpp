#include "renderer/spec/catalog.h"

#include "renderer/methods/shared/method.h"
#include "renderer/scene/scene_info.h"
#include "renderer/spec/spec.h"
#include "renderer/spec/suites.h"

namespace sheer {

using nlohmann::json;

namespace catalog {

namespace {

std::optional<MetricColumn> column_of(const sheer::MetricColumn& column) {
    if (column.head.empty()) return std::nullopt;
    return MetricColumn{.head = column.head,
                        .better = column.better == Better::none ? std::nullopt : std::optional(column.better),
                        .digits = column.digits,
                        .note = column.note};
}

MetricField listed_field(const MetricInfo& metric, const sheer::MetricField& field) {
    return {.name = field.name,
            .full_name = full_name(metric, field),
            .kind = field.kind,
            .unit = field.unit,
            .range = field.range,
            .summary = field.summary,
            .null_is_identical = field.null_is_identical,
            .column = column_of(field.column)};
}

/// With the default parameters.
std::optional<BytesPerPixel> bytes_per_px(const MethodInfo& method) {
    std::vector<FieldError> none;
    const json defaults = read_fields(json::object(), "", method.parameters, none);
    const auto rgba8 = method.bytes_per_px(defaults, 4), rgba16f = method.bytes_per_px(defaults, 8),
               rgba32f = method.bytes_per_px(defaults, 16);
    if (!rgba8 || !rgba16f || !rgba32f) return std::nullopt;
    return BytesPerPixel{*rgba8, *rgba16f, *rgba32f};
}

}  // namespace

std::vector<Method> methods() {
    std::vector<Method> all;
    for (const MethodInfo& method : all_methods())
        all.push_back({.id = method.id,
                       .name = method.name,
                       .kind = method.kind,
                       .summary = method.summary,
                       .paper = method.paper,
                       .good_at = method.good_at,
                       .bad_at = method.bad_at,
                       .memory = method.memory,
                       .passes = method.passes,
                       .needs = method.needs,
                       .bytes_per_px = bytes_per_px(method),
                       .needs_sorting = method.needs_sorting,
                       .parameters = fields_of(method.parameters),
                       .no_metrics_reason = method.no_metrics_reason});
    return all;
}

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    for (const SceneInfo& scene : all_scenes())
        all.push_back({.id = scene.id,
                       .name = scene.name,
                       .summary = scene.summary,
                       .source = scene.source,
                       .parameters = fields_of(scene.all_parameters())});
    return all;
}

std::vector<Metric> metrics() {
    std::vector<Metric> all;
    for (const MetricInfo& metric : all_metrics()) {
        all.push_back({.id = metric.id,
                       .name = metric.name,
                       .summary = metric.summary,
                       .source = metric.source,
                       .formula = metric.formula,
                       .good_for = metric.good_for,
                       .picture = metric.picture,
                       .fields = {}});
        for (const sheer::MetricField& field : metric.fields) all.back().fields.push_back(listed_field(metric, field));
    }
    return all;
}

std::vector<Suite> suites() {
    std::vector<Suite> all;
    for (const sheer::Suite& suite : all_suites())
        all.push_back({.id = suite.id,
                       .title = suite.title,
                       .source = suite.source,
                       .device = suite.device,
                       .spec = suite.spec,
                       .published_count = suite.published.size(),
                       .trend_count = suite.trends.size()});
    return all;
}

json posted_spec_reference(SchemaBook& book) {
    return book.reference(posted_spec_name, [](SchemaBook&) { return spec_schema(); });
}

}  // namespace catalog

json describe_methods() {
    return to_document(catalog::methods());
}

json describe_scenes() {
    return to_document(catalog::scenes());
}

json describe_metrics() {
    return to_document(catalog::metrics());
}

json describe_suites() {
    return to_document(catalog::suites());
}

template <>
const Description<catalog::BytesPerPixel>& description_of() {
    using catalog::BytesPerPixel;
    static const auto description =
        Description<BytesPerPixel>("BytesPerPixel", "memory for each pixel, by the format of the picture")
            .member(&BytesPerPixel::rgba8, "rgba8", "")
            .member(&BytesPerPixel::rgba16f, "rgba16f", "")
            .member(&BytesPerPixel::rgba32f, "rgba32f", "");
    return description;
}

template <>
const Description<catalog::Method>& description_of() {
    using catalog::Method;
    static const auto description =
        Description<Method>("Method", "a method of drawing transparency: docs/methods.md")
            .member(&Method::id, "id", "its id in specs")
            .member(&Method::name, "name", "")
            .member(&Method::kind, "kind", "such as sorted blending or reference")
            .member(&Method::summary, "summary", "")
            .member(&Method::paper, "paper", "where it comes from")
            .member(&Method::good_at, "good_at", "")
            .member(&Method::bad_at, "bad_at", "")
            .member(&Method::memory, "memory", "for each pixel, in addition to the picture into which it renders")
            .maybe(&Method::bytes_per_px, "bytes_per_px",
                   "the same by its formula with the default parameters and without opaque geometry; absent if it "
                   "depends on the scene")
            .member(&Method::passes, "passes", "how often it draws the transparent geometry, and full-screen passes")
            .member(&Method::needs, "needs", "of the device, beside blending and a depth test; \"\" if nothing")
            .member(&Method::needs_sorting, "needs_sorting",
                    "false if the order of submission does not matter, or if the method draws in that order")
            .member(&Method::parameters, "parameters", "")
            .text_or_null(&Method::no_metrics_reason, "no_metrics_reason",
                          "why it has no metrics; null if it has them");
    return description;
}

template <>
const Description<catalog::Scene>& description_of() {
    using catalog::Scene;
    static const auto description = Description<Scene>("Scene", "a type of scene")
                                        .member(&Scene::id, "id", "its id in specs")
                                        .member(&Scene::name, "name", "")
                                        .member(&Scene::summary, "summary", "")
                                        .member(&Scene::source, "source", "a paper, or Sheer")
                                        .member(&Scene::parameters, "parameters", "");
    return description;
}

template <>
const Description<catalog::MetricColumn>& description_of() {
    using catalog::MetricColumn;
    static const auto description =
        Description<MetricColumn>("MetricColumn", "how a value of a metric is shown in tables")
            .member(&MetricColumn::head, "head", "")
            .member(&MetricColumn::better, "better", "which of two values is better; null if neither is")
            .member(&MetricColumn::digits, "digits", "significant digits of the smallest value in a column")
            .text_or_null(&MetricColumn::note, "note", "field of the same metric that is shown after the value");
    return description;
}

template <>
const Description<catalog::MetricField>& description_of() {
    using catalog::MetricField;
    static const auto description =
        Description<MetricField>("MetricField", "a value of a metric")
            .member(&MetricField::name, "name", "its key; \"\" if it is the metric's only value")
            .member(&MetricField::full_name, "full_name", "its name in checks")
            .member(&MetricField::kind, "kind", "")
            .member(&MetricField::unit, "unit", "\"\" if it has none")
            .member(&MetricField::range, "range", "such as 0..1")
            .member(&MetricField::summary, "summary", "")
            .member(&MetricField::null_is_identical, "null_is_identical",
                    "whether null means that the pictures are identical")
            .member(&MetricField::column, "column", "null if it has none");
    return description;
}

template <>
const Description<catalog::Metric>& description_of() {
    using catalog::Metric;
    static const auto description =
        Description<Metric>("Metric", "how far pictures are from the reference: docs/metrics.md")
            .member(&Metric::id, "id", "its id in reports and checks")
            .member(&Metric::name, "name", "")
            .member(&Metric::summary, "summary", "")
            .member(&Metric::source, "source", "where it comes from")
            .member(&Metric::formula, "formula", "")
            .member(&Metric::good_for, "good_for", "")
            .member(&Metric::picture, "picture", "key of its map in the images of a report; \"\" if it makes none")
            .member(&Metric::fields, "fields", "its values");
    return description;
}

template <>
const Description<catalog::Suite>& description_of() {
    using catalog::Suite;
    static const auto description =
        Description<Suite>("Suite", "a published measurement that can be repeated")
            .member(&Suite::id, "id", "")
            .member(&Suite::title, "title", "")
            .member(&Suite::source, "source", "paper and table")
            .member(&Suite::device, "device", "the device on which the published figures were measured")
            .json(&Suite::spec, "spec", "a spec to post", catalog::posted_spec_reference)
            .member(&Suite::published_count, "published_count", "number of published figures")
            .member(&Suite::trend_count, "trend_count", "number of statements on them");
    return description;
}

template <>
const Description<catalog::Example>& description_of() {
    using catalog::Example;
    static const auto description =
        Description<Example>("Example", "a ready-made spec to start from")
            .member(&Example::id, "id", "")
            .member(&Example::teaches, "teaches", "what its report shows, in a sentence; may be empty")
            .member(&Example::picture, "picture", "path of a small picture of its scene; null if there is none")
            .json(&Example::spec, "spec", "a spec to post, once its files are uploaded", catalog::posted_spec_reference)
            .member(&Example::files, "files", "to upload first; the SHA-256 of each replaces its name in the spec");
    return description;
}

template <>
const Description<catalog::ExampleFile>& description_of() {
    using catalog::ExampleFile;
    static const auto description =
        Description<ExampleFile>("ExampleFile", "a file to which a ready-made spec refers")
            .member(&ExampleFile::pointer, "pointer", "JSON pointer of the field of the spec")
            .member(&ExampleFile::name, "name", "")
            .member(&ExampleFile::url, "url", "path of its bytes");
    return description;
}

template <>
const Description<catalog::Workaround>& description_of() {
    using catalog::Workaround;
    static const auto description =
        Description<Workaround>("Workaround", "a workaround for a driver's bug")
            .member(&Workaround::name, "name", "")
            .member(&Workaround::paragraph, "paragraph", "the bug, and what is done about it");
    return description;
}

template <>
const Description<catalog::ListedDevice>& description_of() {
    using catalog::ListedDevice;
    static const auto description =
        Description<ListedDevice>("ListedDevice", "a device that can render, or the reason why it cannot")
            .member(&ListedDevice::context, "context", "egl, osmesa or glfw")
            .member(&ListedDevice::index, "index", "index among the devices of this context, from 0")
            .member(&ListedDevice::name, "name", "its name for --device")
            .member(&ListedDevice::renderer, "renderer", "GL_RENDERER; like all texts, \"\" if there is an error")
            .member(&ListedDevice::vendor, "vendor", "GL_VENDOR")
            .member(&ListedDevice::gl_version, "gl_version", "GL_VERSION")
            .member(&ListedDevice::glsl_version, "glsl_version", "GL_SHADING_LANGUAGE_VERSION")
            .member(&ListedDevice::platform, "platform", "how the context is made")
            .member(&ListedDevice::software, "software",
                    "whether it is a software rasteriser, whose times do not predict a GPU's")
            .member(&ListedDevice::error, "error", "why it cannot be used; null if it can")
            .member(&ListedDevice::workarounds, "workarounds", "in use on it");
    return description;
}

}  // namespace sheer
