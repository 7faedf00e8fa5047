#include "renderer/pictures/blob_sink.h"

#include "renderer/core/files.h"
#include "renderer/core/sha256.h"
#include "renderer/pictures/picture_file.h"
#include "renderer/report/report.h"

namespace sheer {

report::Picture BlobSink::take(const Image8& picture, const std::string& name) {
    return put_encoded(encode_png(picture), name, "image/png");
}

report::Picture BlobSink::take(const Image& picture, const std::string& name) {
    return put_encoded(encode_exr(picture), name, "image/x-exr");
}

report::Picture BlobSink::take(const PixelCounts& counts, const std::string& name) {
    return put_encoded(encode_exr(counts), name, "image/x-exr");
}

report::Picture BlobSink::put_encoded(const std::string& bytes, const std::string& name,
                                      const std::string& media_type) {
    const std::string sha256 = sha256_hex(bytes);
    return {sha256, put(sha256, bytes, name, media_type), media_type, {}, {}};
}

FolderSink::FolderSink(std::filesystem::path folder) : m_folder(std::move(folder)) {
    std::filesystem::create_directories(m_folder / "images");
}

std::string FolderSink::put(const std::string&, const std::string& bytes, const std::string& name, const std::string&) {
    write_file(m_folder / "images" / name, bytes);
    return "images/" + name;
}

ContentSink::ContentSink(std::filesystem::path folder, std::string url)
    : m_folder(std::move(folder)), m_url(std::move(url)) {
    std::filesystem::create_directories(m_folder);
}

std::string ContentSink::put(const std::string& sha256, const std::string& bytes, const std::string&,
                             const std::string&) {
    write_file(m_folder / sha256, bytes);
    return m_url + "/" + sha256;
}

}  // namespace sheer
