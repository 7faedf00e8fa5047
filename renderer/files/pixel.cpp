#include "renderer/files/pixel.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "renderer/files/picture_file.h"
#include "renderer/frame/magma.h"

namespace sheer {

using nlohmann::json;

namespace {

json fragment_json(const PixelFragment& fragment) {
    return {{"depth", fragment.depth},
            {"color", fragment.color},
            {"alpha", fragment.alpha},
            {"primitive", fragment.primitive},
            {"transmittance_before", fragment.transmittance_before},
            {"weight", fragment.weight}};
}

/// Of a picture in 8 bits and of one in floats: more than rounding.
constexpr double greatest_rounding = 1.5 / 255;

json facts_json(const std::vector<PixelFact>& facts) {
    json array = json::array();
    for (const PixelFact& fact : facts)
        array.push_back({{"name", fact.name}, {"kind", fact.kind}, {"value", fact.value}, {"text", fact.text}});
    return array;
}

/// Which number a colour of count_picture stands for.
std::uint32_t count_of(const Rgb& color, std::uint32_t full_scale) {
    std::array<std::uint8_t, 3> wanted{};
    for (std::size_t i = 0; i < 3; ++i) wanted[i] = static_cast<std::uint8_t>(std::lround(color[i] * 255));
    const auto level = static_cast<std::uint32_t>(std::ranges::find(magma(), wanted) - magma().begin());
    if (level == magma().size()) throw std::runtime_error("a picture of counts has a colour that stands for none");
    return (level * full_scale + most_counts_in_colours / 2) / most_counts_in_colours;
}

class PixelWriter {
  public:
    PixelWriter(const PixelStack& stack, int x, int y, const PictureReader& read_picture)
        : m_stack(stack), m_x(x), m_y(y), m_read_picture(read_picture) {}

    json reference(const json& of_report) const {
        json object = {{"method", of_report.at("method")}};
        add_value(object, of_report.at("images"));
        return object;
    }

    json method(const json& result, const Explanation* explanation) const {
        json object = {{"method", result.at("method")},
                       {"label", result.at("label")},
                       {"status", result.at("status")},
                       {"reason", result.at("reason")},
                       {"value", nullptr},
                       {"difference", nullptr},
                       {"shaded", nullptr},
                       {"needed", nullptr},
                       {"saturated_at", nullptr},
                       {"explanation", nullptr}};
        if (result.at("status") != "ok") return object;
        add_value(object, result.at("images"));
        add_counts(object, result);
        add_explanation(object, explanation);
        return object;
    }

  private:
    Rgb value_in(const json& image) const { return read_pixel(m_read_picture(image), m_x, m_y); }

    /// From the picture in floats where there is one.
    void add_value(json& object, const json& images) const {
        const Rgb value = value_in(images.contains("linear") ? images["linear"] : images.at("color"));
        Rgb difference;
        for (std::size_t i = 0; i < 3; ++i) difference[i] = m_stack.sum[i] - value[i];
        object["value"] = value;
        object["difference"] = difference;
    }

    /// The method was drawn again for it, perhaps by another driver than the report's.
    void add_explanation(json& object, const Explanation* explanation) const {
        if (!explanation || !explanation->value) {
            object["explanation_reason"] = explanation ? explanation->reason : "the method was not drawn again";
            return;
        }
        object["explanation"] = facts_json(explanation->facts);
        object["explained_value"] = *explanation->value;
        for (std::size_t i = 0; i < 3; ++i)
            if (std::abs((*explanation->value)[i] - object["value"][i].get<double>()) > greatest_rounding)
                object["explanation_reason"] =
                    "drawn again, the pixel is not as in the report's picture; this explains the new one";
    }

    void add_counts(json& object, const json& result) const {
        add_count(object, "shaded", result, "shaded");
        if (!result.at("parameters").contains("threshold")) {
            object["needed"] = m_stack.fragments.size();
            object["saturated_at_reason"] = "the method has no threshold";
            return;
        }
        add_count(object, "saturated_at", result, "saturation");
        // A pixel that is never saturated needs all of its fragments.
        if (object["saturated_at"].is_null()) {
            object["needed_reason"] = object["saturated_at_reason"];
        } else if (object["saturated_at"] == 0) {
            object["needed"] = m_stack.fragments.size();
            object["saturated_at"] = nullptr;
            object["saturated_at_reason"] = "enough of the transmittance is left";
        } else {
            object["needed"] = object["saturated_at"];
        }
    }

    void add_count(json& object, const std::string& key, const json& result, const std::string& picture) const {
        const json& images = result.at("images");
        const std::string reason = key + "_reason";
        if (!images.contains(picture)) {
            const std::string why = (picture == "shaded" ? "shaded" : "needed") + std::string("_reason");
            object[reason] = result.at("fragments").value(why, "the report has no picture of it");
            return;
        }
        const auto full_scale = images[picture].at("full_scale").get<std::uint32_t>();
        if (images.contains(picture + "_counts")) {
            object[key] = std::lround(value_in(images[picture + "_counts"])[0]);
            return;
        }
        if (full_scale > most_counts_in_colours) {
            object[reason] = fmt::format("the report's picture has 256 colours for counts of 0 to {}", full_scale);
            return;
        }
        object[key] = count_of(value_in(images[picture]), full_scale);
    }

