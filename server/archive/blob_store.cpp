#include "server/archive/blob_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <span>
#include <vector>

#include "renderer/report/report.h"

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

    /// Returns how many bytes were read, 0 at the end.
    std::size_t read_some(std::span<char> bytes) {
        while (true) {
            const ssize_t count = read(m_descriptor, bytes.data(), bytes.size());
            if (count >= 0) return static_cast<std::size_t>(count);
            if (errno != EINTR) fail("cannot read", m_path);
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
    Descriptor(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC), folder).sync();
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

/// Makes a file beside `place`, whose folder a removal of its last file may take away at any time.
int make_temporary(const fs::path& place, std::string& path) {
    for (int tries = 0;; ++tries) {
        make_folder(place.parent_path());
        path = place.string() + temporary_suffix;
        const int descriptor = mkostemp(path.data(), O_CLOEXEC);
        if (descriptor >= 0 || errno != ENOENT || tries == 9) return descriptor;
    }
}

bool is_whole(const fs::path& place, const std::string& sha256) {
    std::error_code none;
    if (!fs::is_regular_file(place, none)) return false;
    try {
        if (sha256_of_file(place) == sha256) return true;
        spdlog::error("the file {} is damaged and is written again", place.string());
    } catch (const StoreError& error) {
        spdlog::error("{}; it is written again", error.what());
    }
    return false;
}

}  // namespace

BlobStore::BlobStore(fs::path folder) : m_folder(std::move(folder)) {
    make_folder(m_folder);
}

fs::path blob_path(const fs::path& folder, const std::string& sha256) {
    if (!is_sha256(sha256)) throw StoreError("not a SHA-256: " + sha256);
    return folder / sha256.substr(0, 2) / sha256;
}

bool BlobStore::put(const std::string& sha256, const std::string& bytes) {
    if (sha256_hex(bytes) != sha256) throw StoreError("the bytes of blob " + sha256 + " have another hash");
    const fs::path place = blob_path(m_folder, sha256);
    if (is_whole(place, sha256)) return false;
    std::string temporary_path;
    Descriptor file(make_temporary(place, temporary_path), place);
    TemporaryFile temporary(temporary_path);
    file.write_all(bytes);
    file.sync();
    temporary.rename_to(place);
    sync_folder(place.parent_path());
    return true;
}

fs::path BlobStore::find_whole(const std::string& sha256) const {
    const auto path = find(sha256);
    if (!path) throw DamagedFile(fmt::format("the file {} is missing", sha256));
    std::string actual;
    try {
        actual = sha256_of_file(*path);
    } catch (const StoreError&) {
        throw DamagedFile(fmt::format("the file {} cannot be read", sha256));
    }
    if (actual != sha256) throw DamagedFile(fmt::format("the bytes of the file {} have another hash", sha256));
    return *path;
}

std::optional<fs::path> BlobStore::find(const std::string& sha256) const {
    if (!is_sha256(sha256)) return std::nullopt;
    fs::path path = blob_path(m_folder, sha256);
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return std::nullopt;
    return path;
}

void BlobStore::remove(const std::string& sha256) {
    const fs::path path = blob_path(m_folder, sha256);
    if (unlink(path.c_str()) != 0 && errno != ENOENT) fail("cannot remove", path);
    // A folder takes an inode; one that holds other files stays.
    rmdir(path.parent_path().c_str());
}

void BlobStore::remove_leftovers(std::chrono::seconds age) {
    const auto oldest = fs::file_time_type::clock::now() - age;
    // A folder that is removed meanwhile ends it; the next start sees to the rest.
    std::error_code gone;
    for (fs::recursive_directory_iterator at(m_folder, gone), end; !gone && at != end; at.increment(gone)) {
        const fs::directory_entry& entry = *at;
        if (entry.path().filename().string().find(temporary_mark) == std::string::npos) continue;
        const fs::file_time_type written = entry.last_write_time(gone);
        if (!gone && written < oldest) fs::remove(entry.path(), gone);
    }
}

std::string sha256_of_file(const fs::path& path) {
    Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC), path);
    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
    bool right = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
    std::vector<char> bytes(1 << 18);
    for (std::size_t count; right && (count = file.read_some(bytes)) > 0;)
        right = EVP_DigestUpdate(context.get(), bytes.data(), count) == 1;
    std::array<unsigned char, 32> digest{};
    if (!right || EVP_DigestFinal_ex(context.get(), digest.data(), nullptr) != 1) throw StoreError("SHA-256 failed");
    std::string text;
    for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
    return text;
}

bool is_sha256(const std::string& text) {
    return text.size() == 64 &&
           std::ranges::all_of(text, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

std::string read_file(const fs::path& path, std::uintmax_t max_bytes) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    if (error) throw StoreError(fmt::format("cannot read {}: {}", path.string(), error.message()));
    if (size > max_bytes)
        throw StoreError(fmt::format("{} has {} bytes, over the limit of {}", path.string(), size, max_bytes));
    std::string bytes(size, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!file) throw DiskError("cannot read " + path.string());
    return bytes;
}

}  // namespace sheer
