#include "server/process/rendering_program.h"

#include <filesystem>

#include "server/process/child_process.h"

namespace sheer {

std::string rendering_program() {
    std::error_code ignored;
    const std::filesystem::path own = std::filesystem::read_symlink(own_program, ignored);
    // What the system appends when the file was replaced or removed since this program started.
    const bool is_sheer = own.filename() == "sheer" || own.filename() == "sheer (deleted)";
    return is_sheer ? (own.parent_path() / "sheer-render").string() : own_program;
}

}  // namespace sheer
