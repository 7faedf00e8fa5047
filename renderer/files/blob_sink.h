#pragma once
#include <filesystem>

#include "renderer/report/picture_sink.h"

namespace sheer {

/// Encodes the pictures of a report: levels as PNG, floats and counts as OpenEXR.
class BlobSink : public PictureSink {
  public:
    nlohmann::json take(const Image8& picture, const std::string& name) override;
    nlohmann::json take(const Image& picture, const std::string& name) override;
    nlohmann::json take(const PixelCounts& counts, const std::string& name) override;

    /// Keeps `bytes` and returns the URL that the report gives for them. `name` is unique in the report.
    virtual std::string put(const std::string& sha256, const std::string& bytes, const std::string& name,
                            const std::string& media_type) = 0;

  private:
    nlohmann::json put_encoded(const std::string& bytes, const std::string& name, const std::string& media_type);
};

/// Pictures as files with readable names below a folder: `sheer compare --out`.
class FolderSink : public BlobSink {
  public:
    explicit FolderSink(std::filesystem::path folder);
    std::string put(const std::string& sha256, const std::string& bytes, const std::string& name,
                    const std::string& media_type) override;

  private:
    std::filesystem::path m_folder;
};

/// Pictures as files named by their SHA-256, with the URL that the service serves them at.
class ContentSink : public BlobSink {
  public:
    explicit ContentSink(std::filesystem::path folder);
    std::string put(const std::string& sha256, const std::string& bytes, const std::string& name,
                    const std::string& media_type) override;

  private:
    std::filesystem::path m_folder;
};

}  // namespace sheer
