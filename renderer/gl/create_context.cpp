#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "renderer/errors.h"
#include "renderer/gl/context_kinds.h"

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

/// The best context of one kind, or null with the reasons added. A GPU comes before software, which comes before what
/// is there for machines without EGL devices.
std::unique_ptr<Context> best_of(std::vector<Candidate> candidates, const Selection& selection,
                                 const ContextRequest& request, std::vector<std::string>& reasons) {
    std::ranges::stable_sort(candidates, {}, &Candidate::expectation);
    std::unique_ptr<Context> best;
    for (const Candidate& candidate : candidates) {
        if (best != nullptr && candidate.expectation != Expectation::gpu) break;
        if (!selection.may_be(candidate.info)) continue;
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
    // A wrong name is the caller's mistake, not a reason to go on to the next device.
    const Workarounds names_are_known(DeviceInfo{}, request.disabled_workarounds);
    const Selection selection(request.device, kinds);
    std::vector<std::string> reasons;
    for (const Kind& kind : kinds) {
        if (request.context == "auto" ? !kind.automatic : request.context != kind.name) continue;
        if (auto context = best_of(kind.candidates(), selection, request, reasons)) return context;
    }
    if (reasons.empty()) reasons.emplace_back("there is none of that name");
    throw Unsupported(fmt::format("no OpenGL 4.5 context '{}'{}: {}", request.context,
                                  selection.any() ? "" : fmt::format(" on device '{}'", request.device),
                                  fmt::join(reasons, "; ")));
}

}  // namespace sheer::gl
