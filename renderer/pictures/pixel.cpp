#include "renderer/pictures/pixel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/files/report_document.h"
#include "renderer/image/magma.h"
#include "renderer/methods/shared/method.h"
#include "renderer/pictures/picture_file.h"

namespace sheer {

using pixel::Color;

namespace {

/// Tolerances for 8-bit and float pictures: more than rounding explains.
constexpr double greatest_rounding = 1.5 / 255;

pixel::Fragment fragment_of(const PixelFragment& fragment) {
    return {.depth = fragment.depth,
            .color = {fragment.color},
            .alpha = fragment.alpha,
            .primitive = fragment.primitive,
            .transmittance_before = fragment.transmittance_before,
            .weight = fragment.weight};
}

std::vector<pixel::Fact> facts_of(const std::vector<PixelFact>& facts) {
    std::vector<pixel::Fact> all;
    for (const PixelFact& fact : facts)
        all.push_back({fact.name, from_document<pixel::FactKind>(fact.kind), fact.value, fact.text});
    return all;
}

/// The count that a color of count_picture represents.
std::uint32_t count_of(const Rgb& color, std::uint32_t full_scale) {
    std::array<std::uint8_t, 3> wanted{};
    for (std::size_t i = 0; i < 3; ++i) wanted[i] = static_cast<std::uint8_t>(std::lround(color[i] * 255));
    const auto level = static_cast<std::uint32_t>(std::ranges::find(magma(), wanted) - magma().begin());
    if (level == magma().size()) throw std::runtime_error("a picture of counts has a color that represents no count");
    return (level * full_scale + most_counts_in_colors / 2) / most_counts_in_colors;
}

class PixelReader {
  public:
    PixelReader(const PixelStack& stack, int x, int y, const report::PictureReader& read_picture)
        : m_stack(stack), m_x(x), m_y(y), m_read_picture(read_picture) {}

    pixel::ReferenceAtPixel reference(const report::Reference& of_report) const {
        const Color value = value_of(of_report.images);
        return {of_report.method, value, difference(value)};
    }

    pixel::MethodAtPixel method(const report::Result& result, const Explanation* explanation) const {
        pixel::MethodAtPixel at_pixel;
        at_pixel.method = result.method;
        at_pixel.label = result.label;
        at_pixel.status = result.status;
        at_pixel.reason = result.reason;
        if (result.status != report::ResultStatus::ok) return at_pixel;
        at_pixel.value = value_of(result.images);
        at_pixel.difference = difference(*at_pixel.value);
        add_counts(at_pixel, result);
        add_explanation(at_pixel, explanation);
        return at_pixel;
    }

  private:
    Color value_in(const report::Picture& picture) const { return {read_pixel(m_read_picture(picture), m_x, m_y)}; }

    /// From the float picture if there is one.
    Color value_of(const report::Pictures& images) const {
        const report::Picture* linear = find_picture(images, "linear");
        const report::Picture* picture = linear ? linear : find_picture(images, "color");
        if (!picture) throw std::runtime_error("the report has no picture of it");
        return value_in(*picture);
    }

    Color difference(const Color& value) const {
        Color difference;
        for (std::size_t i = 0; i < 3; ++i) difference.rgb[i] = m_stack.sum[i] - value[i];
        return difference;
    }

    /// The method was drawn again for this, perhaps by another driver than the report's.
    static void add_explanation(pixel::MethodAtPixel& at_pixel, const Explanation* explanation) {
        if (!explanation || !explanation->value) {
            at_pixel.explanation_reason = explanation ? explanation->reason : "the method was not drawn again";
            return;
        }
        at_pixel.explanation = facts_of(explanation->facts);
        at_pixel.explained_value = Color{*explanation->value};
        for (std::size_t i = 0; i < 3; ++i)
            if (std::abs((*explanation->value)[i] - (*at_pixel.value)[i]) > greatest_rounding)
                at_pixel.explanation_reason =
                    "drawn again, the pixel differs from the report's picture; this explains the new value";
    }

    void add_counts(pixel::MethodAtPixel& at_pixel, const report::Result& result) const {
        const auto all = static_cast<std::int64_t>(m_stack.fragments.size());
        at_pixel.shaded = count(result, "shaded");
        const MethodInfo* method = find_method(result.method);
        if (method == nullptr || method->saturation() == nullptr) {
            at_pixel.needed.value = all;
            at_pixel.saturated_at.reason = "the method has no threshold";
            return;
        }
        at_pixel.saturated_at = count(result, "saturation");
        at_pixel.needed = at_pixel.saturated_at;
        // A pixel that is never saturated needs all its fragments.
        if (at_pixel.saturated_at && *at_pixel.saturated_at == 0) {
            at_pixel.needed.value = all;
            at_pixel.saturated_at = {{}, "the transmittance stays above the threshold"};
        }
    }

    /// The count from the picture with this name.
    OrReason<std::int64_t> count(const report::Result& result, const std::string& name) const {
        const report::Picture* picture = find_picture(result.images, name);
        if (!picture) return {{}, no_count_reason(result, name)};
        if (const report::Picture* counts = find_picture(result.images, name + "_counts"))
            return {std::lround(value_in(*counts)[0]), ""};
        if (!picture->full_scale)
            throw std::runtime_error("the report does not give the full scale of a picture of counts");
        const std::int64_t full_scale = *picture->full_scale;
        if (full_scale > most_counts_in_colors)
            return {{}, fmt::format("the report's picture has 256 colors for counts from 0 to {}", full_scale)};
        return {count_of(value_in(*picture).rgb, static_cast<std::uint32_t>(full_scale)), ""};
    }

    static std::string no_count_reason(const report::Result& result, const std::string& name) {
        const report::Fragments fragments = result.fragments.value_or(report::Fragments{});
        const std::string& reason = name == "shaded" ? fragments.shaded.reason : fragments.needed.reason;
        return reason.empty() ? "the report has no picture of it" : reason;
    }

    const PixelStack& m_stack;
    const int m_x, m_y;
    const report::PictureReader& m_read_picture;
};

}  // namespace

pixel::Pixel pixel_report(const PixelStack& stack, int x, int y, const report::Run& run,
                          const report::PictureReader& read_picture) {
    const PixelReader reader(stack, x, y, read_picture);
    pixel::Pixel pixel;
    pixel.x = x;
    pixel.y = y;
    pixel.point = run.point;
    pixel.background = {stack.background};
    if (stack.opaque) pixel.opaque = {stack.opaque->depth, {stack.opaque->color}};
    for (const PixelFragment& fragment : stack.fragments) pixel.fragments.push_back(fragment_of(fragment));
    pixel.transmittance = stack.transmittance;
    pixel.sum = {stack.sum};
    pixel.reference = reader.reference(run.reference);
    for (const report::Result& result : run.results) {
        const std::size_t number = pixel.methods.size();
        pixel.methods.push_back(
            reader.method(result, number < stack.methods.size() ? &stack.methods[number] : nullptr));
    }
    return pixel;
}

}  // namespace sheer
