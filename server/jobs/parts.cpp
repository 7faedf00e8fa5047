#include "server/jobs/parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheer {

std::vector<PartState> part_states(const std::vector<std::string>& labels, const std::vector<EndedPart>& ended,
                                   const std::string& running) {
    std::vector<PartState> states;
    for (const std::string& label : labels) {
        PartState state{.label = label, .status = label == running ? Status::running : Status::queued};
        if (const auto part = std::ranges::find(ended, label, &EndedPart::label); part != ended.end()) {
            state.status = part->error ? Status::failed : Status::done;
            state.error = part->error;
        }
        states.push_back(state);
    }
    return states;
}

JobError every_part_failed(const std::vector<EndedPart>& parts) {
    std::string detail;
    for (const EndedPart& part : parts)
        if (part.error)
            detail += fmt::format("{}{}: {}: {}", detail.empty() ? "" : " ", part.label, part.error->title,
                                  part.error->detail);
    return {"Rendering failed on every device", detail};
}

}  // namespace sheer
