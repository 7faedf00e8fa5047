#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/pictures/pixel.h"

namespace sheer {

using nlohmann::json;

namespace {

std::string color_text(const pixel::Color& color) {
    return fmt::format("{:9.6f} {:9.6f} {:9.6f}", color[0], color[1], color[2]);
}

std::string color_or_dash(const std::optional<pixel::Color>& color) {
    return color ? color_text(*color) : fmt::format("{:>29}", "-");
}

std::string trimmed_color(const pixel::Color& color) {
    return fmt::format("{:.6f} {:.6f} {:.6f}", color[0], color[1], color[2]);
}

std::string trimmed_color(const json& color) {
    return trimmed_color(from_document<pixel::Color>(color));
}

std::string count_text(const OrReason<std::int64_t>& count) {
    return count ? std::to_string(*count) : "-";
}

std::string stack_table(const pixel::Pixel& pixel) {
    std::string text = fmt::format("{:>5} {:>10} {:>29} {:>9} {:>9} {:>13} {:>9}\n", "", "depth",
                                   "red     green      blue", "alpha", "primitive", "transmittance", "weight");
    std::size_t number = 0;
    for (const pixel::Fragment& fragment : pixel.fragments)
        text += fmt::format("{:>5} {:>10.7f} {} {:>9.6f} {:>9} {:>13.6f} {:>9.6f}\n", ++number, fragment.depth,
                            color_text(fragment.color), fragment.alpha, fragment.primitive,
                            fragment.transmittance_before, fragment.weight);
    const auto& opaque = pixel.opaque;
    text += fmt::format("{:>5} {:>10} {} {:>9} {:>9} {:>13.6f} {:>9.6f}\n", "",
                        opaque ? fmt::format("{:.7f}", opaque->depth) : "background",
                        color_text(opaque ? opaque->color : pixel.background), opaque ? "opaque" : "", "",
                        pixel.transmittance, pixel.transmittance);
    return text;
}

std::string method_table(const pixel::Pixel& pixel) {
    const auto line = [](const std::string& name, const std::optional<pixel::Color>& value,
                         const std::optional<pixel::Color>& difference) {
        return fmt::format("{:<24} {} {}", name, color_or_dash(value), color_or_dash(difference));
    };
    std::string text = fmt::format("{:<24} {:>29} {:>29} {:>7} {:>7} {:>9}\n", "", "red     green      blue",
                                   "sum minus value", "shaded", "needed", "saturated");
    text += fmt::format("{:<24} {}\n", "sum", color_text(pixel.sum));
    const pixel::ReferenceAtPixel& reference = pixel.reference;
    text += line("reference " + reference.method, reference.value, reference.difference) + "\n";
    for (const pixel::MethodAtPixel& method : pixel.methods) {
        text += line(method.label, method.value, method.difference);
        if (method.status == report::ResultStatus::ok) {
            text += fmt::format(" {:>7} {:>7} {:>9}\n", count_text(method.shaded), count_text(method.needed),
                                count_text(method.saturated_at));
        } else {
            text += fmt::format(" {}: {}\n", word_of(method.status), method.reason);
        }
    }
    return text;
}

/// 1-4, 7, or 4-1, 7: three or more consecutive numbers, up or down, are a range.
std::string fragments_text(const json& numbers) {
    const auto at = [&](std::size_t i) { return numbers[i].get<std::int64_t>(); };
    std::vector<std::string> parts;
    for (std::size_t first = 0, last = 0; first < numbers.size(); first = last + 1) {
        const std::int64_t step = first + 1 < numbers.size() ? at(first + 1) - at(first) : 0;
        last = first;
        while ((step == 1 || step == -1) && last + 1 < numbers.size() && at(last + 1) == at(last) + step) ++last;
        if (last - first < 2) last = first;
        parts.push_back(last == first ? fmt::format("{}", at(first)) : fmt::format("{}-{}", at(first), at(last)));
    }
    return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string samples_text(const json& samples) {
    std::vector<std::string> parts;
    for (const json& sample : samples)
        parts.push_back(fmt::format("{}: {}", sample["fragment"].is_null() ? "opaque" : sample["fragment"].dump(),
                                    trimmed_color(sample["color"])));
    return fmt::format("{}", fmt::join(parts, "; "));
}

std::string fact_text(const pixel::Fact& fact) {
    switch (fact.kind) {
        case pixel::FactKind::color:
            return trimmed_color(fact.value);
        case pixel::FactKind::fragments:
            return fragments_text(fact.value);
        case pixel::FactKind::samples:
            return samples_text(fact.value);
        case pixel::FactKind::number:
        case pixel::FactKind::fragment:
            break;
    }
    if (fact.value.is_null()) return "none";
    return fact.value.is_number_float() ? fmt::format("{:.6g}", fact.value.get<double>()) : fact.value.dump();
}

/// A method's heading, then a line for each fact, with its meaning below.
std::string explanations(const pixel::Pixel& pixel) {
    std::string text;
    for (const pixel::MethodAtPixel& method : pixel.methods) {
        const std::string& reason = method.explanation_reason;
        const std::vector<pixel::Fact> facts = method.explanation.value_or(std::vector<pixel::Fact>{});
        if (method.status != report::ResultStatus::ok || (facts.empty() && reason.empty())) continue;
        text += fmt::format("\n{}\n", method.label);
        if (!reason.empty()) text += fmt::format("  Note: {}\n", reason);
        for (const pixel::Fact& fact : facts)
            text += fmt::format("  {:<16} {}\n  {:<16}   {}\n", fact.name, fact_text(fact), "", fact.text);
    }
    return text.empty() ? text : "\nHow the methods arrived at their values; fragments are numbered as above\n" + text;
}

}  // namespace

std::string pixel_table(const pixel::Pixel& pixel) {
    return fmt::format("Pixel {}, {}: {} transparent fragments, near to far\n\n{}\n{}{}", pixel.x, pixel.y,
                       pixel.fragments.size(), stack_table(pixel), method_table(pixel), explanations(pixel));
}

}  // namespace sheer
