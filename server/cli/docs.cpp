// The documents that are made from the source: written, or held against what is there.
#include <fmt/format.h>

#include "renderer/spec/documents.h"
#include "server/cli/commands.h"
#include "server/cli/rendering.h"
#include "server/cli/service_config.h"

namespace sheer::cli {

namespace {

namespace fs = std::filesystem;

struct DocsArguments {
    std::string folder;
    bool check = false;
};

bool is_up_to_date(const fs::path& path, const std::string& text) {
    return fs::is_regular_file(path) && read_text(path) == text;
}

int run_docs(const DocsArguments& options) {
    const fs::path folder = options.folder;
    const auto litmus = nlohmann::json::parse(read_text(folder / "tests/render/litmus.json"));
    int exit_code = exit_ok;
    for (const Document& document : make_documents(service_config_fields(), litmus)) {
        const fs::path path = folder / document.path;
        if (is_up_to_date(path, document.text)) continue;
        if (options.check) {
            fmt::print(stderr, "{} is out of date; ./dev docs makes it anew\n", document.path);
            exit_code = exit_check_failed;
        } else {
            fs::create_directories(path.parent_path());
            write_text(path, document.text);
            fmt::print("{}\n", document.path);
        }
    }
    return exit_code;
}

}  // namespace

void add_docs(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("docs", "Write the documents that are made from the source")->group("");
    auto options = std::make_shared<DocsArguments>();
    command->add_option("folder", options->folder, "The repository")->required()->check(CLI::ExistingDirectory);
    command->add_flag("--check", options->check, "Write nothing; exit with 1 if one is out of date");
    command->callback([options, &exit_code] { exit_code = guarded([&] { return run_docs(*options); }); });
}

}  // namespace sheer::cli
