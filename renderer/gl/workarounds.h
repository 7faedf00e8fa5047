#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sheer::gl {

struct DeviceInfo;

/// A driver bug that Sheer works around. Each has a name, which the switch and the report use, and a paragraph.
struct Workaround {
    std::string_view name;
    std::string_view paragraph;
    bool (*applies)(const DeviceInfo&);
};

/// All that are known; `sheer devices --json` prints them.
std::span<const Workaround> known_workarounds();

/// Those in use on a context.
class Workarounds {
  public:
    Workarounds() = default;
    /// Throws std::invalid_argument for a name in `disabled` that is not known.
    Workarounds(const DeviceInfo& device, std::span<const std::string> disabled);

    bool has(std::string_view name) const;
    const std::vector<std::string>& names() const { return m_names; }

  private:
    std::vector<std::string> m_names;
};

}  // namespace sheer::gl
