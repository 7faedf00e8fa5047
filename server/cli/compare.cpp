#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstring>
#include <optional>

#include "renderer/assets/file_assets.h"
#include "renderer/compare.h"
#include "renderer/report/report.h"
#include "renderer/spec/names.h"
#include "renderer/spec/suites.h"
#include "server/cli/commands.h"
#include "server/cli/rendering.h"

namespace sheer::cli {

namespace {

struct CompareArguments {
    std::string spec, suite, out, junit;
    double scale = 1;
    gl::ContextRequest context;
};

/// A bar on a terminal's stderr, from the second second on.
class ProgressBar {
  public:
    ~ProgressBar() {
        if (m_shown) fmt::print(stderr, "\r\033[K");
    }
    void show(double fraction, const std::string& stage) {
        if (!m_terminal || Clock::now() - m_begin < std::chrono::seconds(1)) return;
        constexpr int width = 30;
        const int filled = static_cast<int>(fraction * width);
        fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {:3.0f} %  {}", "", filled, "", width - filled, 100 * fraction,
                   stage);
        std::fflush(stderr);
        m_shown = true;
    }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point m_begin = Clock::now();
    bool m_terminal = isatty(STDERR_FILENO) == 1;
    bool m_shown = false;
};

void write_report(const nlohmann::json& report, const std::filesystem::path& folder) {
    const auto read_picture = [&](const nlohmann::json& image) {
        return read_text(folder / image.at("url").get<std::string>());
    };
    write_text(folder / "report.html", report_html(report, read_picture));
    write_text(folder / "report.json", report.dump(2) + "\n");
}

/// Encodes no picture to a file: without --out only the table is wanted.
class NoSink : public BlobSink {
    std::string put(const std::string&, const std::string&, const std::string& name, const std::string&) override {
        return name;
    }
};

Spec read_spec(const CompareArguments& options) {
    if (options.suite.empty() && options.spec.empty()) throw UsageError("give a SPEC.json or a --suite");
    if (options.suite.empty()) return load_spec(options.spec);
    const Suite* suite = find_suite(options.suite);
    if (!suite)
        throw UsageError(
            fmt::format("there is no suite \"{}\"; known are {}", options.suite, joined_ids(all_suites())));
    return parse_spec(suite_spec(*suite, options.scale));
}

/// A word of a shell's command line.
std::string quoted(const std::string& text) {
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) || std::strchr("/._-+,:@%", c); };
    if (!text.empty() && std::ranges::all_of(text, is_plain)) return text;
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

std::string rerun(const CompareArguments& options, const Device& device) {
    std::string command = "sheer compare ";
    command += options.suite.empty() ? quoted(options.spec)
                                     : fmt::format("--suite {} --scale {}", options.suite, options.scale);
    command += context_arguments(device);
    for (const std::string& name : options.context.disabled_workarounds) command += " --without-workaround " + name;
    return command;
}

std::unique_ptr<BlobSink> make_sink(const std::optional<ReportFolder>& folder) {
    if (folder) return std::make_unique<FolderSink>(folder->partial());
    return std::make_unique<NoSink>();
}

int run_compare(const CompareArguments& options) {
    const std::string created_at = utc_now();
    const Spec spec = read_spec(options);
    std::optional<ReportFolder> folder;
    if (!options.out.empty()) folder.emplace(options.out);
    nlohmann::json report;
    {
        ProgressBar bar;
        const auto context = gl::create_context(options.context);
        FileAssets assets = assets_in_folder(std::filesystem::path(options.spec).parent_path());
        const std::unique_ptr<BlobSink> sink = make_sink(folder);
        const Device device = describe_device(*context);
        ReportMaker maker(spec, device, *sink, created_at);
        compare(
            spec, *context, assets, [&](double fraction, const std::string& stage) { bar.show(fraction, stage); },
            [&](const Run& run) { maker.add(run); });
        report = maker.finish();
        report["provenance"]["rerun"] = rerun(options, device);
        if (folder) {
            write_report(report, folder->partial());
            folder->commit();
        }
    }
    fmt::print("{}", report_table(report));
    if (!options.junit.empty()) write_text(options.junit, report_junit(report));
    if (folder) {
        fmt::print("\nReport: {}\n", (std::filesystem::absolute(options.out) / "report.html").string());
    } else {
        fmt::print("\nAdd --out DIR to keep the pictures and the report.\n");
    }
    return report["verdict"] == "failed" ? exit_check_failed : exit_ok;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("compare", "Render a comparison here and print its table");
    auto options = std::make_shared<CompareArguments>();
    CLI::Option* spec = command->add_option("spec", options->spec, "The spec, a JSON file (see configs/specs)");
    CLI::Option* suite =
        command->add_option("--suite", options->suite, "Repeat a published measurement instead: see sheer suites");
    command->add_option("--scale", options->scale, "Width and height of a suite's picture, times this")
        ->needs(suite)
        ->check(CLI::Range(0.01, 1.0));
    suite->excludes(spec);
    command->add_option("--out", options->out, "Folder for report.json, report.html and the pictures");
    command->add_option("--junit", options->junit, "File for the checks as JUnit XML");
    add_context_options(*command, options->context);
    command->callback([options, &exit_code] { exit_code = guarded([&] { return run_compare(*options); }); });
}

}  // namespace sheer::cli
