#include "renderer/assets/picture_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/scaler.h"

namespace sheer {

namespace {

constexpr float max_half = 65504;

const char* reader_name(PictureFormat format) {
    if (format == PictureFormat::png) return "png";
    if (format == PictureFormat::webp) return "webp";
    return format == PictureFormat::jpeg ? "jpeg" : "openexr";
}

/// The places of the RGBA channels in the file; grey is used for all three colors.
struct ChannelMap {
    int color[3];
    int alpha;  ///< -1 for none
    bool grey;
};

ChannelMap map_channels(const OIIO::ImageSpec& spec) {
    const auto index = [&](const char* name) { return spec.channelindex(name); };
    if (index("R") >= 0 && index("G") >= 0 && index("B") >= 0)
        return {{index("R"), index("G"), index("B")}, index("A"), false};
    if (const int grey = index("Y"); grey >= 0) return {{grey, grey, grey}, index("A"), true};
    throw AssetError("the picture has neither the channels R, G and B nor the channel Y");
}

class Decoder {
  public:
    Decoder(std::string_view bytes, PictureHeader header)
        : m_memory(bytes.data(), bytes.size()), m_header(std::move(header)) {
        m_input = OIIO::ImageInput::create(reader_name(m_header.format));
        if (!m_input || !m_input->supports("ioproxy")) throw AssetError("pictures of this format cannot be read here");
        m_input->threads(1);
        m_input->set_ioproxy(&m_memory);
        OIIO::ImageSpec as_stored;
        as_stored["oiio:UnassociatedAlpha"] = 1;
        if (!m_input->open("picture", m_spec, as_stored)) fail();
        m_width = m_header.width_px;
        m_height = m_header.height_px;
        if (is_transposed(m_header)) std::swap(m_width, m_height);
        if (m_spec.full_width != m_width || m_spec.full_height != m_height || m_spec.depth > 1)
            throw AssetError("the picture's header and its data have different sizes");
        m_channels = map_channels(m_spec);
        note_profile();
    }

    void read(const RowFunction& row) {
        const int rows = m_spec.tile_height > 0 ? m_spec.tile_height : rows_at_a_time;
        const std::size_t row_values = static_cast<std::size_t>(m_spec.width) * m_spec.nchannels;
        std::vector<float> values(row_values * static_cast<std::size_t>(std::min(rows, m_spec.height)));
        const int above = m_spec.y - m_spec.full_y;
        for (int y = 0; y < m_spec.height; y += rows) {
            const int end = std::min(y + rows, m_spec.height);
            if (!read_rows(y, end, values.data())) fail();
            refuse_damage();
            for (int i = y; i < end; ++i) {
                place(&values[row_values * static_cast<std::size_t>(i - y)]);
                if (above + i >= 0 && above + i < m_height) row(above + i, m_row.data());
            }
        }
    }

    PictureFacts facts() {
        if (m_clamped)
            add_note(m_header.notes, {"values-clamped",
                                      "The picture has colors below 0 or alpha outside 0 to 1; they are clamped.", ""});
        return {m_header, (m_channels.grey ? 1 : 3) + (m_channels.alpha >= 0), m_spec.format.basesize() == 1,
                m_header.notes};
    }

  private:
    static constexpr int rows_at_a_time = 256;

    /// A line of OpenImageIO's message without the name of the file, which we chose.
    static std::string message_of(std::string_view line) {
        line = line.substr(0, line.find(" (\"picture\")"));
        constexpr std::string_view prefix = "JPEG error: ";
        if (line.starts_with(prefix)) line.remove_prefix(prefix.size());
        return printable(line, 200);
    }

    [[noreturn]] void fail() {
        const std::string why = m_input->geterror();
        throw AssetError(fmt::format("the {} cannot be decoded{}{}", name_of(m_header.format), why.empty() ? "" : ": ",
                                     message_of(std::string_view(why).substr(0, why.find('\n')))));
    }

    /// libjpeg fills missing or damaged parts with grey and only warns about it. A few of its warnings concern nothing
    /// that is lost.
    void refuse_damage() {
        if (!m_input->has_error()) return;
        constexpr std::string_view harmless[] = {"extraneous bytes before marker", "JFIF revision number",
                                                 "Invalid SOS parameters"};
        const std::string warnings = m_input->geterror();
        for (std::size_t begin = 0; begin < warnings.size();) {
            const std::size_t end = std::min(warnings.find('\n', begin), warnings.size());
            const std::string line = message_of(std::string_view(warnings).substr(begin, end - begin));
            begin = end + 1;
            if (std::ranges::none_of(harmless, [&](std::string_view text) { return line.find(text) != line.npos; }))
                throw AssetError(fmt::format("the {} cannot be decoded: {}", name_of(m_header.format), line));
            add_note(m_header.notes, {"decoder-warning", fmt::format("The decoder says: {}.", line), ""});
        }
    }

