#include "renderer/files/blob_sink.h"

#include <cerrno>
#include <fstream>

#include "renderer/errors.h"
#include "renderer/files/picture_file.h"
#include "renderer/report/report.h"

namespace sheer {

namespace {

void write_file(const std::filesystem::path& path, const std::string& bytes) {
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    file.close();
    if (!file) throw WriteError(errno == 0 ? EIO : errno, path.string());
}

}  // namespace

nlohmann::json BlobSink::take(const Image8& picture, const std::string& name) {
    return put_encoded(encode_png(picture), name, "image/png");
}

nlohmann::json BlobSink::take(const Image& picture, const std::string& name) {
    return put_encoded(encode_exr(picture), name, "image/x-exr");
}

nlohmann::json BlobSink::take(const PixelCounts& counts, const std::string& name) {
    return put_encoded(encode_exr(counts), name, "image/x-exr");
}

nlohmann::json BlobSink::put_encoded(const std::string& bytes, const std::string& name, const std::string& media_type) {
    const std::string sha256 = sha256_hex(bytes);
    return {{"sha256", sha256}, {"url", put(sha256, bytes, name, media_type)}, {"media_type", media_type}};
}

FolderSink::FolderSink(std::filesystem::path folder) : m_folder(std::move(folder)) {
    std::filesystem::create_directories(m_folder / "images");
}

std::string FolderSink::put(const std::string&, const std::string& bytes, const std::string& name, const std::string&) {
    write_file(m_folder / "images" / name, bytes);
    return "images/" + name;
}

ContentSink::ContentSink(std::filesystem::path folder) : m_folder(std::move(folder)) {
    std::filesystem::create_directories(m_folder);
}

std::string ContentSink::put(const std::string& sha256, const std::string& bytes, const std::string&,
                             const std::string&) {
    write_file(m_folder / sha256, bytes);
    return "/api/v1/blobs/" + sha256;
}

}  // namespace sheer
