// Children that compare reports of an archive: they decode pictures, so they may crash without harm. Each reads a
// question from its standard input and prints its answer as one JSON object.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "renderer/core/files.h"
#include "renderer/diff/against.h"
#include "renderer/diff/join.h"
#include "renderer/files/data_uri.h"
#include "renderer/files/report_document.h"
#include "renderer/params/json_text.h"
#include "renderer/pictures/blob_sink.h"
#include "server/cli/rendering/commands.h"
#include "server/cli/rendering/rendering.h"
#include "server/cli/rendering/sandbox_option.h"
#include "server/jobs/limits.h"

namespace sheer::cli {

namespace {

using nlohmann::json;

// Limit on the pixels that a question may decode: some ten seconds of work.
constexpr std::uint64_t max_pixels = 64'000'000;

/// The pictures of a diff are part of its text: in the archive, nothing would ever delete them.
class InlineSink : public BlobSink {
    std::string put(const std::string&, const std::string& bytes, const std::string&,
                    const std::string& media_type) override {
        return data_uri(media_type, bytes);
    }
};

json compare_stored(const json& question, const std::string& data) {
    const report::Report a = read_report(question.at("a")), b = read_report(question.at("b"));
    const report::PictureReader read_picture = stored_pictures(data);
    InlineSink sink;
    DiffOptions options{.max_pixels = max_pixels, .allow = question.at("allow")};
    if (!question.at("run").is_null()) {
        options.run = question["run"].get<std::size_t>();
        options.pictures = &sink;
    }
    const auto refusal = [](const SpecError& wrong, const std::vector<std::string>& allowable) {
        json errors = json::array();
        for (const FieldError& error : wrong.errors())
            errors.push_back({{"pointer", error.pointer}, {"detail", error.detail}});
        return json{{"detail", wrong.what()}, {"errors", errors}, {"allowable", allowable}};
    };
    try {
        return {{"diff", to_document(diff_reports({a, read_picture}, {b, read_picture}, options))}};
    } catch (const DiffConflict& conflict) {
        return refusal(conflict, conflict.allowable());
    } catch (const SpecError& wrong) {
        return refusal(wrong, {});
    }
}

/// The question's report, whose pictures are in the folder `own`, compared with the first accepted one that fits.
json compare_against_stored(const json& question, const std::string& data, const std::filesystem::path& own) {
    auto report = from_document<report::Report>(question.at("report"));
    std::vector<Accepted> accepted;
    for (const json& one : question.at("accepted"))
        accepted.push_back({.report = read_report(one.at("report")),
                            .baseline = one.at("baseline"),
                            .accepted_at = one.at("accepted_at"),
                            .by = one.at("by"),
                            .age = one.at("age")});
    const auto own_picture = [&](const report::Picture& picture) {
        return read_file(own / picture.sha256, max_picture_bytes);
    };
    compare_against(report, accepted, own_picture, stored_pictures(data));
    return {{"report", to_document(report)}};
}

/// The parts of a report of several devices, joined.
json join_stored(const json& question, const std::string& data) {
    std::vector<RenderedPart> parts;
    for (const json& one : question.at("parts")) {
        RenderedPart& part = parts.emplace_back();
        part.label = one.at("label");
        part.reason = one.at("reason");
        if (!one.at("report").is_null()) part.report = read_report(one["report"]);
    }
    return {{"report", to_document(join_parts(question.at("spec"), parts, stored_pictures(data)))}};
}

void answer_question(const std::string& command, int& exit_code, const SandboxOption& sandbox, const OpenFiles& files,
                     const std::function<json(const json& question)>& answer) {
    try {
        sandbox.confine_files(files);
        sandbox.confine_calls();
        fmt::print("{}\n", json_line(answer(json::parse(read_file("/dev/stdin")))));
        exit_code = exit_ok;
    } catch (const std::exception& error) {
        fmt::print(stderr, "sheer {}: {}\n", command, error.what());
        exit_code = exit_render_failed;
    }
}

}  // namespace

void add_diff_stored(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("diff-stored", "Compare two reports for the service")->group("");
    auto data = std::make_shared<std::string>();
    auto sandbox = std::make_shared<SandboxOption>();
    command->add_option("--data", *data, "The service's folder with the pictures")->required();
    sandbox->add_to(*command);
    command->callback([data, sandbox, &exit_code] {
        answer_question("diff-stored", exit_code, *sandbox, stored_files(*data),
                        [&](const json& question) { return compare_stored(question, *data); });
    });
}

void add_join_stored(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("join-stored", "Join the parts of a report for a worker")->group("");
    auto data = std::make_shared<std::string>();
    auto sandbox = std::make_shared<SandboxOption>();
    command->add_option("--data", *data, "The service's folder with the pictures")->required();
    sandbox->add_to(*command);
    command->callback([data, sandbox, &exit_code] {
        answer_question("join-stored", exit_code, *sandbox, stored_files(*data),
                        [&](const json& question) { return join_stored(question, *data); });
    });
}

void add_against_stored(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("against-stored", "Compare a report with accepted ones for a worker")->group("");
    auto data = std::make_shared<std::string>(), own = std::make_shared<std::string>();
    auto sandbox = std::make_shared<SandboxOption>();
    command->add_option("--data", *data, "The service's folder with the pictures of the accepted ones")->required();
    command->add_option("--own", *own, "The folder with the report's pictures")->required();
    sandbox->add_to(*command);
    command->callback([data, own, sandbox, &exit_code] {
        OpenFiles files = stored_files(*data);
        files.read.emplace_back(*own);
        answer_question("against-stored", exit_code, *sandbox, files,
                        [&](const json& question) { return compare_against_stored(question, *data, *own); });
    });
}

}  // namespace sheer::cli
