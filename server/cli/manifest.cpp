#include "server/cli/manifest.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/core/files.h"
#include "renderer/core/sha256.h"
#include "server/cli/commands.h"
#include "version.h"

namespace sheer::cli {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// A name within the folder, at most one level down. Other names in a manifest are not trusted.
bool stays_inside(const fs::path& name) {
    const auto parts = std::distance(name.begin(), name.end());
    return name.is_relative() && (parts == 1 || parts == 2) &&
           std::ranges::none_of(name, [](const fs::path& part) { return part.empty() || part == "." || part == ".."; });
}

Manifest parse_manifest(const json& document) {
    Manifest manifest(document.at("main"), document.at("complete"));
    for (const json& file : document.at("files")) {
        Manifest::Entry entry{file.at("name"), file.at("sha256")};
        if (stays_inside(entry.name)) manifest.add(std::move(entry));
    }
    return manifest;
}

}  // namespace

Manifest Manifest::read(const fs::path& folder) {
    const fs::path file = folder / file_name;
    const fs::file_type type = fs::symlink_status(file).type();
    if (type == fs::file_type::not_found) return {};
    try {
        if (type == fs::file_type::regular) return parse_manifest(json::parse(read_file(file)));
    } catch (const std::exception&) {
        // A file that cannot be read is not a manifest either.
    }
    throw UsageError(fmt::format("{} is not a manifest of Sheer's; remove it or choose another folder", file.string()));
}

std::string Manifest::text() const {
    json files = json::array();
    for (const Entry& entry : m_entries) files.push_back({{"name", entry.name}, {"sha256", entry.sha256}});
    const json document = {{"written_by", fmt::format("sheer {}", version)},
                           {"main", m_main_file},
                           {"complete", m_complete},
                           {"files", files}};
    return document.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

bool Manifest::owns(const fs::path& folder, const std::string& name) const {
    if (std::ranges::find(m_entries, name, &Entry::name) == m_entries.end()) return false;
    // A link, or a file behind one, is outside the folder.
    fs::path part = folder;
    for (const fs::path& next : fs::path(name)) {
        part /= next;
        if (fs::is_symlink(fs::symlink_status(part))) return false;
    }
    if (!fs::is_regular_file(part)) return false;
    std::string sha256;
    try {
        sha256 = sha256_hex(read_file(part));
    } catch (const std::exception&) {
        return false;
    }
    return std::ranges::any_of(m_entries,
                               [&](const Entry& entry) { return entry.name == name && entry.sha256 == sha256; });
}

}  // namespace sheer::cli
