#pragma once
#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

#include "renderer/gl/context.h"
#include "renderer/spec/spec.h"

// What `sheer` and `sheer-bench` share on the command line.
namespace sheer::cli {

// Exit codes of the programs.
inline constexpr int exit_ok = 0;
inline constexpr int exit_check_failed = 1;
inline constexpr int exit_bad_spec = 2;
inline constexpr int exit_render_failed = 3;
inline constexpr int exit_no_server = 4;

/// The log goes to stderr, so that stdout is the program's own; SPDLOG_LEVEL=info says more.
void log_to_stderr(const std::string& program);

/// Adds --version, reads the command line, which runs what it names, and returns `exit_code` as that left it, or
/// exit_bad_spec for a wrong command line, of which `on_wrong` is told.
int run_command_line(CLI::App& app, int argc, char** argv, const int& exit_code,
                     const std::function<void(const std::string& message)>& on_wrong = {});

/// What was asked for cannot be done as asked. Exit code 2.
class UsageError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Of a report: exit_check_failed where a check failed, else exit_render_failed where a method or the reference did.
int exit_code_of(const nlohmann::json& report);

/// Runs `action` and turns what it throws into a message on stderr and an exit code.
int guarded(const std::function<int()>& action);

/// Adds --device and --without-workaround to `command`.
void add_device_options(CLI::App& command, gl::ContextRequest& request);

/// What is to be compared: a spec's file, or a published measurement to repeat.
struct Source {
    std::string spec, suite;
    double scale = 1;
    std::optional<double> max_seconds;  ///< instead of the suite's timing.max_seconds
};

/// Adds SPEC.json, --suite, --scale and --max-seconds to `command`.
void add_source_options(CLI::App& command, Source& source);

/// Throws SpecError, also for a file that cannot be read, naming it; UsageError if there is no such suite.
Spec read_spec(const Source& source);
/// Throws SpecError, also for a file that cannot be read, naming it.
Spec load_spec(const std::string& path);

/// The command that repeats a comparison: `command` and its source, as words of a shell.
std::string rerun_command(const std::string& command, const Source& source, const gl::ContextRequest& request);

/// How far a comparison is, on stderr. On a terminal a bar, from the second second on; in a log a line for each stage
/// of each point, not for each round or method.
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
    std::set<std::string> m_kinds;  ///< of stages that this point has had
};

/// Removes a bar that another thread may have drawn.
void clear_progress_line();

/// Throws std::runtime_error naming the file.
void write_text(const std::filesystem::path& path, const std::string& text);
/// Throws std::runtime_error naming the file.
std::string read_text(const std::filesystem::path& path);

}  // namespace sheer::cli
