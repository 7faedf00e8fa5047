#include "server/cli/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ranges>
#include <system_error>

#include "renderer/core/files.h"
#include "renderer/core/sha256.h"
#include "server/cli/commands.h"

namespace sheer::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char *work_name = ".sheer-partial", *lock_name = "lock", *new_name = "new", *old_name = "old",
                     *incomplete_name = "incomplete", *pictures_name = "images";

bool is_there(const fs::path& path) {
    return fs::exists(fs::symlink_status(path));
}

/// Moves a file to a free name. Throws std::system_error, also if the name is taken.
void move_to_free_place(const fs::path& from, const fs::path& to) {
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return;
    // Not every file system can do this in one step.
    const bool must_look = errno == EINVAL || errno == ENOSYS;
    if (must_look && !is_there(to) && std::rename(from.c_str(), to.c_str()) == 0) return;
    throw std::system_error(must_look && is_there(to) ? EEXIST : errno, std::generic_category(),
                            fmt::format("cannot move {} to {}", from.string(), to.string()));
}

/// Moves files, and moves them back unless everything succeeded.
class Moves {
  public:
    Moves() = default;
    ~Moves() {
        for (const auto& [from, to] : std::views::reverse(m_done)) std::rename(to.c_str(), from.c_str());
    }
    Moves(const Moves&) = delete;
    Moves& operator=(const Moves&) = delete;

    void move(const fs::path& from, const fs::path& to) {
        fs::create_directories(to.parent_path());
        move_to_free_place(from, to);
        m_done.emplace_back(from, to);
    }
    void keep() { m_done.clear(); }

  private:
    std::vector<std::pair<fs::path, fs::path>> m_done;
};

std::vector<std::string> files_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) names.push_back(fs::relative(entry.path(), folder).generic_string());
    return names;
}

[[noreturn]] void refuse_foreign(const fs::path& file, const Manifest& manifest) {
    const char* why = manifest.is_empty() ? "there is no manifest saying that Sheer wrote it (older versions kept none)"
                                          : "according to the manifest, Sheer did not write it as it is now";
    throw UsageError(fmt::format(
        "{} already exists, and {}. It is left as it is: move it away, or choose another folder", file.string(), why));
}

[[noreturn]] void refuse_unwritable(const fs::path& folder, int error) {
    throw UsageError(fmt::format("cannot write into {}: {}", folder.string(), std::generic_category().message(error)));
}

/// Opens and locks the lock file in `folder`. Returns -1 if it was removed meanwhile by a process that has just ended.
int take_lock(const fs::path& folder) {
    const fs::path file = folder / lock_name;
    const int lock = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (lock < 0 && errno == ENOENT) return -1;
    if (lock < 0) refuse_unwritable(folder, errno);
    if (flock(lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        close(lock);
        throw UsageError(fmt::format("another Sheer process is writing into {}", folder.parent_path().string()));
    }
    // On file systems without locks, two simultaneous processes go unnoticed.
    struct stat locked {
    }, there{};
    if (fstat(lock, &locked) == 0 && lstat(file.c_str(), &there) == 0 && locked.st_ino == there.st_ino) return lock;
    close(lock);
    return -1;
}

}  // namespace

OutputFolder::OutputFolder(fs::path folder, OutputNames names)
    : m_folder(std::move(folder)), m_names(std::move(names)) {
    if (m_folder.empty()) throw UsageError("the name of the folder is empty");
    if (!m_folder.has_filename()) m_folder = m_folder.parent_path();
    m_work = m_folder / work_name;
    try {
        if (is_there(m_folder) && !fs::is_directory(m_folder)) throw UsageError(m_folder.string() + " is not a folder");
        m_manifest = Manifest::read(m_folder);
        check_names(m_folder, m_manifest);
        make_folder();
        lock_partial();
        fs::create_directories(partial());
    } catch (const fs::filesystem_error& error) {
        discard();
        refuse_unwritable(m_folder, error.code().value());
    } catch (...) {
        discard();
        throw;
    }
}

fs::path OutputFolder::partial() const {
    return m_work / new_name;
}

void OutputFolder::check_names(const fs::path& folder, const Manifest& manifest) const {
    if (!manifest.is_empty() && manifest.main_file() != m_names.main_file)
        throw UsageError(fmt::format("{} contains a {} of Sheer's; choose another folder for a {}", folder.string(),
                                     manifest.main_file(), m_names.main_file));
    const auto check = [&](const std::string& name) {
        if (is_there(folder / name) && !manifest.owns(folder, name)) refuse_foreign(folder / name, manifest);
    };
    check(m_names.main_file);
    for (const std::string& name : m_names.others) check(name);
    const fs::path pictures = folder / pictures_name;
    if (!is_there(pictures)) return;
    if (fs::symlink_status(pictures).type() != fs::file_type::directory) refuse_foreign(pictures, manifest);
    for (const auto& entry : fs::directory_iterator(pictures)) {
        const std::string name = entry.path().filename().string();
        const auto is_ours = [&](const std::string& stem) { return name.starts_with(stem + "."); };
        if (std::ranges::any_of(m_names.picture_stems, is_ours)) check(fmt::format("{}/{}", pictures_name, name));
    }
}

