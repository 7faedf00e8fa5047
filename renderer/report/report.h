#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/compare.h"

namespace sheer {

/// Takes the encoded pictures of a report.
class BlobSink {
  public:
    virtual ~BlobSink() = default;
    /// Keeps `bytes` and returns the URL that the report gives for them. `name` is unique in the report.
    virtual std::string put(const std::string& sha256, const std::string& bytes, const std::string& name,
                            const std::string& media_type) = 0;
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

/// Makes the report of contract.md, status "done", without id, from the runs of a comparison as they come.
class ReportMaker {
  public:
    /// `created_at` is UTC, RFC 3339. References outlive it.
    ReportMaker(const Spec& spec, const Device& device, BlobSink& sink, const std::string& created_at);
    void add(const Run& run);
    /// Once, after the last run.
    nlohmann::json finish();

  private:
    const Spec& m_spec;
    bool m_software;
    BlobSink& m_sink;
    nlohmann::json m_report;
};

/// What the command line needs to render on this device again, with a space before it; "" where it has no name.
std::string context_arguments(const Device& device);

/// A table for the terminal: a line a method.
std::string report_table(const nlohmann::json& report);
/// JUnit XML: a test case for each check and one for the rendering of each method.
std::string report_junit(const nlohmann::json& report);
/// One HTML file that needs nothing else; `read_picture` gives the bytes of a picture by its image object.
std::string report_html(const nlohmann::json& report,
                        const std::function<std::string(const nlohmann::json& image)>& read_picture);

/// Lower-case hexadecimal SHA-256.
std::string sha256_hex(const std::string& bytes);
/// Now in UTC, RFC 3339 with milliseconds.
std::string utc_now();

}  // namespace sheer
