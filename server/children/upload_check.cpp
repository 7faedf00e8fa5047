#include "server/children/upload_check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "renderer/core/exit_codes.h"

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

UploadVerdict check_upload(const std::string& bytes, const std::string& media_type, const ChildLimits& limits) {
    const ChildReply reply = ask_child({"check-asset", "/dev/stdin", "--type", media_type}, bytes, limits);
    if (reply.timed_out)
        return {fmt::format("reading it takes longer than {} s", std::chrono::duration<double>(limits.time).count()),
                nullptr};
    if (reply.status.code == exit_ok) return read_verdict(reply.line);
    spdlog::warn("an upload ({}) was not read: {}", media_type, ending_text("check-asset", reply.status));
    return {"the program that reads it crashes on it", nullptr};
}

}  // namespace sheer
