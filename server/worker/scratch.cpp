#include "server/worker/scratch.h"

#include <fmt/format.h>

namespace sheer {

namespace fs = std::filesystem;

namespace {

fs::path attempt_path(const fs::path& folder, const std::string& id, int attempt, int parts_ended) {
    const std::string part = parts_ended == 0 ? "" : fmt::format("p{}.", parts_ended);
    return folder / fmt::format("{}-{}{}", id, part, attempt);
}

}  // namespace

ScratchFolder::ScratchFolder(const fs::path& folder, const std::string& id, int attempt, int parts_ended)
    : m_path(attempt_path(folder, id, attempt, parts_ended)) {
    fs::create_directories(folder);
    // After a disk error there may be files that can be neither read nor removed; that is no reason for this attempt to
    // fail.
    std::error_code not_removed;
    for (int earlier = 1; earlier <= attempt; ++earlier)
        fs::remove_all(attempt_path(folder, id, earlier, parts_ended), not_removed);
    for (int another = 1; !fs::create_directory(m_path); ++another)
        m_path = fmt::format("{}.{}", attempt_path(folder, id, attempt, parts_ended).string(), another);
}

ScratchFolder::~ScratchFolder() {
    std::error_code left_to_the_next_sweep;
    fs::remove_all(m_path, left_to_the_next_sweep);
}

void copy_shaders(const fs::path& from, const fs::path& to) {
    constexpr std::uint64_t most_bytes = 64 << 20;
    std::uint64_t all_bytes = 0;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(from, none)) {
        std::error_code left_out;
        const fs::path copy = to / entry.path().lexically_relative(from);
        if (entry.is_directory(left_out)) fs::create_directories(copy, left_out);
        if (!entry.is_regular_file(left_out)) continue;
        all_bytes += entry.file_size(left_out);
        if (left_out || all_bytes > most_bytes) return;
        fs::create_directories(copy.parent_path(), left_out);
        fs::copy_file(entry.path(), copy, left_out);
    }
}

void sweep_scratch(const fs::path& folder, ReportArchive& reports) {
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
        const std::string name = entry.path().filename().string();
        const auto record = reports.find(name.substr(0, name.rfind('-')));
        std::error_code taken_by_another_sweep;
        if (!record || record->status != Status::running) fs::remove_all(entry.path(), taken_by_another_sweep);
    }
}

}  // namespace sheer
