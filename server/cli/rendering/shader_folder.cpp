#include "server/cli/rendering/shader_folder.h"

#include <cstdlib>
#include <filesystem>

namespace sheer::cli {

void ShaderFolder::add_to(CLI::App& command) {
    command.add_option("--shaders", m_path, "Folder in which the driver keeps compiled shaders")->group("");
}

void ShaderFolder::open(OpenFiles& files) const {
    if (m_path.empty()) return;
    std::filesystem::create_directories(m_path);
    files.write.emplace_back(m_path);
    setenv("MESA_SHADER_CACHE_DIR", m_path.c_str(), 1);
    setenv("MESA_SHADER_CACHE_MAX_SIZE", "256M", 0);
}

}  // namespace sheer::cli
