#include "server/jobs/status.h"

#include <array>
#include <utility>

namespace sheer {

namespace {

constexpr std::array<std::pair<Status, std::string_view>, 5> names{{{Status::queued, "queued"},
                                                                    {Status::running, "running"},
                                                                    {Status::done, "done"},
                                                                    {Status::failed, "failed"},
                                                                    {Status::cancelled, "cancelled"}}};

}  // namespace

std::string_view status_text(Status status) {
    for (const auto& [value, text] : names)
        if (value == status) return text;
    return "";
}

std::optional<Status> status_from(std::string_view text) {
    for (const auto& [value, name] : names)
        if (name == text) return value;
    return std::nullopt;
}

}  // namespace sheer
