#include "renderer/results/pixel_types.h"

#include <cmath>
#include <limits>

#include "renderer/results/schemas.h"

namespace sheer {

using nlohmann::json;

namespace {

using Channels = std::array<std::optional<double>, 3>;

/// The value of a fact, by its kind.
json fact_value_schema(SchemaBook& book) {
    const json color = detail::Codec<pixel::Color>::schema(book);
    const auto of_kind = [](const char* kind, json schema) {
        schema["description"] = kind;
        return schema;
    };
    const json fragment = {{"type", {"integer", "null"}}, {"minimum", 1}};
    const json sample = {{"type", "object"},
                         {"properties", {{"fragment", fragment}, {"color", color}}},
                         {"required", {"fragment", "color"}},
                         {"additionalProperties", false}};
    return {{"anyOf",
             {of_kind("number; null if it is not finite", {{"type", {"number", "null"}}}), of_kind("color", color),
              of_kind("fragment; null: none", fragment),
              of_kind("fragments", {{"type", "array"}, {"items", {{"type", "integer"}, {"minimum", 1}}}}),
              of_kind("samples: what each sample of the pixel shows; fragment is null if that is opaque",
                      {{"type", "array"}, {"items", sample}})}}};
}

}  // namespace

namespace detail {

json Codec<pixel::Color>::write(const pixel::Color& color) {
    Channels channels;
    for (std::size_t i = 0; i < 3; ++i)
        if (std::isfinite(color[i])) channels[i] = color[i];
    return Codec<Channels>::write(channels);
}

void Codec<pixel::Color>::read(const json& from, pixel::Color& to) {
    Channels channels;
    Codec<Channels>::read(from, channels);
    for (std::size_t i = 0; i < 3; ++i) to.rgb[i] = channels[i].value_or(std::numeric_limits<double>::quiet_NaN());
}

json Codec<pixel::Color>::schema(SchemaBook& book) {
    return Codec<Channels>::schema(book);
}

}  // namespace detail

template <>
const Description<pixel::Fragment>& description_of() {
    using pixel::Fragment;
    static const auto description =
        Description<Fragment>("PixelFragment",
                              "a transparent fragment of the pixel, and its contribution to the exact picture")
            .member(&Fragment::depth, "depth", "as in the depth buffer, 0..1, 0 nearest")
            .member(&Fragment::color, "color", "red, green, blue, 0..1, not premultiplied")
            .member(&Fragment::alpha, "alpha", "0..1")
            .member(&Fragment::primitive, "primitive", "its number in the scene, counting opaque primitives too")
            .member(&Fragment::transmittance_before, "transmittance_before", "transmittance of the nearer fragments")
            .member(&Fragment::weight, "weight", "transmittance_before times alpha: how much of its color is visible");
    return description;
}

template <>
const Description<pixel::Opaque>& description_of() {
    using pixel::Opaque;
    static const auto description =
        Description<Opaque>("OpaqueSurface", "the opaque surface that shows behind the transparent fragments")
            .member(&Opaque::depth, "depth", "as in the depth buffer, 0..1, 0 nearest")
            .member(&Opaque::color, "color", "red, green, blue, 0..1");
    return description;
}

template <>
const Description<pixel::ReferenceAtPixel>& description_of() {
    using pixel::ReferenceAtPixel;
    static const auto description =
        Description<ReferenceAtPixel>("ReferenceAtPixel", "the pixel in the reference's picture")
            .member(&ReferenceAtPixel::method, "method", "its id")
            .member(&ReferenceAtPixel::value, "value",
                    "red, green, blue, from the float picture if there is one; not clamped to 0..1")
            .member(&ReferenceAtPixel::difference, "difference", "`sum` minus the value");
    return description;
}

template <>
const Description<pixel::Fact>& description_of() {
    using pixel::Fact;
    static const auto description =
        Description<Fact>("PixelFact", "a fact about the pixel from a method, in the method's own terms")
            .member(&Fact::name, "name", "such as alpha_sum")
            .member(&Fact::kind, "kind", "the kind of value")
            .json(&Fact::value, "value",
                  "by its kind; a fragment is its number in `fragments`, from 1, near to far, or null for none",
                  fact_value_schema)
            .member(&Fact::text, "text", "a sentence that explains it");
    return description;
}

template <>
const Description<pixel::MethodAtPixel>& description_of() {
    using pixel::MethodAtPixel;
    static const auto description =
        Description<MethodAtPixel>("MethodAtPixel",
                                   "one method's result at the pixel; values and counts are from the report's own "
                                   "pictures, and null if the status is not ok")
            .member(&MethodAtPixel::method, "method", "its id")
            .member(&MethodAtPixel::label, "label", "its name in the report")
            .member(&MethodAtPixel::status, "status", "of the report's result")
            .text_or_null(&MethodAtPixel::reason, "reason", "why the status is not ok")
            .member(&MethodAtPixel::value, "value",
                    "red, green, blue, from the float picture if there is one; not clamped to 0..1")
            .member(&MethodAtPixel::difference, "difference", "`sum` minus the value, as in the metric `signed`")
            .member(&MethodAtPixel::shaded, "shaded", "number of shaded fragments")
            .member(&MethodAtPixel::needed, "needed",
                    "fragments from front to back until the transmittance is under the method's threshold")
            .member(&MethodAtPixel::saturated_at, "saturated_at",
                    "the fragment, counted from 1, after which the transmittance is under the method's threshold")
            .member(&MethodAtPixel::explanation, "explanation",
                    "the method's own facts about the pixel as it was drawn again; null if that was not possible")
            .maybe(&MethodAtPixel::explained_value, "explained_value",
                   "red, green, blue of the pixel as it was drawn again; absent if that was not possible")
            .maybe(&MethodAtPixel::explanation_reason, "explanation_reason",
                   "why there is no explanation, or why it does not match the value in the report's picture");
    return description;
}

template <>
const Description<pixel::Pixel>& description_of() {
    using pixel::Pixel;
    static const auto description =
        Description<Pixel>("Pixel", "the fragments of a pixel of a report, and each method's result")
            .member(&Pixel::x, "x", "column from the left, from 0")
            .member(&Pixel::y, "y", "row from the top, from 0")
            .json(&Pixel::point, "point", "point of the sweep; {} without a sweep", point_schema)
            .member(&Pixel::background, "background", "the spec's background, red, green, blue, 0..1")
            .member(&Pixel::opaque, "opaque", "null if the background is visible")
            .member(&Pixel::fragments, "fragments",
                    "near to far; at equal depths the later submitted primitive first; those that `opaque` hides are "
                    "left out")
            .member(&Pixel::transmittance, "transmittance", "of all fragments together, 0..1")
            .member(&Pixel::sum, "sum",
                    "the weighted sum of the fragments' colors and what is behind them, in double precision: the exact "
                    "picture's value")
            .member(&Pixel::reference, "reference", "")
            .member(&Pixel::methods, "methods", "in the order of the report's results");
    return description;
}

}  // namespace sheer
