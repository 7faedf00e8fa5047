#include "server/jobs/usage.h"

namespace sheer {

std::optional<SubmitResult::Outcome> refusal_of(const Sender& sender, const TokenUse& use) {
    if (sender.max_jobs && use.jobs >= *sender.max_jobs) return SubmitResult::Outcome::too_many_jobs;
    if (sender.max_seconds && use.seconds + 1 > static_cast<double>(*sender.max_seconds))
        return SubmitResult::Outcome::seconds_used_up;
    return std::nullopt;
}

}  // namespace sheer
