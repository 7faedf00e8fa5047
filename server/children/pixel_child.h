#pragma once
#include <filesystem>
#include <string>

#include "server/process/ask_child.h"

namespace sheer {

struct PixelPlace {
    int x = 0, y = 0;  ///< from the top left
    int run = 0;       ///< which run of the report
};

/// The explanation of a pixel, or why there is none; one of the texts is empty.
struct PixelAnswer {
    std::string json;     ///< what `sheer pixel --json` prints
    std::string refusal;  ///< for the client: the report can no longer be rendered here
    bool too_slow = false;
};

/// Of the service.
struct PixelFolders {
    std::filesystem::path data;     ///< with the archive
    std::filesystem::path shaders;  ///< where the driver keeps compiled shaders; not used if has_foreign_input()
};

/// Runs `sheer pixel` on a done report of the archive, in a child that may die; the report is passed as a
/// file that is only in memory. Throws std::runtime_error if the child dies or has an internal error, std::system_error
/// if it cannot be started.
PixelAnswer run_pixel_child(const std::string& report, const PixelPlace& place, const PixelFolders& folders,
                            const ChildLimits& limits);

}  // namespace sheer