    const PixelStack& m_stack;
    const int m_x, m_y;
    const PictureReader& m_read_picture;
};

std::string color_text(const json& color) {
    if (color.is_null()) return fmt::format("{:>29}", "-");
    return fmt::format("{:9.6f} {:9.6f} {:9.6f}", color[0].get<double>(), color[1].get<double>(),
                       color[2].get<double>());
}

std::string trimmed_color(const json& color) {
    return fmt::format("{:.6f} {:.6f} {:.6f}", color[0].get<double>(), color[1].get<double>(), color[2].get<double>());
}

std::string count_text(const json& count) {
    return count.is_null() ? "-" : count.dump();
}

std::string stack_table(const json& pixel) {
    std::string text = fmt::format("{:>5} {:>10} {:>29} {:>9} {:>9} {:>13} {:>9}\n", "", "depth",
                                   "red     green      blue", "alpha", "primitive", "transmittance", "weight");
    std::size_t number = 0;
    for (const json& fragment : pixel.at("fragments"))
        text += fmt::format("{:>5} {:>10.7f} {} {:>9.6f} {:>9} {:>13.6f} {:>9.6f}\n", ++number,
                            fragment["depth"].get<double>(), color_text(fragment["color"]),
                            fragment["alpha"].get<double>(), fragment["primitive"].get<std::uint32_t>(),
                            fragment["transmittance_before"].get<double>(), fragment["weight"].get<double>());
    const json& opaque = pixel.at("opaque");
    const auto transmittance = pixel.at("transmittance").get<double>();
    text += fmt::format("{:>5} {:>10} {} {:>9} {:>9} {:>13.6f} {:>9.6f}\n", "",
                        opaque.is_null() ? "background" : fmt::format("{:.7f}", opaque["depth"].get<double>()),
                        color_text(opaque.is_null() ? pixel.at("background") : opaque["color"]),
                        opaque.is_null() ? "" : "opaque", "", transmittance, transmittance);
    return text;
}

std::string method_table(const json& pixel) {
    const auto line = [](const std::string& name, const json& value, const json& difference) {
        return fmt::format("{:<24} {} {}", name, color_text(value), color_text(difference));
    };
    std::string text = fmt::format("{:<24} {:>29} {:>29} {:>7} {:>7} {:>9}\n", "", "red     green      blue",
                                   "sum minus value", "shaded", "needed", "saturated");
    text += fmt::format("{:<24} {}\n", "sum", color_text(pixel.at("sum")));
    const json& reference = pixel.at("reference");
    text +=
        line("reference " + reference["method"].get<std::string>(), reference["value"], reference["difference"]) + "\n";
    for (const json& method : pixel.at("methods")) {
        text += line(method["label"], method["value"], method["difference"]);
        if (method["status"] == "ok") {
            text += fmt::format(" {:>7} {:>7} {:>9}\n", count_text(method["shaded"]), count_text(method["needed"]),
                                count_text(method["saturated_at"]));
        } else {
            text += fmt::format(" {}: {}\n", method["status"].get<std::string>(), method["reason"].get<std::string>());
        }
    }
    return text;
}

/// 1-4, 7, or 4-1, 7: three or more in a row, up or down, are a range.
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

std::string fact_text(const json& fact) {
    const std::string kind = fact["kind"];
    const json& value = fact["value"];
    if (kind == "color") return trimmed_color(value);
    if (kind == "fragments") return fragments_text(value);
    if (value.is_null()) return "none";
    if (kind == "number" && value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    if (!value.is_array()) return value.dump();
    std::vector<std::string> parts;
    for (const json& sample : value)
        parts.push_back(fmt::format("{}: {}", sample["fragment"].is_null() ? "opaque" : sample["fragment"].dump(),
                                    trimmed_color(sample["color"])));
    return fmt::format("{}", fmt::join(parts, "; "));
}

/// A method's heading, then a line for each fact and what it means below.
std::string explanations(const json& pixel) {
    std::string text;
    for (const json& method : pixel.at("methods")) {
        const std::string reason = method.value("explanation_reason", "");
        if (method["status"] != "ok" || (method["explanation"].empty() && reason.empty())) continue;
        text += fmt::format("\n{}\n", method["label"].get<std::string>());
        if (!reason.empty()) text += fmt::format("  Note: {}\n", reason);
        if (method["explanation"].is_null()) continue;
        for (const json& fact : method["explanation"])
            text += fmt::format("  {:<16} {}\n  {:<16}   {}\n", fact["name"].get<std::string>(), fact_text(fact), "",
                                fact["text"].get<std::string>());
    }
    return text.empty() ? text : "\nHow the methods came to their values; fragments are numbered as above\n" + text;
}

}  // namespace

json pixel_report(const PixelStack& stack, int x, int y, const json& run, const PictureReader& read_picture) {
    const PixelWriter writer(stack, x, y, read_picture);
    json opaque = nullptr;
    if (stack.opaque) opaque = {{"depth", stack.opaque->depth}, {"color", stack.opaque->color}};
    json fragments = json::array(), methods = json::array();
    for (const PixelFragment& fragment : stack.fragments) fragments.push_back(fragment_json(fragment));
    for (const json& result : run.at("results")) {
        const std::size_t number = methods.size();
        methods.push_back(writer.method(result, number < stack.methods.size() ? &stack.methods[number] : nullptr));
    }
    return {{"x", x},
            {"y", y},
            {"point", run.at("point")},
            {"background", stack.background},
            {"opaque", opaque},
            {"fragments", fragments},
            {"transmittance", stack.transmittance},
            {"sum", stack.sum},
            {"reference", writer.reference(run.at("reference"))},
            {"methods", methods}};
}

std::string pixel_table(const json& pixel) {
    return fmt::format("Pixel {}, {}: {} transparent fragments, near to far\n\n{}\n{}{}", pixel.at("x").dump(),
                       pixel.at("y").dump(), pixel.at("fragments").size(), stack_table(pixel), method_table(pixel),
                       explanations(pixel));
}

}  // namespace sheer
