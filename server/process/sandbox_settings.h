#pragma once
#include <string>
#include <vector>

#include "server/process/child_process.h"

namespace sheer {

/// How a service confines the children that read what others sent.
struct SandboxSettings {
    bool enabled = true;
    bool required = true;               ///< without a sandbox, what needs one is refused
    std::vector<std::string> readable;  ///< folders and files that drivers need besides those of the system
};

/// Why these settings give no sandbox on this system; "" if they do.
std::string why_no_sandbox(const SandboxSettings& settings);

/// Gives a child that runs a command of sheer-render the options that confine it
/// (server/cli/rendering/sandbox_option.h), and namespaces of its own; nothing if there is no sandbox.
void confine(ChildOptions& child, const SandboxSettings& settings);

}  // namespace sheer
