#pragma once
#include <filesystem>

#include "renderer/report/picture_sink.h"

namespace sheer {

/// Encodes the pictures of a report: levels as PNG, floats and counts as OpenEXR.
class BlobSink : public PictureSink {
  public:
    report::Picture take(const Image8& picture, const std::string& name) override;
    report::Picture take(const Image& picture, const std::string& name) override;
    report::Picture take(const PixelCounts& counts, const std::string& name) override;

    /// Keeps `bytes` and returns their URL for the report. `name` is unique in the report.
    virtual std::string put(const std::string& sha256, const std::string& bytes, const std::string& name,
                            const std::string& media_type) = 0;

  private:
    report::Picture put_encoded(const std::string& bytes, const std::string& name, const std::string& media_type);
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

/// Pictures as files named by their SHA-256, to be served at `url`/<sha256>.
class ContentSink : public BlobSink {
  public:
    ContentSink(std::filesystem::path folder, std::string url);
    std::string put(const std::string& sha256, const std::string& bytes, const std::string& name,
                    const std::string& media_type) override;

  private:
    std::filesystem::path m_folder;
    std::string m_url;
};

}  // namespace sheer
