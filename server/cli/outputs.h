#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "renderer/report/markdown.h"
#include "server/cli/junit_file.h"

namespace sheer::cli {

/// What a command that makes a report writes besides it.
struct OutputOptions {
    std::string junit, markdown;
    bool github = false, json = false, quiet = false, gate = false;
};

/// Adds --junit, --markdown, --github, --json, -q and --gate.
void add_output_options(CLI::App& command, OutputOptions& options);

/// Writes them. None of the files ever describes an earlier run: at the start they say that this one did not end.
class Outputs {
  public:
    /// `spec` is the file of the spec, for annotations. Throws UsageError if a file cannot be written; see JunitFile.
    Outputs(const OutputOptions& options, std::string spec, const std::filesystem::path& out);

    /// All files, and GitHub's annotations and summary.
    void write(const report::Report& report, const MarkdownLinks& links = {}) const;
    /// The table or the JSON, on standard output.
    void print(const report::Report& report) const;
    /// The same for a run that gave no report.
    void write_error(const std::string& title, const std::string& detail) const;

  private:
    void write_summary(const std::string& markdown, const std::string& annotations) const;

    const OutputOptions& m_options;
    std::string m_spec;
    JunitFile m_junit;
};

}  // namespace sheer::cli
