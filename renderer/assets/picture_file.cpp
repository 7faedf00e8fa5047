#include "renderer/assets/picture_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/assets/scaler.h"

namespace sheer {

namespace {

constexpr float max_half = 65504;

const char* reader_name(PictureFormat format) {
    if (format == PictureFormat::png) return "png";
    return format == PictureFormat::jpeg ? "jpeg" : "openexr";
}

/// Where the channels of RGBA stand in the file; grey stands for all three colours.
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
    Decoder(std::string_view bytes, const PictureHeader& header)
        : m_memory(bytes.data(), bytes.size()), m_header(header) {
        m_input = OIIO::ImageInput::create(reader_name(header.format));
        if (!m_input || !m_input->supports("ioproxy")) throw AssetError("pictures of this format cannot be read here");
        m_input->threads(1);
        m_input->set_ioproxy(&m_memory);
        OIIO::ImageSpec as_stored;
        as_stored["oiio:UnassociatedAlpha"] = 1;
        if (!m_input->open("picture", m_spec, as_stored)) fail();
        if (m_spec.width != header.width_px || m_spec.height != header.height_px || m_spec.depth > 1)
            throw AssetError("the picture's header and its data have different sizes");
        m_channels = map_channels(m_spec);
    }

    PictureFacts facts() const {
        return {m_header, (m_channels.grey ? 1 : 3) + (m_channels.alpha >= 0), m_spec.format.basesize() == 1};
    }

    void read(const RowFunction& row) {
        const int rows = m_spec.tile_height > 0 ? m_spec.tile_height : rows_at_a_time;
        const std::size_t row_values = static_cast<std::size_t>(m_spec.width) * m_spec.nchannels;
        std::vector<float> values(row_values * static_cast<std::size_t>(std::min(rows, m_spec.height)));
        std::vector<float> rgba(static_cast<std::size_t>(m_spec.width) * 4);
        for (int y = 0; y < m_spec.height; y += rows) {
            const int end = std::min(y + rows, m_spec.height);
            if (!read_rows(y, end, values.data())) fail();
            for (int i = y; i < end; ++i) {
                convert(&values[row_values * static_cast<std::size_t>(i - y)], rgba.data());
                row(i, rgba.data());
            }
        }
    }

  private:
    static constexpr int rows_at_a_time = 256;

    [[noreturn]] void fail() {
        const std::string why = m_input->geterror();
        throw AssetError(fmt::format("the {} cannot be decoded{}{}", name_of(m_header.format), why.empty() ? "" : ": ",
                                     why.substr(0, why.find('\n'))));
    }

    bool read_rows(int begin, int end, float* out) {
        const int first = m_spec.y + begin, last = m_spec.y + end;
        if (m_spec.tile_height == 0)
            return m_input->read_scanlines(0, 0, first, last, 0, 0, m_spec.nchannels, OIIO::TypeDesc::FLOAT, out);
        return m_input->read_tiles(0, 0, m_spec.x, m_spec.x + m_spec.width, first, last, 0, 1, 0, m_spec.nchannels,
                                   OIIO::TypeDesc::FLOAT, out);
    }

    void convert(const float* in, float* out) const {
        const bool premultiplied = m_header.format == PictureFormat::exr;
        for (int x = 0; x < m_spec.width; ++x, in += m_spec.nchannels, out += 4) {
            const float alpha = m_channels.alpha < 0 ? 1 : in[m_channels.alpha];
            const float divisor = premultiplied && alpha > 0 ? alpha : 1;
            for (int i = 0; i < 3; ++i) out[i] = in[m_channels.color[i]] / divisor;
            out[3] = alpha;
            if (!std::all_of(out, out + 4, [](float value) { return std::isfinite(value); }))
                throw AssetError("the picture has pixels that are not finite numbers");
        }
    }

    OIIO::Filesystem::IOMemReader m_memory;
    PictureHeader m_header;
    std::unique_ptr<OIIO::ImageInput> m_input;
    OIIO::ImageSpec m_spec;
    ChannelMap m_channels{};
};

}  // namespace

PictureFacts decode_picture(std::string_view bytes, const RowFunction& row) {
    Decoder decoder(bytes, read_picture_header(bytes));
    decoder.read(row);
    return decoder.facts();
}

Picture read_picture(std::string_view bytes, int width_px, int height_px) {
    const PictureHeader header = read_picture_header(bytes);
    Scaler scaler(header.width_px, header.height_px, width_px, height_px);
    const PictureFacts facts = decode_picture(bytes, [&](int y, const float* rgba) { scaler.add_row(y, rgba); });
    Picture picture{scaler.finish(), facts.eight_bit, facts.notes};
    // Interpolation overshoots at edges, and what a 16-bit float cannot hold would become infinite on the device.
    const float greatest = facts.eight_bit ? 1.0f : max_half;
    for (float& value : picture.image.rgba) value = std::min(value, greatest);
    return picture;
}

}  // namespace sheer
