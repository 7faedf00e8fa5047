// Renders on a service: posts a spec, waits, and writes the same outputs as `sheer compare`.
#include <fmt/format.h>
#include <openssl/rand.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <thread>

#include "renderer/core/files.h"
#include "renderer/core/sha256.h"
#include "renderer/files/report_document.h"
#include "renderer/params/json_text.h"
#include "renderer/report/report.h"
#include "server/cli/commands.h"
#include "server/cli/http_client.h"
#include "server/cli/output_folder.h"
#include "server/cli/outputs.h"
#include "server/cli/server_option.h"
#include "server/http/paths.h"

namespace sheer::cli {

namespace fs = std::filesystem;
using nlohmann::json;
using namespace std::chrono_literals;

namespace {

struct SubmitArguments {
    std::string spec, out, key;
    ServerOptions server;
    int timeout_s = 900;
    OutputOptions outputs;
};

constexpr auto longest_pause = 30s;
constexpr auto longest_poll = 2000ms;

std::string spec_text(const std::string& file) {
    if (file == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
    try {
        return read_file(file);
    } catch (const std::exception&) {
        throw SpecError(std::vector<FieldError>{{"", "cannot read the spec " + file}});
    }
}

std::string environment(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

/// A step that is run again by the same attempt of a CI job gets the report that it asked for before.
std::string default_key(const std::string& text) {
    std::string run = environment("GITHUB_RUN_ID") + environment("CI_JOB_ID");
    if (run.empty()) {
        std::array<unsigned char, 16> random{};
        RAND_bytes(random.data(), random.size());
        for (const unsigned char byte : random) run += fmt::format("{:02x}", byte);
    }
    return fmt::format("{}-{}-{}", run, environment("GITHUB_RUN_ATTEMPT") + environment("GITHUB_JOB"),
                       sha256_hex(text).substr(0, 16));
}

std::string detail_of(const HttpAnswer& answer) {
    const json problem = json::parse(answer.body, nullptr, false);
    const std::string detail = problem.is_object() ? problem.value("detail", "") : "";
    return detail.empty() ? fmt::format("status {}", answer.status) : detail;
}

/// The errors of a spec that the service refuses.
SpecError refusal(const HttpAnswer& answer) {
    std::vector<FieldError> errors;
    const json problem = json::parse(answer.body, nullptr, false);
    if (problem.is_object())
        for (const json& error : problem.value("errors", json::array()))
            errors.push_back({error.value("pointer", ""), error.value("detail", "")});
    if (errors.empty()) errors.push_back({"", detail_of(answer)});
    return SpecError(std::move(errors));
}

class Submission {
  public:
    explicit Submission(const SubmitArguments& options)
        : m_options(options),
          m_client(make_client(options.server)),
          m_outputs(options.outputs, options.spec, options.out),
          m_deadline(std::chrono::steady_clock::now() + std::chrono::seconds(options.timeout_s)) {}

    int run() {
        try {
            return submit();
        } catch (const SpecError& error) {
            m_outputs.write_error("The spec is wrong", error.what());
            throw;
        } catch (const Unreachable& error) {
            m_outputs.write_error("The server cannot be reached", error.what());
            fmt::print(stderr, "sheer: {}\n", error.what());
            return exit_unreachable;
        } catch (const std::exception& error) {
            m_outputs.write_error("The comparison failed", error.what());
            throw;
        }
    }

  private:
    using SteadyTime = std::chrono::steady_clock::time_point;

    int submit() {
        m_id = post(spec_text(m_options.spec));
        if (!m_options.outputs.quiet) fmt::print(stderr, "Report {}: {}{}\n", m_id, m_client.url(), page_path());
        report::Report report = wait();
        if (m_options.outputs.gate && report.status == report::Status::done) require_checks(report);
        if (report.status == report::Status::done && !m_options.out.empty()) keep(report);
        const std::string url = m_client.url();
        m_outputs.write(report, {.report = url + page_path(), .picture_prefix = url, .pictures = true});
        if (report.status == report::Status::done) {
            m_outputs.print(report);
            return exit_code_of(report);
        }
        fmt::print(stderr, "sheer: the report is {}{}\n", word_of(report.status),
                   report.error ? ": " + report.error->title + ": " + report.error->detail : "");
        return exit_render_failed;
    }

    std::string page_path() const { return fmt::format("/#/reports/{}", m_id); }
    std::string path() const { return fmt::format("{}/{}", http::reports_path, m_id); }

    /// Returns the id of the report.
    std::string post(const std::string& text) {
        const std::string key = m_options.key.empty() ? default_key(text) : m_options.key;
        const HttpAnswer answer = patiently("POST", http::reports_path, text,
                                            {{"Content-Type", "application/json"}, {"Idempotency-Key", key}});
        if (const std::string since = answer.header("sheer-reused"); !since.empty() && !m_options.outputs.quiet)
            fmt::print(stderr, "Answered from the archive: rendered at {}\n", since);
        if (answer.status == 400 || answer.status == 413 || answer.status == 415 || answer.status == 422)
            throw refusal(answer);
        const json report = json::parse(answer.body, nullptr, false);
        if (answer.status / 100 != 2 || !report.is_object() || !report.contains("id"))
            throw Unreachable(fmt::format("{}: {}", m_client.url(), detail_of(answer)));
        return report["id"];
    }

    report::Report wait() {
        ProgressLine progress;
        for (auto pause = 100ms;; pause = std::min(pause * 2, longest_poll)) {
            const HttpAnswer answer = patiently("GET", path());
            if (answer.status != 200)
                throw std::runtime_error(fmt::format("the report {}: {}", m_id, detail_of(answer)));
            const json document = json::parse(answer.body);
            const std::string status = document.at("status");
            if (status == "done") return read_report(document);
            if (status != "queued" && status != "running") return from_document<report::Report>(document);
            if (!m_options.outputs.quiet) progress.show(document.at("progress"), document.value("stage", status));
            if (std::chrono::steady_clock::now() + pause > m_deadline) give_up(status);
            std::this_thread::sleep_for(pause);
        }
    }

    [[noreturn]] void give_up(const std::string& status) {
        m_client.request("DELETE", path());
        throw Unreachable(
            fmt::format("the report {} was still {} after {} s, and is cancelled", m_id, status, m_options.timeout_s));
    }

    /// Tries again while the server is away, busy or in trouble, with growing pauses, until the time is over.
    HttpAnswer patiently(const std::string& method, const std::string& target, const std::string& body = "",
                         const HttpFields& fields = {}) {
        for (std::chrono::seconds pause = 1s;; pause = std::min<std::chrono::seconds>(pause * 2, longest_pause)) {
            std::chrono::seconds wait = pause;
            std::string why;
            try {
                HttpAnswer answer = m_client.request(method, target, body, fields);
                if (answer.status != 429 && answer.status < 500) return answer;
                why = fmt::format("{}: {}", m_client.url(), detail_of(answer));
                wait = retry_after(answer).value_or(pause);
            } catch (const Unreachable& error) {
                why = error.what();
            }
            if (std::chrono::steady_clock::now() + wait > m_deadline) throw Unreachable(why);
            if (!m_options.outputs.quiet) fmt::print(stderr, "sheer: {}; trying again in {} s\n", why, wait.count());
            std::this_thread::sleep_for(wait);
        }
    }

    static std::optional<std::chrono::seconds> retry_after(const HttpAnswer& answer) {
        const std::string text = answer.header("retry-after");
        int seconds = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
        if (text.empty() || error != std::errc() || end != text.data() + text.size() || seconds < 0)
            return std::nullopt;
        return std::chrono::seconds(std::clamp(seconds, 1, 60));
    }

    /// Writes the report with its pictures into --out.
    void keep(report::Report& report) {
        std::map<std::string, std::string> files;  ///< by SHA-256
        for (const report::Picture& picture : report.pictures())
            files[picture.sha256] = picture.sha256 + (picture.media_type == "image/png" ? ".png" : ".exr");
        OutputNames names{"report.json", {"report.html"}, {}};
        for (const auto& [sha256, name] : files) names.picture_stems.push_back(sha256);
        OutputFolder folder(m_options.out, names);
        fs::create_directories(folder.partial() / "images");
        for (const auto& [sha256, name] : files) {
            const std::string bytes = fetched(fmt::format("{}/{}", http::blobs_path, sha256));
            if (sha256_hex(bytes) != sha256) throw std::runtime_error("a picture arrived damaged: " + sha256);
            write_file(folder.partial() / "images" / name, bytes);
        }
        write_file(folder.partial() / "report.html", fetched(path() + "/report.html"));
        report::Report local = report;
        const auto relink = [&](report::Pictures& pictures) {
            for (auto& [key, picture] : pictures) picture.url = "images/" + files.at(picture.sha256);
        };
        for (report::Run& run : local.runs) {
            relink(run.reference.images);
            for (report::Result& result : run.results) relink(result.images);
        }
        write_file(folder.partial() / "report.json", json_page(to_document(local)));
        folder.commit();
    }

    std::string fetched(const std::string& target) {
        HttpAnswer answer = patiently("GET", target);
        if (answer.status != 200) throw std::runtime_error(fmt::format("{}: {}", target, detail_of(answer)));
        return std::move(answer.body);
    }

    const SubmitArguments& m_options;
    const HttpClient m_client;
    const Outputs m_outputs;
    const SteadyTime m_deadline;
    std::string m_id;
};

}  // namespace

void add_submit(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("submit", "Render a comparison on a service, wait, and print its table");
    auto options = std::make_shared<SubmitArguments>();
    command->add_option("spec", options->spec, "The spec, a JSON file; - is standard input")->required();
    add_server_options(*command, options->server);
    command->add_option("--out", options->out, "Folder for report.json, report.html and the pictures");
    command->add_option("--timeout", options->timeout_s, "Seconds until it is given up, and cancelled")
        ->check(CLI::Range(1, 86'400))
        ->capture_default_str();
    command->add_option(
        "--key", options->key,
        "Idempotency-Key: the same key with the same spec gives the same report; by default that of the CI "
        "job, or a random one");
    add_output_options(*command, options->outputs);
    command->footer("Example: sheer submit spec.json --server http://renderer:8080 --gate --junit junit.xml --github");
    command->callback([options, &exit_code] { exit_code = guarded([&] { return Submission(*options).run(); }); });
}

}  // namespace sheer::cli
