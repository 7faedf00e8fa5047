#include "server/cli/outputs.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>

#include "renderer/core/files.h"
#include "renderer/params/json_text.h"
#include "renderer/report/report.h"
#include "server/cli/commands.h"

namespace sheer::cli {

void add_output_options(CLI::App& command, OutputOptions& options) {
    command.add_option("--junit", options.junit, "File for the checks as JUnit XML");
    command.add_option("--markdown", options.markdown, "File for a summary in markdown");
    command.add_flag("--github", options.github, "Print annotations, and add the summary to $GITHUB_STEP_SUMMARY");
    command.add_flag("--json", options.json, "Print the report as JSON instead of a table");
    command.add_flag("-q,--quiet", options.quiet, "Print neither table nor progress");
    command.add_flag("--gate", options.gate, "Fail if the spec has no checks");
}

Outputs::Outputs(const OutputOptions& options, std::string spec, const std::filesystem::path& out)
    : m_options(options), m_spec(std::move(spec)), m_junit(options.junit, m_spec, out) {
    if (!options.markdown.empty()) write_file(options.markdown, "### Sheer: the comparison did not end\n");
}

void Outputs::write(const report::Report& report, const MarkdownLinks& links) const {
    m_junit.write(report);
    write_summary(report_markdown(report, links), report_annotations(report, m_spec == "-" ? "" : m_spec));
}

void Outputs::print(const report::Report& report) const {
    if (m_options.json) {
        fmt::print("{}", json_page(to_document(report)));
    } else if (!m_options.quiet) {
        fmt::print("{}", report_table(report));
    }
    std::fflush(stdout);
}

void Outputs::write_error(const std::string& title, const std::string& detail) const {
    m_junit.write_error(title, detail);
    report::Report report;
    report.status = report::Status::failed;
    report.error = report::Error{title, detail};
    report.spec = {{"title", ""}};
    write_summary(report_markdown(report), report_annotations(report, m_spec == "-" ? "" : m_spec));
}

void Outputs::write_summary(const std::string& markdown, const std::string& annotations) const {
    if (!m_options.markdown.empty()) write_file(m_options.markdown, markdown);
    if (!m_options.github) return;
    fmt::print("{}", annotations);
    std::fflush(stdout);
    const char* const summary = std::getenv("GITHUB_STEP_SUMMARY");
    if (summary == nullptr || *summary == '\0') return;
    std::ofstream file(summary, std::ios::binary | std::ios::app);
    file << markdown << "\n";
    file.flush();
    if (!file) fmt::print(stderr, "sheer: cannot write $GITHUB_STEP_SUMMARY\n");
}

}  // namespace sheer::cli
