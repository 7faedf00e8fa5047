#include <fmt/format.h>

#include "renderer/gl/context.h"
#include "renderer/spec/catalog.h"
#include "server/cli/list_command.h"
#include "server/cli/rendering/commands.h"

namespace sheer::cli {

namespace {

using nlohmann::json;

json describe_devices() {
    std::vector<catalog::ListedDevice> all;
    for (const gl::ListedDevice& device : gl::list_devices()) {
        all.push_back({device.info, device.error, {}});
        for (const gl::Workaround& workaround : gl::known_workarounds())
            if (!device.error && workaround.applies(device.info))
                all.back().workarounds.push_back({std::string(workaround.name), std::string(workaround.paragraph)});
    }
    return to_document(all);
}

std::string device_line(const json& device) {
    const auto name = device["name"].get<std::string>();
    if (!device["error"].is_null())
        return fmt::format("{:<10} not usable: {}\n", name, device["error"].get<std::string>());
    return fmt::format("{:<10} {}, OpenGL {}{}\n", name, device["renderer"].get<std::string>(),
                       device["gl_version"].get<std::string>(), device["software"].get<bool>() ? ", software" : "");
}

}  // namespace

void add_devices(CLI::App& app, int& exit_code) {
    add_list(app, exit_code, "devices", "The devices that can render here", "--json", describe_devices, device_line);
}

}  // namespace sheer::cli
