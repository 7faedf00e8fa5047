#include "server/cli/rendering/sandbox_option.h"

#include <cstdlib>

#include "server/storage/data_folder.h"

namespace sheer::cli {

namespace {

/// Folders where whoever started the service says that libraries and drivers are.
std::vector<std::string> folders_of_environment() {
    std::vector<std::string> folders;
    for (const char* name :
         {"LD_LIBRARY_PATH", "LIBGL_DRIVERS_PATH", "__EGL_VENDOR_LIBRARY_DIRS", "__EGL_VENDOR_LIBRARY_FILENAMES"})
        if (const char* value = std::getenv(name); value != nullptr && *value != '\0')
            for (const std::string& folder : CLI::detail::split(value, ':')) folders.push_back(folder);
    return folders;
}

}  // namespace

void SandboxOption::add_to(CLI::App& command) {
    command.add_flag("--sandbox", m_on, "Close everything that this command does not need")->group("");
    command.add_option("--readable", m_readable, "A file or folder that drivers read")->group("");
}

void SandboxOption::confine_files(OpenFiles open) const {
    if (!m_on) return;
    open.read.insert(open.read.end(), m_readable.begin(), m_readable.end());
    for (const std::string& folder : folders_of_environment()) open.read.emplace_back(folder);
    sheer::confine_files(open);
}

void SandboxOption::confine_calls() const {
    if (m_on) sheer::confine_calls();
}

OpenFiles stored_files(const std::string& data) {
    if (data.empty()) return {};
    const DataFolder folder{data};
    return {.read_by_name = {folder.blobs(), folder.assets()}};
}

}  // namespace sheer::cli
