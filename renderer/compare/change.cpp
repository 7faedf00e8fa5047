#include "renderer/compare/change.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheer {

namespace {

/// Null if there is none.
const MethodResult* counterpart_of(const MethodResult& result, const Run& run) {
    const MethodResult* found = nullptr;
    for (const MethodResult& other : run.results) {
        if (&other == &result || other.method.id != result.method.id) continue;
        if (other.method.parameters != result.method.parameters || other.method.look == result.method.look) continue;
        if (other.method.look.empty()) return &other;
        if (!found) found = &other;
    }
    return found;
}

}  // namespace

void compare_with_counterparts(Run& run) {
    for (MethodResult& result : run.results) {
        if (result.method.look.empty() || result.status != report::ResultStatus::ok) continue;
        const MethodResult* before = counterpart_of(result, run);
        if (!before) {
            result.no_change_reason =
                fmt::format("no other method is {} with the same parameters, in another look", result.method.id);
        } else if (before->status != report::ResultStatus::ok) {
            result.no_change_reason =
                fmt::format("{} is {}: {}", before->method.label, word_of(before->status), before->reason);
        } else {
            result.change = PictureChange{before->method.label, before->image.rgba == result.image.rgba,
                                          compute_metrics(before->image, result.image)};
        }
    }
}

}  // namespace sheer
