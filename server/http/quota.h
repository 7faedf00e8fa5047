#pragma once
#include <chrono>
#include <vector>

#include "server/http/answers.h"
#include "server/http/problem.h"
#include "server/http/service.h"

namespace sheer::http {

// Problems (429) with Retry-After for the holder of a token who takes up as much as the quota allows.
Problem too_many_jobs(const Token& token, std::chrono::seconds until_a_place);
Problem seconds_used_up(Service& service, const Token& token);
/// Throws one if `bytes` more are too many.
void require_upload_quota(Service& service, const Token& token, std::int64_t bytes);

/// The limits of a token, and what is used of each.
std::vector<answer::QuotaLine> quota_lines(Service& service, const Token& token);

}  // namespace sheer::http
