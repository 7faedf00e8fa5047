#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "server/process/sandbox.h"

namespace sheer::cli {

/// The options --sandbox and --readable of the service's children, which are not shown in the help.
class SandboxOption {
  public:
    void add_to(CLI::App& command);

    /// Does nothing without --sandbox, like the other one. See sandbox.h.
    void confine_files(OpenFiles open) const;
    void confine_calls() const;

  private:
    bool m_on = false;
    std::vector<std::string> m_readable;
};

/// What a child needs of a service's folder `data`, the one with its archive: pictures and uploaded files, of which it
/// must know the names. Nothing if `data` is empty.
OpenFiles stored_files(const std::string& data);

}  // namespace sheer::cli
