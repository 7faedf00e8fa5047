#include "server/storage/content_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "renderer/core/sha256.h"

namespace sheer {

namespace fs = std::filesystem;

namespace {

constexpr const char* temporary_suffix = ".tmp-XXXXXX";
constexpr std::string_view temporary_mark = ".tmp-";

bool means_full(int error) {
    return error == ENOSPC || error == EDQUOT;
}

[[noreturn]] void fail(const std::string& what, const fs::path& path) {
    if (means_full(errno)) throw StoreFull(fmt::format("the archive's disk is full: {}", std::strerror(errno)));
    throw DiskError(fmt::format("{} {}: {}", what, path.string(), std::strerror(errno)));
}

/// An open file descriptor of `path`.
class Descriptor {
  public:
    Descriptor(int descriptor, fs::path path) : m_path(std::move(path)), m_descriptor(descriptor) {
        if (m_descriptor < 0) fail("cannot open", m_path);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close(m_descriptor); }

    void write_all(const std::string& bytes) {
        for (std::size_t done = 0; done < bytes.size();) {
            const ssize_t count = write(m_descriptor, bytes.data() + done, bytes.size() - done);
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) fail("cannot write", m_path);
            done += static_cast<std::size_t>(count);
        }
    }

    std::uint64_t size_bytes() const {
        struct stat status {};
        if (fstat(m_descriptor, &status) != 0) fail("cannot examine", m_path);
        return static_cast<std::uint64_t>(status.st_size);
    }

    void read_at(std::uint64_t offset, std::span<char> bytes) const {
        while (!bytes.empty()) {
            const ssize_t count = pread(m_descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) fail("cannot read", m_path);
            if (count == 0) throw DiskError(fmt::format("{} is shorter than it was", m_path.string()));
            offset += static_cast<std::uint64_t>(count);
            bytes = bytes.subspan(static_cast<std::size_t>(count));
        }
    }

    void sync() {
        if (fsync(m_descriptor) != 0) fail("cannot sync", m_path);
    }

  private:
    fs::path m_path;
    int m_descriptor;
};

void sync_folder(const fs::path& folder) {
    Descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC), folder).sync();
}

/// Removes the file unless it was renamed into its place.
class TemporaryFile {
  public:
    explicit TemporaryFile(fs::path path) : m_path(std::move(path)) {}
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        if (!m_path.empty()) unlink(m_path.c_str());
    }

    void rename_to(const fs::path& place) {
        if (rename(m_path.c_str(), place.c_str()) != 0) fail("cannot rename", m_path);
        m_path.clear();
    }

  private:
    fs::path m_path;
};

void make_folder(const fs::path& folder) {
    std::error_code error;
    const bool made = fs::create_directories(folder, error);
    errno = error.value();
    if (error) fail("cannot make", folder);
    if (made && folder.has_parent_path()) sync_folder(folder.parent_path());
}

/// Makes a file in the same folder as `place`; the folder may vanish at any time when its last file is removed.
int make_temporary(const fs::path& place, std::string& path) {
    for (int tries = 0;; ++tries) {
        make_folder(place.parent_path());
        path = place.string() + temporary_suffix;
        const int descriptor = mkostemp(path.data(), O_CLOEXEC);
        if (descriptor >= 0 || errno != ENOENT || tries == 9) return descriptor;
    }
}

class FileContent : public Content {
  public:
    explicit FileContent(const fs::path& path)
        : m_file(::open(path.c_str(), O_RDONLY | O_CLOEXEC), path), m_size_bytes(m_file.size_bytes()) {}
    std::uint64_t size_bytes() const override { return m_size_bytes; }
    void read(std::uint64_t offset, std::span<char> bytes) const override { m_file.read_at(offset, bytes); }

  private:
    const Descriptor m_file;
    const std::uint64_t m_size_bytes;
};

std::string sha256_of(const Content& content) {
    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
    bool right = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
    std::vector<char> bytes(1 << 18);
    for (std::uint64_t done = 0; right && done < content.size_bytes();) {
        const auto piece = std::span(bytes).first(std::min<std::uint64_t>(bytes.size(), content.size_bytes() - done));
        content.read(done, piece);
        right = EVP_DigestUpdate(context.get(), piece.data(), piece.size()) == 1;
        done += piece.size();
    }
    std::array<unsigned char, 32> digest{};
    if (!right || EVP_DigestFinal_ex(context.get(), digest.data(), nullptr) != 1) throw StoreError("SHA-256 failed");
    std::string text;
    for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
    return text;
}

