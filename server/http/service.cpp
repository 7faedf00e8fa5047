#include "server/http/service.h"

#include <fmt/format.h>

#include "server/http/problem.h"

namespace sheer::http {

void require_sandbox(const Service& service, const std::string& what) {
    if (service.without_sandbox.empty() || !service.needs_sandbox) return;
    throw Problem(403, fmt::format("{} is refused, as this service has no sandbox: {}. Its configuration can allow it "
                                   "nevertheless: sandbox.required.",
                                   what, service.without_sandbox));
}

}  // namespace sheer::http
