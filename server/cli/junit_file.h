#pragma once
#include <filesystem>
#include <string>

#include "renderer/results/report.h"

namespace sheer::cli {

/// The file of --junit. It never describes an earlier run: at the start it gets an <error> that says that the
/// comparison did not end, which remains if the process is killed.
class JunitFile {
  public:
    /// "" for none. Makes the folder of the file only if it is within `out`, the folder of the report, which may not
    /// exist yet. Throws UsageError, without changing anything, if the file cannot be written, or is the spec or a file
    /// of the report.
    JunitFile(const std::string& file, const std::filesystem::path& spec, const std::filesystem::path& out);

    /// See report_junit(). Throws std::runtime_error.
    void write(const report::Report& report) const;
    /// Writes one case, with an <error>.
    void write_error(const std::string& title, const std::string& detail) const;

  private:
    std::filesystem::path m_file;
};

}  // namespace sheer::cli