bool needs_no_writing(const fs::path& place, const std::string& sha256) {
    std::error_code none;
    if (!fs::is_regular_file(place, none)) return false;
    try {
        if (sha256_of(FileContent(place)) == sha256) return true;
        spdlog::error("the file {} is damaged and is written again", place.string());
    } catch (const StoreError& error) {
        spdlog::error("{}; it is written again", error.what());
    }
    return false;
}

}  // namespace

void ContentFolder::make() const {
    make_folder(m_folder);
}

fs::path ContentFolder::place_of(const std::string& sha256) const {
    if (!is_sha256(sha256)) throw StoreError("not a SHA-256: " + sha256);
    return m_folder / sha256.substr(0, 2) / sha256;
}

bool ContentFolder::put(const std::string& sha256, const std::string& bytes) {
    if (sha256_hex(bytes) != sha256) throw StoreError("the bytes of " + sha256 + " have another hash");
    const fs::path place = place_of(sha256);
    if (needs_no_writing(place, sha256)) return false;
    std::string temporary_path;
    Descriptor file(make_temporary(place, temporary_path), place);
    TemporaryFile temporary(temporary_path);
    file.write_all(bytes);
    file.sync();
    temporary.rename_to(place);
    sync_folder(place.parent_path());
    return true;
}

ContentPtr ContentFolder::open(const std::string& sha256) const {
    const auto path = find(sha256);
    if (!path) throw DamagedData(fmt::format("the file {} is missing", sha256));
    std::shared_ptr<const FileContent> content;
    std::string actual;
    try {
        content = std::make_shared<FileContent>(*path);
        actual = sha256_of(*content);
    } catch (const StoreError&) {
        throw DamagedData(fmt::format("the file {} cannot be read", sha256));
    }
    if (actual != sha256) throw DamagedData(fmt::format("the bytes of the file {} have another hash", sha256));
    return content;
}

std::optional<fs::path> ContentFolder::find(const std::string& sha256) const {
    if (!is_sha256(sha256)) return std::nullopt;
    fs::path path = place_of(sha256);
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return std::nullopt;
    return path;
}

bool ContentFolder::is_whole(const std::string& sha256) const {
    try {
        open(sha256);
        return true;
    } catch (const DamagedData&) {
        return false;
    }
}

std::vector<std::string> ContentFolder::list() const {
    std::vector<std::string> names;
    // A folder that is removed meanwhile ends the loop.
    std::error_code gone;
    for (fs::recursive_directory_iterator at(m_folder, gone), end; !gone && at != end; at.increment(gone))
        if (const std::string name = at->path().filename().string(); find(name) == at->path()) names.push_back(name);
    return names;
}

std::int64_t ContentFolder::size_bytes(const std::string& sha256) const {
    const auto path = find(sha256);
    std::error_code error;
    const std::uintmax_t size = path ? fs::file_size(*path, error) : 0;
    return error ? 0 : static_cast<std::int64_t>(size);
}

void ContentFolder::remove(const std::string& sha256) {
    const fs::path path = place_of(sha256);
    if (unlink(path.c_str()) != 0 && errno != ENOENT) fail("cannot remove", path);
    // A folder uses an inode; one that holds other files stays.
    rmdir(path.parent_path().c_str());
}

void ContentFolder::remove_leftovers(std::chrono::seconds age) {
    const auto oldest = fs::file_time_type::clock::now() - age;
    // A folder that is removed meanwhile ends the loop; the next start removes the rest.
    std::error_code gone;
    for (fs::recursive_directory_iterator at(m_folder, gone), end; !gone && at != end; at.increment(gone)) {
        const fs::directory_entry& entry = *at;
        if (entry.path().filename().string().find(temporary_mark) == std::string::npos) continue;
        const fs::file_time_type written = entry.last_write_time(gone);
        if (!gone && written < oldest) fs::remove(entry.path(), gone);
    }
}

}  // namespace sheer
