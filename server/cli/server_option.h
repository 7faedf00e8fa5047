#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "server/cli/http_client.h"

namespace sheer::cli {

/// Which service a command talks to.
struct ServerOptions {
    std::string url = "http://127.0.0.1:8080";
    std::string token_file;
};

/// Adds --server, also from $SHEER_SERVER, and --token-file.
void add_server_options(CLI::App& command, ServerOptions& options);
/// Throws UsageError for a wrong URL or a file that cannot be read.
HttpClient make_client(const ServerOptions& options);

}  // namespace sheer::cli
