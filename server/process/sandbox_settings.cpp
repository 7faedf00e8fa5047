#include "server/process/sandbox_settings.h"

#include "server/process/sandbox.h"

namespace sheer {

std::string why_no_sandbox(const SandboxSettings& settings) {
    return settings.enabled ? why_no_sandbox() : "the configuration switches it off";
}

void confine(ChildOptions& child, const SandboxSettings& settings) {
    if (!why_no_sandbox(settings).empty()) return;
    child.own_namespaces = true;
    child.arguments.emplace_back("--sandbox");
    for (const std::string& path : settings.readable)
        child.arguments.insert(child.arguments.end(), {"--readable", path});
}

}  // namespace sheer
