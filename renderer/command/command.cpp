#include "renderer/command/command.h"

#include <fmt/format.h>
#include <spdlog/cfg/env.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>

#include "renderer/command/wrong_words.h"
#include "renderer/core/errors.h"
#include "renderer/core/names.h"
#include "renderer/spec/suites.h"
#include "version.h"

namespace sheer::cli {

namespace {

/// A word of a shell's command line.
std::string quoted(const std::string& text) {
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) || std::strchr("/._-+,:@%", c); };
    if (!text.empty() && std::ranges::all_of(text, is_plain)) return text;
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

}  // namespace

void log_to_stderr(const std::string& program) {
    const char* const no_color = std::getenv("NO_COLOR");
    const bool is_plain = no_color != nullptr && *no_color != '\0';
    spdlog::set_default_logger(
        spdlog::stderr_color_mt(program, is_plain ? spdlog::color_mode::never : spdlog::color_mode::automatic));
    spdlog::set_level(spdlog::level::warn);
    spdlog::cfg::load_env_levels();
}

int run_command_line(CLI::App& app, int argc, char** argv, const int& exit_code,
                     const std::function<void(const std::string& message)>& on_wrong) {
    app.set_version_flag("--version", fmt::format("sheer {} ({})", version, commit));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            app.exit(error);
            return exit_ok;
        }
        const std::string wrong = what_is_wrong(app, error);
        fmt::print(stderr, "{}\n", wrong);
        if (on_wrong) on_wrong(wrong);
        return exit_bad_spec;
    }
    return exit_code;
}

int exit_code_of(const report::Report& report) {
    if (std::ranges::count(report.checks, report::CheckOutcome::failed, &report::Check::came_out) > 0)
        return exit_check_failed;
    if (report.verdict != report::ReportVerdict::failed) return exit_ok;
    const auto is_failed = [](const auto& one) { return one.status == report::ResultStatus::failed; };
    const bool is_rendered =
        report.status == report::Status::done && std::ranges::none_of(report.runs, [&](const report::Run& run) {
            return is_failed(run.reference) || std::ranges::any_of(run.results, is_failed);
        });
    return is_rendered ? exit_undecided : exit_render_failed;
}

int guarded(const std::function<int()>& action) {
    try {
        return action();
    } catch (const WrongFile& error) {
        fmt::print(stderr, "{} is wrong:\n{}\n", error.path(), error.what());
        return exit_bad_spec;
    } catch (const SpecError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return exit_bad_spec;
    } catch (const UsageError& error) {
        fmt::print(stderr, "sheer: {}\n", error.what());
        return exit_bad_spec;
    } catch (const std::exception& error) {
        fmt::print(stderr, "sheer: {}\n", error.what());
        return exit_render_failed;
    }
}

void add_device_options(CLI::App& command, gl::ContextRequest& request) {
    command.add_option("--device", request.device, "Index of a device, or a part of its name (see sheer devices)");
    command.add_option("--without-workaround", request.disabled_workarounds,
                       "Name of a driver workaround to switch off");
}

void add_source_options(CLI::App& command, Source& source) {
    CLI::Option* spec =
        command.add_option("spec", source.spec, "The spec, a JSON file (see configs/specs); - is standard input");
    CLI::Option* suite =
        command.add_option("--suite", source.suite, "Repeat a published measurement instead: see sheer suites");
    command.add_option("--scale", source.scale, "Factor for width and height of a suite's picture")
        ->needs(suite)
        ->check(CLI::Range(0.01, 1.0));
    command.add_option("--max-seconds", source.max_seconds, "Time for the rounds at each point of a suite, in seconds")
        ->needs(suite);
    suite->excludes(spec);
}

namespace {

/// The reports to compare with are in the archive of a service.
Spec without_against(Spec spec) {
    if (spec.against.empty()) return spec;
    throw SpecError(std::vector<FieldError>{
        {"/against",
         "needs the archive of a service, so post the spec there; two reports in folders are compared by sheer diff"}});
}

/// A program renders on one device.
Spec on_one_device(Spec spec) {
    if (spec.devices.empty()) return spec;
    throw SpecError(std::vector<FieldError>{
        {"/device", "lists several devices, whose workers a service brings together: use sheer submit"}});
}

}  // namespace

