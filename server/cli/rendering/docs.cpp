// Writes the documents that are made from the source, or compares them with the existing files.
#include <fmt/format.h>

#include "renderer/core/files.h"
#include "renderer/documents/documents.h"
#include "server/cli/rendering/commands.h"
#include "server/cli/rendering/rendering.h"
#include "server/cli/service_config.h"
#include "server/http/components.h"

namespace sheer::cli {

namespace {

namespace fs = std::filesystem;

struct DocsArguments {
    std::string folder;
    bool check = false;
};

bool is_up_to_date(const fs::path& path, const std::string& text) {
    return fs::is_regular_file(path) && read_file(path) == text;
}

int run_docs(const DocsArguments& options) {
    const fs::path folder = options.folder;
    const auto read = [&folder](const std::string& path) { return read_file(folder / path); };
    int exit_code = exit_ok;
    for (const Document& document : make_documents({service_config_fields(), http::component_schemas()}, read)) {
        const fs::path path = folder / document.path;
        if (is_up_to_date(path, document.text)) continue;
        if (options.check) {
            fmt::print(stderr, "{} is out of date; run ./dev docs\n", document.path);
            exit_code = exit_check_failed;
        } else {
            fs::create_directories(path.parent_path());
            write_file(path, document.text);
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
