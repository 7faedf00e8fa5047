#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "server/process/sandbox.h"

namespace sheer::cli {

/// The option --shaders of commands that draw for a service: the folder where the driver keeps compiled shaders.
class ShaderFolder {
  public:
    void add_to(CLI::App& command);
    /// Opens the folder to the driver, for Mesa by https://docs.mesa3d.org/envvars.html. Before the device is opened.
    void open(OpenFiles& files) const;

  private:
    std::string m_path;
};

}  // namespace sheer::cli
