#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/picture_header_parts.h"

namespace sheer {

namespace {

constexpr std::size_t exr_magic_bytes = 4;

/// The first and the last pixel, both within it.
struct ExrWindow {
    std::array<std::int64_t, 4> corners;  ///< x, y of the first, x, y of the last
    std::int64_t width() const { return corners[2] - corners[0] + 1; }
    std::int64_t height() const { return corners[3] - corners[1] + 1; }
    bool holds(const ExrWindow& other) const {
        return other.corners[0] >= corners[0] && other.corners[1] >= corners[1] && other.corners[2] <= corners[2] &&
               other.corners[3] <= corners[3];
    }
};

class ExrHeaderReader {
  public:
    explicit ExrHeaderReader(std::string_view bytes) : m_reader(bytes, exr_magic_bytes) {}

    PictureHeader read() {
        constexpr std::uint32_t deep = 0x800, several_parts = 0x1000;
        const std::uint32_t version = m_reader.u32_little();
        if ((version & (deep | several_parts)) != 0)
            throw AssetError(
                "the OpenEXR file has deep data or several parts; only flat pictures with one part are supported");
        for (std::string_view name = m_reader.zero_ended_text(); !name.empty(); name = m_reader.zero_ended_text()) {
            m_reader.zero_ended_text();
            read_attribute(name, ByteReader(m_reader.take(m_reader.u32_little())));
        }
        if (!m_data_window) throw AssetError("the OpenEXR file has no data window");
        use_windows();
        use_channels();
        return m_header;
    }

  private:
    void read_attribute(std::string_view name, ByteReader value) {
        if (name == "dataWindow") m_data_window = read_window(value);
        if (name == "displayWindow") m_display_window = read_window(value);
        if (name == "channels") read_channels(value);
        if (name == "chromaticities") {
            Chromaticities chromaticities{};
            for (double& number : chromaticities.xy) number = value.f32_little();
            note_chromaticities(m_header, chromaticities);
        }
    }

    static ExrWindow read_window(ByteReader& value) {
        ExrWindow window{};
        for (std::int64_t& corner : window.corners) corner = static_cast<std::int32_t>(value.u32_little());
        return window;
    }

    void read_channels(ByteReader& value) {
        for (std::string_view name = value.zero_ended_text(); !name.empty(); name = value.zero_ended_text()) {
            const std::uint32_t type = value.u32_little();
            value.skip(4);
            const std::uint32_t step_x = value.u32_little(), step_y = value.u32_little();
            m_names.emplace_back(name);
            if (type == 0) m_whole_numbers.emplace_back(name);
            if (step_x != 1 || step_y != 1) m_sampled = true;
        }
    }

    /// The picture is the display window; pixels of the data window outside it are not a part of it.
    void use_windows() {
        const ExrWindow shown = m_display_window.value_or(*m_data_window);
        check_picture_size(PictureFormat::exr, m_data_window->width(), m_data_window->height());
        check_picture_size(PictureFormat::exr, shown.width(), shown.height());
        m_header.format = PictureFormat::exr;
        m_header.width_px = static_cast<int>(shown.width());
        m_header.height_px = static_cast<int>(shown.height());
        if (!shown.holds(*m_data_window))
            add_note(m_header.notes,
                     {"outside-display-window",
                      fmt::format("The picture is the display window of {} x {} pixels; pixels of the file outside it "
                                  "are ignored.",
                                  shown.width(), shown.height()),
                      ""});
    }

    bool has(const char* name) const { return std::ranges::find(m_names, name) != m_names.end(); }

    void use_channels() {
        if (m_sampled || has("RY") || has("BY"))
            throw AssetError(
                "the OpenEXR file has luminance and chroma, or subsampled channels; R, G and B of "
                "every pixel, or Y alone, are supported");
        std::vector<std::string> used = {"R", "G", "B", "A"};
        if (!has("R") || !has("G") || !has("B")) used = {"Y", "A"};
        if (!has(used[0].c_str()))
            throw AssetError(
                fmt::format("the OpenEXR file has the channels {}; R, G and B, or Y, outside of layers "
                            "are supported",
                            fmt::join(first_names(m_names), ", ")));
        std::vector<std::string> unread;
        const auto is_used = [&](const std::string& name) { return std::ranges::find(used, name) != used.end(); };
        std::ranges::remove_copy_if(m_names, std::back_inserter(unread), is_used);
        if (std::ranges::any_of(m_whole_numbers, is_used))
            throw AssetError("the OpenEXR file holds whole numbers; halves and floats are supported");
        if (!unread.empty())
            add_note(m_header.notes, {"channels-ignored",
                                      fmt::format("These channels of the OpenEXR file are ignored: {}.",
                                                  fmt::join(first_names(unread), ", ")),
                                      ""});
    }

    static std::vector<std::string> first_names(std::vector<std::string> names) {
        constexpr std::size_t most_names = 8;
        if (names.size() > most_names) {
            names.resize(most_names);
            names.emplace_back("...");
        }
        for (std::string& name : names) name = printable(name);
        return names;
    }

    ByteReader m_reader;
    PictureHeader m_header;
    std::optional<ExrWindow> m_data_window, m_display_window;
    std::vector<std::string> m_names, m_whole_numbers;
    bool m_sampled = false;
};

}  // namespace

PictureHeader read_exr_header(std::string_view bytes) {
    return ExrHeaderReader(bytes).read();
}

}  // namespace sheer
