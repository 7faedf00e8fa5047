#include "server/archive/blob_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "renderer/report/report.h"

namespace sheer {

namespace fs = std::filesystem;

namespace {

constexpr const char* temporary_suffix = ".tmp-XXXXXX";
constexpr std::string_view temporary_mark = ".tmp-";

[[noreturn]] void fail(const std::string& what, const fs::path& path) {
    throw StoreError(fmt::format("{} {}: {}", what, path.string(), std::strerror(errno)));
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
    if (error) throw StoreError(fmt::format("cannot make {}: {}", folder.string(), error.message()));
    if (made && folder.has_parent_path()) sync_folder(folder.parent_path());
}

}  // namespace

BlobStore::BlobStore(fs::path folder) : m_folder(std::move(folder)) {
    make_folder(m_folder);
}

fs::path blob_path(const fs::path& folder, const std::string& sha256) {
    if (!is_sha256(sha256)) throw StoreError("not a SHA-256: " + sha256);
    return folder / sha256.substr(0, 2) / sha256;
}

void BlobStore::put(const std::string& sha256, const std::string& bytes) {
    if (sha256_hex(bytes) != sha256) throw StoreError("the bytes of blob " + sha256 + " have another hash");
    const fs::path place = blob_path(m_folder, sha256);
    if (fs::exists(place)) return;
    make_folder(place.parent_path());
    std::string temporary_path = place.string() + temporary_suffix;
    Descriptor file(mkostemp(temporary_path.data(), O_CLOEXEC), temporary_path);
    TemporaryFile temporary(temporary_path);
    file.write_all(bytes);
    file.sync();
    temporary.rename_to(place);
    sync_folder(place.parent_path());
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
}

void BlobStore::remove_leftovers(std::chrono::seconds age) {
    const auto oldest = fs::file_time_type::clock::now() - age;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(m_folder)) {
        if (entry.path().filename().string().find(temporary_mark) == std::string::npos) continue;
        std::error_code gone;
        const fs::file_time_type written = entry.last_write_time(gone);
        if (!gone && written < oldest) fs::remove(entry.path(), gone);
    }
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
    if (!file) throw StoreError("cannot read " + path.string());
    return bytes;
}

}  // namespace sheer
