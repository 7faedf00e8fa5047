#include "server/worker/upload_check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "server/worker/run_child.h"

namespace sheer {

using nlohmann::json;

namespace {

[[noreturn]] void fail(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

/// A file that is only in memory.
class MemoryFile {
  public:
    explicit MemoryFile(const std::string& bytes) : m_descriptor(memfd_create("upload", MFD_CLOEXEC)) {
        if (m_descriptor < 0) fail("memfd_create");
        for (std::size_t done = 0; done < bytes.size();) {
            const ssize_t count = write(m_descriptor, bytes.data() + done, bytes.size() - done);
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) {
                close(m_descriptor);
                fail("write to memory");
            }
            done += static_cast<std::size_t>(count);
        }
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() { close(m_descriptor); }

    int descriptor() const { return m_descriptor; }

  private:
    int m_descriptor;
};

/// The child's one line: {"facts": {...}} or {"refusal": "..."}.
UploadVerdict read_verdict(const std::string& line) {
    const json message = json::parse(line, nullptr, false);
    if (message.is_object() && message.contains("facts") && message["facts"].is_object()) return {"", message["facts"]};
    if (message.is_object() && message.contains("refusal") && message["refusal"].is_string())
        return {message["refusal"], nullptr};
    return {"its check said nothing that can be understood", nullptr};
}

}  // namespace

UploadVerdict check_upload(const std::string& bytes, const std::string& media_type, const UploadCheckOptions& options) {
    const MemoryFile file(bytes);
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
    if (result.status.code == 0) return read_verdict(answer);
    spdlog::warn("the check of an upload ({}) died: exit code {}, signal {}", media_type, result.status.code,
                 result.status.signal);
    return {"the program that reads it dies of it", nullptr};
}

}  // namespace sheer
