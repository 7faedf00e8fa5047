#pragma once
#include <optional>
#include <string_view>

namespace sheer {

enum class Status { queued, running, done, failed, cancelled };

std::string_view status_text(Status status);
std::optional<Status> status_from(std::string_view text);

/// A report in a final status never changes again.
inline bool is_final(Status status) {
    return status != Status::queued && status != Status::running;
}

}  // namespace sheer
