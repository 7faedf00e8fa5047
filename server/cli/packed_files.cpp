#include "server/cli/packed_files.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <vector>

#include "renderer/core/errors.h"

namespace sheer::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 18;

using Reader = std::unique_ptr<archive, int (*)(archive*)>;
using Writer = Reader;
using Entry = std::unique_ptr<archive_entry, void (*)(archive_entry*)>;

[[noreturn]] void fail_on(const fs::path& file, archive* from) {
    const char* const text = archive_error_string(from);
    throw std::runtime_error(fmt::format("{}: {}", file.string(), text == nullptr ? "it cannot be read" : text));
}

Reader open_packed(const fs::path& file, int (*support)(archive*)) {
    if (!fs::is_regular_file(file)) throw std::runtime_error(fmt::format("there is no file {}", file.string()));
    Reader reader(archive_read_new(), archive_read_free);
    support(reader.get());
    if (archive_read_open_filename(reader.get(), file.c_str(), chunk_bytes) != ARCHIVE_OK) fail_on(file, reader.get());
    return reader;
}

/// The next entry that is a file; null at the end.
archive_entry* next_file(Reader& reader, const fs::path& file) {
    archive_entry* entry = nullptr;
    while (true) {
        const int result = archive_read_next_header(reader.get(), &entry);
        if (result == ARCHIVE_EOF) return nullptr;
        if (result != ARCHIVE_OK) fail_on(file, reader.get());
        if (archive_entry_filetype(entry) == AE_IFREG && archive_entry_pathname(entry) != nullptr) return entry;
    }
}

/// Calls `use` for each piece of the current entry.
void read_entry(Reader& reader, const fs::path& file, const std::function<void(const char*, std::size_t)>& use) {
    std::vector<char> bytes(chunk_bytes);
    while (true) {
        const la_ssize_t count = archive_read_data(reader.get(), bytes.data(), bytes.size());
        if (count < 0) fail_on(file, reader.get());
        if (count == 0) return;
        use(bytes.data(), static_cast<std::size_t>(count));
    }
}

void add_file(Writer& writer, const fs::path& tar, const fs::path& file, const std::string& name) {
    const Entry entry(archive_entry_new(), archive_entry_free);
    archive_entry_set_pathname(entry.get(), name.c_str());
    archive_entry_set_size(entry.get(), static_cast<la_int64_t>(fs::file_size(file)));
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0644);
    if (archive_write_header(writer.get(), entry.get()) != ARCHIVE_OK) fail_on(tar, writer.get());
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> bytes(chunk_bytes);
    while (stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || stream.gcount() > 0)
        if (archive_write_data(writer.get(), bytes.data(), static_cast<std::size_t>(stream.gcount())) < 0)
            fail_on(tar, writer.get());
    if (stream.bad()) throw std::runtime_error(fmt::format("cannot read {}", file.string()));
}

}  // namespace

void write_tar(const fs::path& folder, const fs::path& file) {
    const fs::path unfinished = file.string() + ".unfinished";
    {
        Writer writer(archive_write_new(), archive_write_free);
        archive_write_set_format_pax_restricted(writer.get());
        if (archive_write_open_filename(writer.get(), unfinished.c_str()) != ARCHIVE_OK)
            fail_on(unfinished, writer.get());
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.is_regular_file())
                add_file(writer, unfinished, entry.path(), entry.path().lexically_relative(folder).string());
        if (archive_write_close(writer.get()) != ARCHIVE_OK) fail_on(unfinished, writer.get());
    }
    fs::rename(unfinished, file);
}

void extract_tar(const fs::path& file, const fs::path& folder,
                 const std::function<bool(const std::string& name)>& wanted) {
    Reader reader = open_packed(file, archive_read_support_format_tar);
    while (archive_entry* const entry = next_file(reader, file)) {
        const std::string name = archive_entry_pathname(entry);
        if (!wanted(name)) throw std::runtime_error(fmt::format("{} has a file {}", file.string(), name));
        const fs::path place = folder / name;
        fs::create_directories(place.parent_path());
        std::ofstream stream(place, std::ios::binary);
        read_entry(reader, file, [&](const char* bytes, std::size_t count) {
            stream.write(bytes, static_cast<std::streamsize>(count));
        });
        if (!stream.flush()) throw std::runtime_error(fmt::format("cannot write {}", place.string()));
    }
}

std::optional<std::string> read_zipped(const fs::path& file, const std::function<bool(const std::string& name)>& wanted,
                                       std::uint64_t max_bytes) {
    Reader reader = open_packed(file, archive_read_support_format_zip_seekable);
    while (archive_entry* const entry = next_file(reader, file)) {
        const std::string name = archive_entry_pathname(entry);
        if (!wanted(name)) continue;
        std::string bytes;
        read_entry(reader, file, [&](const char* piece, std::size_t count) {
            if (bytes.size() + count > max_bytes)
                throw std::runtime_error(fmt::format("{} in {} is too long", name, file.string()));
            bytes.append(piece, count);
        });
        return bytes;
    }
    return std::nullopt;
}

}  // namespace sheer::cli
