#pragma once
#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

#include "renderer/core/exit_codes.h"
#include "renderer/gl/context.h"
#include "renderer/results/report.h"
#include "renderer/spec/spec.h"

// What `sheer` and `sheer-bench` share on the command line.
namespace sheer::cli {

/// Sends the log to stderr, so that stdout has only the program's output; SPDLOG_LEVEL=info logs more.
void log_to_stderr(const std::string& program);

/// Adds --version, parses the command line, which runs the command, and returns `exit_code` as the command left it, or
/// exit_bad_spec for a wrong command line, which is reported to `on_wrong`.
int run_command_line(CLI::App& app, int argc, char** argv, const int& exit_code,
                     const std::function<void(const std::string& message)>& on_wrong = {});

/// The request cannot be carried out as given. Exit code 2.
class UsageError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A SpecError of a file, or of standard input.
class WrongFile : public SpecError {
  public:
    WrongFile(std::string path, const SpecError& wrong) : SpecError(wrong), m_path(std::move(path)) {}
    const std::string& path() const { return m_path; }

  private:
    std::string m_path;
};

/// For a report: exit_check_failed if a check failed, otherwise exit_render_failed if a method or the reference failed.
int exit_code_of(const report::Report& report);

/// Runs `action` and turns what it throws into a message on stderr and an exit code.
int guarded(const std::function<int()>& action);

/// Adds --device and --without-workaround to `command`.
void add_device_options(CLI::App& command, gl::ContextRequest& request);

/// What to compare: the file of a spec, or a published measurement to repeat.
struct Source {
    std::string spec, suite;
    double scale = 1;
    std::optional<double> max_seconds;  ///< instead of the suite's timing.max_seconds
};

/// Adds SPEC.json, --suite, --scale and --max-seconds to `command`.
void add_source_options(CLI::App& command, Source& source);

/// Throws SpecError, also for an unreadable file, naming it; UsageError if there is no such suite.
Spec read_spec(const Source& source);
/// Throws SpecError, also for an unreadable file, naming it.
Spec load_spec(const std::string& path);

/// The shell command that repeats a comparison: `command` and its source.
std::string rerun_command(const std::string& command, const Source& source, const gl::ContextRequest& request);

/// How long the rest will take if it goes on like this, with a comma after it; "" while that cannot be said.
std::string time_left(double elapsed_s, double fraction);

/// Shows the progress of a comparison on stderr: on a terminal as a bar, after the first second, with the time left; in
/// a log as a line for each stage of each point, not for each round or method.
class ProgressLine {
  public:
    explicit ProgressLine(bool is_terminal = stderr_is_terminal());
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    void show(double fraction, const std::string& stage);

    static bool stderr_is_terminal();

  private:
    void show_bar(double fraction, const std::string& stage);
    void show_line(double fraction, const std::string& stage);

    std::chrono::steady_clock::time_point m_begin;
    bool m_terminal;
    bool m_shown = false;
    std::string m_point;
    std::set<std::string> m_kinds;  ///< of the stages so far at this point
};

/// Removes a bar that another thread may have drawn.
void clear_progress_line();

}  // namespace sheer::cli
