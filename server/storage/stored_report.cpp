#include "server/storage/stored_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/core/sha256.h"
#include "server/jobs/facets.h"
#include "server/jobs/limits.h"
#include "server/jobs/store_errors.h"
#include "server/storage/packed_text.h"

namespace sheer {

using nlohmann::json;

namespace {

/// The picture_text() of each picture of a reference or a result.
void collect_pictures(const json& part, std::vector<std::string>& found) {
    for (const json& picture : part.value("images", json::object()))
        found.push_back(picture_text(picture.value("sha256", ""), picture.value("media_type", "")));
}

std::vector<std::string> pictures_in(const json& report) {
    std::vector<std::string> pictures;
    for (const json& run : report.value("runs", json::array())) {
        collect_pictures(run.value("reference", json::object()), pictures);
        for (const json& result : run.value("results", json::array())) collect_pictures(result, pictures);
    }
    return pictures;
}

std::vector<std::string> sorted(std::vector<std::string> texts) {
    std::ranges::sort(texts);
    const auto [first, last] = std::ranges::unique(texts);
    texts.erase(first, last);
    return texts;
}

}  // namespace

std::string stored_report_text(std::string_view packed, const std::string& sha256, const std::string& id) {
    std::string text;
    try {
        text = unpack_text(packed, max_report_bytes);
    } catch (const DamagedData&) {
        throw DamagedData(fmt::format("the text of report {} cannot be read", id));
    }
    if (sha256_hex(text) != sha256) throw DamagedData(fmt::format("the text of report {} has another hash", id));
    return text;
}

std::string tag_text(const std::string& name, const std::string& value) {
    return name + "\x1f" + value;
}

std::string picture_text(const std::string& sha256, const std::string& media_type) {
    return sha256 + " " + media_type;
}

json joined_runs(const std::vector<EndedPart>& parts) {
    json runs = json::array();
    for (const EndedPart& part : parts) {
        const json report = json::parse(part.report, nullptr, false);
        if (!report.is_object()) continue;
        for (const json& run : report.value("runs", json::array())) runs.push_back(run);
    }
    return {{"runs", runs}};
}

std::vector<std::string> wrong_relations(const std::string& spec, const json& report, const StoredRelations& stored) {
    std::vector<std::string> wrong;
    const Facets facets = facets_of(json::parse(spec, nullptr, false));
    if (stored.methods != facets.methods) wrong.emplace_back("its methods are not those of its spec");
    std::vector<std::string> tags;
    for (const auto& [name, value] : facets.tags.items()) tags.push_back(tag_text(name, value.get<std::string>()));
    if (sorted(stored.tags) != sorted(tags)) wrong.emplace_back("its tags are not those of its spec");
    if (report.is_object() && sorted(pictures_in(report)) != sorted(stored.pictures))
        wrong.emplace_back("its pictures are not those that its text names");
    return wrong;
}

}  // namespace sheer
