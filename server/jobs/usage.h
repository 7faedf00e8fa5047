#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "server/jobs/job_queue.h"

namespace sheer {

/// What the holder of a token takes up. Hours are added up, those of the last day: the present one and the 23 before
/// it.
struct TokenUse {
    std::int64_t jobs = 0;          ///< queued or running now
    double seconds = 0;             ///< of rendering
    std::int64_t upload_bytes = 0;  ///< of files that were sent
    std::optional<std::int64_t>
        less_at_ms;  ///< when the oldest of these hours leaves the day; nothing if there is none
};

/// Kept by the names of tokens, over all processes. The queue adds the jobs and seconds of each report with a sender.
class Usage {
  public:
    virtual ~Usage() = default;
    virtual TokenUse of(const std::string& token) = 0;
    virtual void add_upload(const std::string& token, std::int64_t bytes) = 0;
};

/// Why a new report of the sender is refused, if it is. Nobody knows how long it will take, so a second must be left.
std::optional<SubmitResult::Outcome> refusal_of(const Sender& sender, const TokenUse& use);

inline constexpr std::int64_t use_hour_ms = 3'600'000;
inline constexpr std::int64_t use_hours = 24;

}  // namespace sheer