    /// Profiles are not applied, because values are blended as they are; that of sRGB would change nothing.
    void note_profile() {
        if (m_spec.find_attribute("ICCProfile") == nullptr) return;
        const std::string name(m_spec.get_string_attribute("ICCProfile:profile_description"));
        if (name.find("sRGB") != std::string::npos) return;
        add_note(m_header.notes,
                 {"profile-ignored",
                  fmt::format("The picture has the ICC profile \"{}\"; its values are used as they are.",
                              printable(name, 80)),
                  ""});
    }

    bool read_rows(int begin, int end, float* out) {
        const int first = m_spec.y + begin, last = m_spec.y + end;
        if (m_spec.tile_height == 0)
            return m_input->read_scanlines(0, 0, first, last, 0, 0, m_spec.nchannels, OIIO::TypeDesc::FLOAT, out);
        return m_input->read_tiles(0, 0, m_spec.x, m_spec.x + m_spec.width, first, last, 0, 1, 0, m_spec.nchannels,
                                   OIIO::TypeDesc::FLOAT, out);
    }

    /// Copies a row of the file to its place in the picture, which is transparent black elsewhere.
    void place(const float* in) {
        m_row.assign(static_cast<std::size_t>(m_width) * 4, 0.0f);
        const int left = m_spec.x - m_spec.full_x;
        for (int x = std::max(0, -left); x < m_spec.width && left + x < m_width; ++x)
            convert(in + static_cast<std::ptrdiff_t>(x) * m_spec.nchannels,
                    &m_row[static_cast<std::size_t>(left + x) * 4]);
    }

    void convert(const float* in, float* out) {
        const bool premultiplied = m_header.format == PictureFormat::exr;
        const float alpha = m_channels.alpha < 0 ? 1 : in[m_channels.alpha];
        const float divisor = premultiplied && alpha > 0 ? alpha : 1;
        for (int i = 0; i < 3; ++i) out[i] = in[m_channels.color[i]] / divisor;
        out[3] = alpha;
        if (!std::all_of(out, out + 4, [](float value) { return std::isfinite(value); }))
            throw AssetError("the picture has pixels that are not finite numbers");
        m_clamped |= alpha > 1 || std::any_of(out, out + 4, [](float value) { return value < 0; });
    }

    OIIO::Filesystem::IOMemReader m_memory;
    PictureHeader m_header;
    std::unique_ptr<OIIO::ImageInput> m_input;
    OIIO::ImageSpec m_spec;
    int m_width = 0, m_height = 0;  ///< of the rows that are passed on
    ChannelMap m_channels{};
    std::vector<float> m_row;
    bool m_clamped = false;
};

/// The picture turned according to its EXIF orientation.
Image turned(Image stored, int orientation) {
    if (orientation == 1) return stored;
    const int width = stored.width_px, height = stored.height_px;
    const bool transposed = orientation >= 5;
    Image seen(transposed ? height : width, transposed ? width : height);
    for (int y = 0; y < seen.height_px; ++y) {
        for (int x = 0; x < seen.width_px; ++x) {
            int from_x = transposed ? y : x, from_y = transposed ? x : y;
            if (orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8)
                from_x = width - 1 - from_x;
            if (orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7)
                from_y = height - 1 - from_y;
            std::copy_n(stored.pixel(from_x, from_y), 4, seen.pixel(x, y));
        }
    }
    return seen;
}

}  // namespace

PictureFacts decode_picture(std::string_view bytes, const RowFunction& row) {
    Decoder decoder(bytes, read_picture_header(bytes));
    decoder.read(row);
    return decoder.facts();
}

Picture read_picture(std::string_view bytes, int width_px, int height_px) {
    const PictureHeader header = read_picture_header(bytes);
    const bool transposed = is_transposed(header);
    std::pair stored(header.width_px, header.height_px), target(width_px, height_px);
    for (auto* size : {&stored, &target})
        if (transposed) std::swap(size->first, size->second);
    Scaler scaler(stored.first, stored.second, target.first, target.second);
    Decoder decoder(bytes, header);
    decoder.read([&](int y, const float* rgba) { scaler.add_row(y, rgba); });
    const PictureFacts facts = decoder.facts();
    Picture picture{turned(scaler.finish(), header.orientation), facts.eight_bit, facts.notes};
    // Interpolation overshoots at edges, and values beyond the range of 16-bit floats would become infinite on the
    // device.
    const float greatest = facts.eight_bit ? 1.0f : max_half;
    for (float& value : picture.image.rgba) value = std::min(value, greatest);
    return picture;
}

}  // namespace sheer
