#include "renderer/gl/workarounds.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "renderer/gl/context.h"

namespace sheer::gl {
namespace {

bool is_llvmpipe(const DeviceInfo& device) {
    return device.renderer.find("llvmpipe") != std::string::npos;
}

bool is_nvidia(const DeviceInfo& device) {
    return device.vendor.starts_with("NVIDIA");
}

constexpr std::array workarounds{
    Workaround{
        "flush-timer-queries",
        "llvmpipe stamps the begin of a GL_TIME_ELAPSED query once per rasterised tile, and a later tile overwrites "
        "the stamp of an earlier one, so that a query around a frame of 835 ms gave 25.8 ms; with a framebuffer of no "
        "tile there is no stamp and the query gives the time since the machine started. A glFlush right after the "
        "begin, with a framebuffer of one pixel in use, puts one stamp into a batch of its own, which is rasterised "
        "before the pass begins.",
        is_llvmpipe,
    },
    Workaround{
        "keep-programs",
        "After a program has been deleted, the first draws of a program made later may draw nothing: on an NVIDIA H100 "
        "with driver 580.159.04, 98 of 1,583 first frames of a method, made after another one had been destroyed, "
        "lacked all their transparent fragments, and the next frame had them. Without deleting programs none of 804 "
        "did, as if the device still ran the instructions that had been at the same place before. So programs stay "
        "until their context ends.",
        is_nvidia,
    },
};

}  // namespace

std::span<const Workaround> known_workarounds() {
    return workarounds;
}

Workarounds::Workarounds(const DeviceInfo& device, std::span<const std::string> disabled) {
    for (const std::string& name : disabled) {
        if (std::ranges::find(workarounds, name, &Workaround::name) != workarounds.end()) continue;
        std::vector<std::string_view> known;
        for (const Workaround& workaround : workarounds) known.push_back(workaround.name);
        throw std::invalid_argument(
            fmt::format("there is no workaround '{}'; the known ones are: {}", name, fmt::join(known, ", ")));
    }
    for (const Workaround& workaround : workarounds) {
        if (!workaround.applies(device)) continue;
        const bool off = std::ranges::find(disabled, workaround.name) != disabled.end();
        spdlog::info("{}: workaround {} {}", device.name, workaround.name, off ? "applies but is off" : "in use");
        if (!off) m_names.emplace_back(workaround.name);
    }
}

bool Workarounds::has(std::string_view name) const {
    return std::ranges::find(m_names, name) != m_names.end();
}

}  // namespace sheer::gl
