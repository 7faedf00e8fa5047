#pragma once
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "server/process/child_process.h"

namespace sheer {

struct UploadCheckOptions {
    std::uint64_t memory_limit_bytes = std::uint64_t{2} << 30;  ///< address space of the child
    std::chrono::milliseconds time_limit{20'000};
    std::string program = own_program;
};

/// What is known about an uploaded file after all of it was read.
struct UploadVerdict {
    std::string refusal;   ///< why it is refused, for its sender; "" if it is accepted
    nlohmann::json facts;  ///< what the check found; an object if it is accepted
};

/// Runs check_asset (renderer/assets/check_asset.h) on untrusted bytes in a child that may die, run out of memory or
/// hang; each of these is a refusal. The bytes are passed as a file that is only in memory, so they never reach the
/// disk. Throws std::system_error if the child cannot be started.
UploadVerdict check_upload(const std::string& bytes, const std::string& media_type, const UploadCheckOptions& options);

}  // namespace sheer
