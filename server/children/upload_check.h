#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "server/process/ask_child.h"

namespace sheer {

/// What is known about an uploaded file after all of it was read.
struct UploadVerdict {
    std::string refusal;   ///< why it is refused, for its sender; "" if it is accepted
    nlohmann::json facts;  ///< what the check found; an object if it is accepted
};

/// Runs check_asset (renderer/assets/check_asset.h) on untrusted bytes in a child that may die, run out of memory or
/// hang; each of these is a refusal. The bytes are passed as a file that is only in memory, so they never reach the
/// disk. Throws std::system_error if the child cannot be started.
UploadVerdict check_upload(const std::string& bytes, const std::string& media_type, const ChildLimits& limits);

}  // namespace sheer
