#include "server/http/quota.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheer::http {

namespace {

double used_of(const TokenUse& use, const QuotaLimit& limit) {
    if (limit.limit == &Quota::jobs) return static_cast<double>(use.jobs);
    if (limit.limit == &Quota::seconds) return use.seconds;
    return static_cast<double>(use.upload_bytes);
}

Problem used_up(const Token& token, const QuotaLimit& limit, std::int64_t more_in_s) {
    return Problem(429, fmt::format("The quota of \"{}\" is used up: {} {}.", token.name,
                                    (token.quota.*limit.limit).value_or(0), limit.what))
        .with("Retry-After", fmt::format("{}", std::max<std::int64_t>(more_in_s, 1)));
}

std::int64_t until_less_s(const Service& service, const TokenUse& use) {
    return (use.less_at_ms.value_or(0) - service.clock()) / 1000;
}

}  // namespace

Problem too_many_jobs(const Token& token, std::chrono::seconds until_a_place) {
    return used_up(token, jobs_limit, until_a_place.count());
}

Problem seconds_used_up(Service& service, const Token& token) {
    return used_up(token, seconds_limit, until_less_s(service, service.store.usage().of(token.name)));
}

void require_upload_quota(Service& service, const Token& token, std::int64_t bytes) {
    if (!token.quota.upload_bytes) return;
    const TokenUse use = service.store.usage().of(token.name);
    if (use.upload_bytes + bytes > *token.quota.upload_bytes)
        throw used_up(token, upload_limit, until_less_s(service, use));
}

std::vector<answer::QuotaLine> quota_lines(Service& service, const Token& token) {
    const TokenUse use = service.store.usage().of(token.name);
    std::vector<answer::QuotaLine> lines;
    for (const QuotaLimit& limit : quota_limits)
        if (const auto most = token.quota.*limit.limit)
            lines.push_back({limit.name, limit.what, *most, used_of(use, limit)});
    return lines;
}

}  // namespace sheer::http
