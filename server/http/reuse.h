#pragma once
#include <optional>
#include <string>

#include "server/http/service.h"

namespace sheer::http {

/// The newest done report of this spec that was made by the same version and commit of the program, on the device and
/// processor on which it would be rendered now, and in which nothing failed. Uploaded files belong to the spec by their
/// hashes. Nothing if there is none, or the devices cannot be listed.
std::optional<ReportRecord> reusable_report(Service& service, const std::string& spec_sha256);

}  // namespace sheer::http
