#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <map>
#include <stdexcept>

#include "renderer/core/errors.h"
#include "renderer/gl/context_kinds.h"
#include "renderer/gl/forked.h"

namespace sheer::gl {
namespace {

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

/// Which device the user asked for: any, one by its place, or one by a part of its renderer's name.
class Selection {
  public:
    Selection(const std::string& device, std::span<const Kind> kinds) : m_text(lower(device)) {
        const bool number = std::ranges::all_of(m_text, [](unsigned char c) { return std::isdigit(c) != 0; });
        const bool name = std::ranges::any_of(
            kinds, [&](const Kind& kind) { return m_text.starts_with(fmt::format("{}:", kind.name)); });
        m_by = m_text.empty() ? By::nothing : number ? By::index : name ? By::name : By::renderer;
    }

    bool any() const { return m_by == By::nothing; }
    bool may_be(const DeviceInfo& candidate) const {
        return (m_by != By::index || m_text == std::to_string(candidate.index)) &&
               (m_by != By::name || m_text == candidate.name);
    }
    bool is(const DeviceInfo& device) const {
        return m_by != By::renderer || lower(device.renderer).find(m_text) != std::string::npos;
    }

  private:
    enum class By { nothing, index, name, renderer };
    std::string m_text;
    By m_by;
};

/// What is known before a choice, and who is told about its progress.
struct Choice {
    std::map<std::string, std::string> unusable;  ///< candidates that are left out, by name, and why
    Say say;                                      ///< told the name of each candidate before it is tried; may be null
};

/// The best context of one kind, or null with the reasons added. A GPU comes before software, and both come before the
/// fallback for machines without EGL devices.
std::unique_ptr<Context> best_of(std::vector<Candidate> candidates, const Selection& selection,
                                 const ContextRequest& request, const Choice& choice,
                                 std::vector<std::string>& reasons) {
    std::ranges::stable_sort(candidates, {}, &Candidate::expectation);
    std::unique_ptr<Context> best;
    for (const Candidate& candidate : candidates) {
        if (best != nullptr && candidate.expectation != Expectation::gpu) break;
        if (!selection.may_be(candidate.info)) continue;
        if (const auto found = choice.unusable.find(candidate.info.name); found != choice.unusable.end()) {
            reasons.push_back(fmt::format("{} ({}): {}", candidate.info.name, candidate.info.platform, found->second));
            continue;
        }
        if (choice.say) choice.say(candidate.info.name);
        try {
            std::unique_ptr<Context> context = candidate.create(candidate.info, request);
            const DeviceInfo& device = context->device();
            if (!selection.is(device)) {
                reasons.push_back(fmt::format("{} is {}", device.name, device.renderer));
            } else if (!device.software || !selection.any()) {
                return context;
            } else if (best == nullptr) {
                best = std::move(context);
            }
        } catch (const std::runtime_error& error) {
            reasons.push_back(fmt::format("{} ({}): {}", candidate.info.name, candidate.info.platform, error.what()));
        }
    }
    if (best != nullptr) best->make_current();
    return best;
}

std::unique_ptr<Context> choose(const ContextRequest& request, std::span<const Kind> kinds, const Choice& choice) {
    const Selection selection(request.device, kinds);
    std::vector<std::string> reasons;
    for (const Kind& kind : kinds) {
        if (request.context == "auto" ? !kind.automatic : request.context != kind.name) continue;
        if (auto context = best_of(kind.candidates(), selection, request, choice, reasons)) return context;
    }
    if (reasons.empty()) reasons.emplace_back("there is none with that name");
    throw Unsupported(fmt::format("no OpenGL 4.5 context '{}'{}: {}", request.context,
                                  selection.any() ? "" : fmt::format(" on device '{}'", request.device),
                                  fmt::join(reasons, "; ")));
}

/// Chooses in children until one of them finishes. Returns the candidates that crashed theirs, and how.
std::map<std::string, std::string> look_ahead(const ContextRequest& request, std::span<const Kind> kinds,
                                              std::chrono::milliseconds time_limit) {
    std::map<std::string, std::string> unusable;
    while (true) {
        const ForkedRun run = run_forked(
            [&](const Say& say) {
                try {
                    // Not destroyed here: a driver may crash while it is destroyed, and at the end the report has been
                    // written.
                    choose(request, kinds, {unusable, say}).release();
                } catch (const std::exception&) {
                    // The calling process meets the same exception, with its reasons.
                }
            },
            time_limit);
        if (run.trouble.empty()) return unusable;
        if (run.lines.empty() || unusable.contains(run.lines.back()))
            throw Unsupported("the devices cannot be listed: the process that lists them " + run.trouble);
        unusable[run.lines.back()] = "its driver " + run.trouble;
    }
}

ListedDevice listed(const nlohmann::json& line) {
    ListedDevice device;
    const nlohmann::json& info = line.at("info");
    device.info.context = info.at("context");
    device.info.index = info.at("index");
    device.info.name = info.at("name");
    device.info.renderer = info.at("renderer");
    device.info.vendor = info.at("vendor");
    device.info.gl_version = info.at("gl_version");
    device.info.glsl_version = info.at("glsl_version");
    device.info.platform = info.at("platform");
    device.info.software = info.at("software");
    if (line.at("error").is_string()) device.error = line.at("error");
    return device;
}

/// For each candidate from the `first` on, says that it is being tried and then what the result was.
void look_at_candidates(std::span<const Kind> kinds, std::size_t first, const Say& say) {
    std::size_t number = 0;
    const auto tell = [&](const DeviceInfo& info, const nlohmann::json& error, bool done) {
        say(nlohmann::json{{"info", to_json(info)}, {"error", error}, {"done", done}}.dump(
            -1, ' ', false, nlohmann::json::error_handler_t::replace));
    };
    for (const Kind& kind : kinds) {
        for (const Candidate& candidate : kind.candidates()) {
            if (number++ < first) continue;
            tell(candidate.info, nullptr, false);
            try {
                tell(candidate.create(candidate.info, {})->device(), nullptr, true);
            } catch (const std::runtime_error& error) {
                tell(candidate.info, error.what(), true);
            }
        }
    }
}

void require_known(std::string_view context, std::span<const Kind> kinds) {
    if (context == "auto" || std::ranges::find(kinds, context, &Kind::name) != kinds.end()) return;
    std::vector<std::string_view> known{"auto"};
    for (const Kind& kind : kinds) known.push_back(kind.name);
    throw std::invalid_argument(
        fmt::format("there is no context '{}'; it is one of {}", context, fmt::join(known, ", ")));
}

}  // namespace

std::unique_ptr<Context> create_context(const ContextRequest& request, std::span<const Kind> kinds) {
    require_known(request.context, kinds);
    // A wrong name is the caller's mistake, not a reason to try the next device.
    const Workarounds names_are_known(DeviceInfo{}, request.disabled_workarounds);
    return choose(request, kinds, {});
}

std::unique_ptr<Context> open_device(const ContextRequest& request, std::span<const Kind> kinds,
                                     std::chrono::milliseconds time_limit) {
    require_known(request.context, kinds);
    const Workarounds names_are_known(DeviceInfo{}, request.disabled_workarounds);
    return choose(request, kinds, {look_ahead(request, kinds, time_limit), {}});
}

void require_sound(const ContextRequest& request, std::span<const Kind> kinds) {
    for (const auto& [name, reason] : look_ahead(request, kinds, look_time_limit))
        throw Unsupported(fmt::format("{}: {}", name, reason));
}

std::vector<ListedDevice> list_devices(std::span<const Kind> kinds, std::chrono::milliseconds time_limit) {
    std::vector<ListedDevice> all;
    while (true) {
        const std::size_t first = all.size();
        const ForkedRun run = run_forked([&](const Say& say) { look_at_candidates(kinds, first, say); }, time_limit);
        bool is_done = true;
        for (const std::string& text : run.lines) {
            const auto line = nlohmann::json::parse(text);
            if (is_done) all.emplace_back();
            all.back() = listed(line);
            is_done = line.at("done");
        }
        if (run.trouble.empty()) return all;
        if (is_done) throw Unsupported("the devices cannot be listed: the process that lists them " + run.trouble);
        all.back().error = "its driver " + run.trouble;
    }
}

}  // namespace sheer::gl
