#include "server/children/upload_check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "renderer/core/exit_codes.h"
#include "server/process/memory_file.h"
#include "server/process/run_child.h"

namespace sheer {

using nlohmann::json;

namespace {

/// The child's one line: {"facts": {...}} or {"refusal": "..."}.
UploadVerdict read_verdict(const std::string& line) {
    const json message = json::parse(line, nullptr, false);
    if (message.is_object() && message.contains("facts") && message["facts"].is_object()) return {"", message["facts"]};
    if (message.is_object() && message.contains("refusal") && message["refusal"].is_string())
        return {message["refusal"], nullptr};
    return {"its check gave no valid answer", nullptr};
}

}  // namespace

UploadVerdict check_upload(const std::string& bytes, const std::string& media_type, const UploadCheckOptions& options) {
    const MemoryFile file("upload", bytes);
    std::string answer;
    ChildRun run;
    run.options.program = options.program;
    run.options.arguments = {"check-asset", "/dev/stdin", "--type", media_type};
    run.options.memory_limit_bytes = options.memory_limit_bytes;
    run.options.input = file.descriptor();
    run.time_limit = options.time_limit;
    run.on_line = [&answer](const std::string& line) { answer = line; };
    const ChildResult result = run_child(run);
    if (result.timed_out)
        return {
            fmt::format("reading it takes longer than {} s", std::chrono::duration<double>(options.time_limit).count()),
            nullptr};
    if (result.status.code == exit_ok) return read_verdict(answer);
    spdlog::warn("the check of an upload ({}) died: exit code {}, signal {}", media_type, result.status.code,
                 result.status.signal);
    return {"the program that reads it crashes on it", nullptr};
}

}  // namespace sheer
