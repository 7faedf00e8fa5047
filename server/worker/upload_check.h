#pragma once
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "server/worker/child_process.h"

namespace sheer {

struct UploadCheckOptions {
    std::uint64_t memory_limit_bytes = std::uint64_t{2} << 30;  ///< address space of the child
    std::chrono::milliseconds time_limit{20'000};
    std::string program = own_program;
};

/// What is known of an uploaded file after it was read whole.
struct UploadVerdict {
    std::string refusal;   ///< why it is not taken, for its sender; "" if it is
    nlohmann::json facts;  ///< what the check found; an object if it is taken
};

/// Runs check_asset (renderer/assets/check_asset.h) on bytes that nobody vouches for, in a child that may die, run out
/// of memory or hang; each of these is a refusal. The bytes reach the child as a file that is only in memory, so
/// nothing of them is ever left on the disk. Throws std::system_error if the child cannot be started.
UploadVerdict check_upload(const std::string& bytes, const std::string& media_type, const UploadCheckOptions& options);

}  // namespace sheer
