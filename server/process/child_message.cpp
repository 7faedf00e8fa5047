#include "server/process/child_message.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace sheer {

using nlohmann::json;

namespace {

constexpr std::size_t max_stage_bytes = 200;
constexpr std::size_t max_detail_bytes = 2000;

/// Cuts at the limit, but not within a UTF-8 character.
std::string shortened(std::string text, std::size_t max_bytes) {
    if (text.size() <= max_bytes) return text;
    std::size_t end = max_bytes;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return text.substr(0, end) + "...";
}

std::string text_of(const json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

ChildError read_error(const json& error) {
    static const std::map<std::string, std::string> titles{
        {"spec", "The spec is wrong"}, {"storage", report_not_kept}, {"unsupported", "Not supported on this device"}};
    const std::string kind = text_of(error, "kind");
    const auto title = titles.find(kind);
    return {.error = {title == titles.end() ? "Rendering failed" : title->second,
                      shortened(text_of(error, "detail"), max_detail_bytes)},
            .is_of_disk = kind == "storage",
            .lacks_room = error.value("full", json()) == true};
}

}  // namespace

ChildMessage read_child_message(const std::string& line) {
    const json message = json::parse(line, nullptr, false);
    if (!message.is_object()) return {};
    if (const auto error = message.find("error"); error != message.end() && error->is_object())
        return read_error(*error);
    if (const auto progress = message.find("progress"); progress != message.end() && progress->is_number())
        return ChildProgress{std::clamp(progress->get<double>(), 0.0, 1.0),
                             shortened(text_of(message, "stage"), max_stage_bytes)};
    return {};
}

}  // namespace sheer
