#include "server/postgres/local_copies.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "renderer/core/sha256.h"

namespace sheer::postgres {

namespace fs = std::filesystem;

namespace {

constexpr std::chrono::hours kept_unused{24}, removal_interval{1};
constexpr std::size_t hash_digits = 64;

/// Every run of 64 hexadecimal digits: no text has one by chance.
std::vector<std::string> hashes_in(const std::string& text) {
    const auto is_digit = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
    std::set<std::string> hashes;
    for (auto begin = std::ranges::find_if(text, is_digit); begin != text.end();) {
        const auto end = std::find_if_not(begin, text.end(), is_digit);
        if (static_cast<std::size_t>(end - begin) == hash_digits && is_sha256(std::string(begin, end)))
            hashes.insert(std::string(begin, end));
        begin = std::find_if(end, text.end(), is_digit);
    }
    return {hashes.begin(), hashes.end()};
}

bool is_unused(const fs::path& file) {
    std::error_code gone;
    const auto used = fs::last_write_time(file, gone);
    return !gone && fs::file_time_type::clock::now() - used > kept_unused;
}

void note_use(const fs::path& file) {
    std::error_code not_noted;
    fs::last_write_time(file, fs::file_time_type::clock::now(), not_noted);
}

}  // namespace

LocalCopies::LocalCopies(Database& database, const DataFolder& folder)
    : m_database(database), m_blobs(folder.blobs()), m_assets(folder.assets()) {
    m_blobs.make();
    m_assets.make();
}

void LocalCopies::bring(const std::string& text) {
    remove_unused();
    const std::vector<std::string> names = hashes_in(text);
    if (names.empty()) return;
    bring("blobs", m_blobs, names);
    bring("assets", m_assets, names);
}

void LocalCopies::bring(const std::string& table, ContentFolder& folder, const std::vector<std::string>& names) {
    const auto there = m_database.read([&](Connection& connection) {
        const Rows rows = connection.run(fmt::format("SELECT sha256 FROM {} WHERE sha256 = ANY ($1)", table), {names});
        std::vector<std::string> found;
        for (int i = 0; i < rows.count(); ++i) found.push_back(rows.text(i, 0));
        return found;
    });
    // What was deleted in the store must not be found here.
    for (const std::string& sha256 : names)
        if (std::ranges::find(there, sha256) == there.end() && folder.find(sha256)) folder.remove(sha256);
    for (const std::string& sha256 : there) {
        if (folder.is_whole(sha256)) {
            note_use(*folder.find(sha256));
            continue;
        }
        m_database.read([&](Connection& connection) {
            const Rows row = connection.run(fmt::format("SELECT bytes FROM {} WHERE sha256 = $1", table), {sha256});
            if (!row.empty()) folder.put(sha256, std::string(row.bytes(0, 0)));
        });
    }
}

void LocalCopies::remove_unused() {
    {
        const std::lock_guard lock(m_mutex);
        const auto now = std::chrono::steady_clock::now();
        if (now < m_next_removal) return;
        m_next_removal = now + removal_interval;
    }
    for (ContentFolder* folder : {&m_blobs, &m_assets}) {
        folder->remove_leftovers(removal_interval);
        for (const std::string& sha256 : folder->list())
            if (const auto file = folder->find(sha256); file && is_unused(*file)) folder->remove(sha256);
    }
}

}  // namespace sheer::postgres
