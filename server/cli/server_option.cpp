#include "server/cli/server_option.h"

#include "renderer/command/command.h"
#include "renderer/core/files.h"

namespace sheer::cli {

void add_server_options(CLI::App& command, ServerOptions& options) {
    command.add_option("--server", options.url, "http://HOST:PORT of the service")
        ->envname("SHEER_SERVER")
        ->capture_default_str();
    command.add_option("--token-file", options.token_file, "File with the token for a service that asks for one");
}

HttpClient make_client(const ServerOptions& options) {
    if (options.token_file.empty()) return HttpClient(options.url);
    std::string token;
    try {
        token = read_file(options.token_file);
    } catch (const std::exception&) {
        throw UsageError("cannot read " + options.token_file);
    }
    while (!token.empty() && std::isspace(static_cast<unsigned char>(token.back()))) token.pop_back();
    return HttpClient(options.url, token);
}

}  // namespace sheer::cli
