#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "renderer/gl/context.h"

namespace sheer::gl {

/// How much to expect of a candidate before its context is made.
enum class Expectation { gpu, software, last_resort };

/// A place where a context could be made.
struct Candidate {
    DeviceInfo info;  ///< context, index, name and platform only
    Expectation expectation = Expectation::software;
    /// The new context is current. Throws an exception with the reason if none can be made.
    std::function<std::unique_ptr<Context>(const DeviceInfo&, const ContextRequest&)> create;
};

/// The candidates of each kind, in the order of their index. None of these throws if the machine lacks something:
/// `create` does, so that a user sees the reason.
std::vector<Candidate> egl_candidates();
std::vector<Candidate> osmesa_candidates();
std::vector<Candidate> glfw_candidates();

/// A way to make contexts.
struct Kind {
    std::string_view name;
    std::vector<Candidate> (*candidates)();
    bool automatic = false;  ///< whether "auto" tries it
};

/// A driver that has not answered for this long is taken to hang.
inline constexpr std::chrono::seconds look_time_limit{30};

/// create_context(), open_device() and list_devices() of context.h for these kinds, in their order.
std::unique_ptr<Context> create_context(const ContextRequest& request, std::span<const Kind> kinds);
std::unique_ptr<Context> open_device(const ContextRequest& request, std::span<const Kind> kinds,
                                     std::chrono::milliseconds time_limit = look_time_limit);
std::vector<ListedDevice> list_devices(std::span<const Kind> kinds,
                                       std::chrono::milliseconds time_limit = look_time_limit);

/// Throws Unsupported with the reason if one of the candidates that open_device() would try takes its process down.
void require_sound(const ContextRequest& request, std::span<const Kind> kinds);

}  // namespace sheer::gl