void OutputFolder::make_folder() {
    std::vector<fs::path> missing;
    for (fs::path above = fs::absolute(m_folder); !is_there(above); above = above.parent_path())
        missing.push_back(above);
    for (const fs::path& folder : std::views::reverse(missing))
        if (fs::create_directory(folder)) m_made.push_back(folder);
}

void OutputFolder::lock_partial() {
    while (m_lock < 0) {
        if (mkdir(m_work.c_str(), 0777) != 0 && errno != EEXIST) refuse_unwritable(m_folder, errno);
        const fs::file_status status = fs::symlink_status(m_work);
        if (status.type() == fs::file_type::not_found) continue;
        if (status.type() != fs::file_type::directory || (!fs::is_empty(m_work) && !is_there(m_work / lock_name)))
            refuse_foreign(m_work, m_manifest);
        m_lock = take_lock(m_work);
    }
    // No process works here: what is left is from a process that died.
    for (const char* name : {new_name, old_name}) fs::remove_all(m_work / name);
}

fs::path OutputFolder::commit(bool complete) {
    const bool keeps_old = !complete && !m_manifest.is_empty() && m_manifest.is_complete();
    const fs::path incomplete = m_folder / incomplete_name, target = keeps_old ? incomplete : m_folder;
    fs::create_directories(target);
    publish(target, complete);
    if (complete) clear(incomplete);
    discard();
    return target;
}

void OutputFolder::publish(const fs::path& folder, bool complete) {
    const Manifest old = Manifest::read(folder);
    check_names(folder, old);
    std::vector<std::string> names = files_in(partial());
    // The main file comes last: if it is there, so is everything that it names.
    std::ranges::stable_partition(names, [&](const std::string& name) { return name != m_names.main_file; });
    Manifest now(m_names.main_file, complete);
    for (const std::string& name : names) {
        if (is_there(folder / name) && !old.owns(folder, name)) refuse_foreign(folder / name, old);
        now.add({name, sha256_hex(read_file(partial() / name))});
    }
    // While files are moved, the manifest names those of both reports, so that none is lost track of if this process
    // dies.
    Manifest both = now;
    for (const Manifest::Entry& entry : old.entries()) both.add(entry);
    const fs::path manifest = folder / Manifest::file_name;
    write_file(m_work / "both.json", both.text());
    write_file(m_work / "now.json", now.text());
    write_file(m_work / "before.json", old.text());
    fs::rename(m_work / "both.json", manifest);
    try {
        Moves moves;
        for (const Manifest::Entry& entry : std::views::reverse(old.entries()))
            if (old.owns(folder, entry.name)) moves.move(folder / entry.name, m_work / old_name / entry.name);
        for (const std::string& name : names) moves.move(partial() / name, folder / name);
        moves.keep();
    } catch (...) {
        if (old.is_empty()) {
            fs::remove(manifest);
        } else {
            fs::rename(m_work / "before.json", manifest);
        }
        throw;
    }
    fs::rename(m_work / "now.json", manifest);
}

/// Removes a report that Sheer wrote into `folder`, and the folder if nothing else is in it.
void OutputFolder::clear(const fs::path& folder) const {
    if (fs::symlink_status(folder).type() != fs::file_type::directory || !is_there(folder / Manifest::file_name))
        return;
    const Manifest manifest = Manifest::read(folder);
    for (const Manifest::Entry& entry : manifest.entries())
        if (manifest.owns(folder, entry.name)) fs::remove(folder / entry.name);
    fs::remove(folder / Manifest::file_name);
    for (const fs::path& emptied : {folder / pictures_name, folder})
        if (fs::is_directory(fs::symlink_status(emptied)) && fs::is_empty(emptied)) fs::remove(emptied);
}

void OutputFolder::discard() noexcept {
    std::error_code ignored;
    if (m_lock >= 0) {
        for (const char* name : {new_name, old_name, "both.json", "now.json", "before.json", lock_name})
            fs::remove_all(m_work / name, ignored);
        close(m_lock);
        m_lock = -1;
    }
    // This removes only empty folders.
    rmdir(m_work.c_str());
    for (const fs::path& folder : std::views::reverse(m_made)) rmdir(folder.c_str());
    m_made.clear();
}

}  // namespace sheer::cli