Spec read_spec(const Source& source) {
    if (source.suite.empty() && source.spec.empty()) throw UsageError("give either a SPEC.json or a --suite");
    if (source.suite.empty()) return on_one_device(without_against(load_spec(source.spec)));
    const Suite* suite = find_suite(source.suite);
    if (!suite)
        throw UsageError(fmt::format("there is no suite \"{}\"; known are {}", source.suite, joined_ids(all_suites())));
    nlohmann::json spec = suite_spec(*suite, source.scale);
    if (source.max_seconds) spec["timing"]["max_seconds"] = *source.max_seconds;
    return parse_spec(spec);
}

Spec load_spec(const std::string& path) {
    std::ostringstream text;
    if (path == "-") {
        text << std::cin.rdbuf();
    } else {
        std::ifstream file(path, std::ios::binary);
        text << file.rdbuf();
        if (!file) throw SpecError(std::vector<FieldError>{{"", "cannot read the spec " + path}});
    }
    try {
        return parse_spec_text(text.str());
    } catch (const SpecError& wrong) {
        throw WrongFile(path == "-" ? "standard input" : path, wrong);
    }
}

std::string rerun_command(const std::string& command, const Source& source, const gl::ContextRequest& request) {
    std::string words = command + " ";
    words +=
        source.suite.empty() ? quoted(source.spec) : fmt::format("--suite {} --scale {}", source.suite, source.scale);
    if (source.max_seconds) words += fmt::format(" --max-seconds {}", *source.max_seconds);
    for (const std::string& name : request.disabled_workarounds) words += " --without-workaround " + name;
    return words;
}

ProgressLine::ProgressLine(bool is_terminal) : m_begin(std::chrono::steady_clock::now()), m_terminal(is_terminal) {}

ProgressLine::~ProgressLine() {
    if (m_shown) clear_progress_line();
}

bool ProgressLine::stderr_is_terminal() {
    return isatty(STDERR_FILENO) == 1;
}

void ProgressLine::show(double fraction, const std::string& stage) {
    if (m_terminal) {
        show_bar(fraction, stage);
    } else {
        show_line(fraction, stage);
    }
}

std::string time_left(double elapsed_s, double fraction) {
    // Earlier it would be a guess from how long the driver took to start.
    if (elapsed_s < 3 || fraction < 0.03 || fraction >= 1) return "";
    const double left_s = elapsed_s * (1 - fraction) / fraction;
    if (left_s < 60) return fmt::format("{:.0f} s left, ", std::ceil(left_s));
    if (left_s < 3600) return fmt::format("{:.0f} min left, ", std::ceil(left_s / 60));
    return fmt::format("{:.1f} h left, ", left_s / 3600);
}

void ProgressLine::show_bar(double fraction, const std::string& stage) {
    if (std::chrono::steady_clock::now() - m_begin < std::chrono::seconds(1)) return;
    constexpr int width = 30;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - m_begin;
    const int filled = static_cast<int>(fraction * width);
    fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {:3.0f} %  {}{}", "", filled, "", width - filled, 100 * fraction,
               time_left(elapsed.count(), fraction), stage);
    std::fflush(stderr);
    m_shown = true;
}

/// Stages look like "count 16: timing round 3 of 10"; the first word after the point is the kind of stage.
void ProgressLine::show_line(double fraction, const std::string& stage) {
    const std::size_t colon = stage.rfind(": ");
    const std::string point = colon == std::string::npos ? "" : stage.substr(0, colon);
    const std::string what = colon == std::string::npos ? stage : stage.substr(colon + 2);
    if (point != m_point) m_kinds.clear();
    m_point = point;
    if (!m_kinds.insert(what.substr(0, what.find(' '))).second) return;
    fmt::print(stderr, "[{:3.0f} %] {}\n", 100 * fraction, stage);
}

void clear_progress_line() {
    if (ProgressLine::stderr_is_terminal()) fmt::print(stderr, "\r\033[K");
}

}  // namespace sheer::cli
