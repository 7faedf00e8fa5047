#pragma once
#include <span>
#include <string_view>

namespace sheer {

/// A file that is compiled into the program.
struct EmbeddedFile {
    std::string_view path;   ///< below the folder it came from, with forward slashes
    std::string_view bytes;  ///< valid for the life of the program
};

}  // namespace sheer
