#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/picture_header_parts.h"

namespace sheer {

namespace {

using namespace std::string_view_literals;

/// Markers' second bytes (T.81, table B.1).
constexpr int jpeg_end = 0xd9, jpeg_scan = 0xda, jpeg_app_1 = 0xe1;

bool is_frame(int marker) {
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

/// The next marker; entropy-coded data, stuffed zeros and restart markers before it are skipped.
int next_marker(ByteReader& reader) {
    while (true) {
        reader.take_to('\xff');
        int marker = reader.u8();
        while (marker == 0xff) marker = reader.u8();
        const bool within_data = marker == 0 || (marker >= 0xd0 && marker <= 0xd7);
        if (!within_data) return marker;
    }
}

/// What the scans still have to provide for a component: the missing bits of each coefficient.
struct JpegComponent {
    static constexpr int unknown = 99;
    int id;
    std::array<int, 64> missing_bits;
};

class JpegHeaderReader {
  public:
    explicit JpegHeaderReader(std::string_view bytes) : m_reader(bytes, 2) {}

    PictureHeader read() {
        int orientation = 1;
        for (int marker = next_marker(m_reader); marker != jpeg_end; marker = next_marker(m_reader)) {
            const std::size_t length = m_reader.u16_big();
            if (length < 2) throw AssetError("the JPEG has a segment without a length");
            const std::string_view segment = m_reader.take(length - 2);
            if (is_frame(marker)) read_frame(marker, ByteReader(segment));
            if (marker == jpeg_scan) read_scan(ByteReader(segment));
            if (marker == jpeg_app_1 && segment.starts_with("Exif\0\0"sv))
                orientation = exif_orientation(segment.substr(6));
        }
        if (m_header.width_px == 0) throw AssetError("the JPEG has no frame header");
        for (const JpegComponent& component : m_components)
            if (std::ranges::any_of(component.missing_bits, [](int bits) { return bits > 0; }))
                throw AssetError("the JPEG ends too early: its scans do not hold all of the picture");
        note_trailing_bytes(m_header, m_reader.left());
        set_orientation(m_header, orientation);
        return m_header;
    }

  private:
    /// Annex B.2.2.
    void read_frame(int marker, ByteReader segment) {
        if (!m_components.empty()) throw AssetError("the JPEG has several frames; hierarchical ones are not supported");
        const int bits = segment.u8();
        const std::uint16_t height = segment.u16_big(), width = segment.u16_big();
        check_picture_size(PictureFormat::jpeg, width, height);
        m_header = {.format = PictureFormat::jpeg, .width_px = width, .height_px = height};
        // From 0xc8 on, the kinds of frames repeat for arithmetic coding.
        const int kind = (marker - 0xc0) % 8;
        if (kind > 2)
            throw AssetError("the JPEG is lossless or hierarchical; baseline and progressive ones are supported");
        if (bits != 8) throw AssetError(fmt::format("the JPEG has {} bits per channel; only 8 are supported", bits));
        m_progressive = kind == 2;
        const int components = segment.u8();
        if (components != 1 && components != 3)
            throw AssetError(
                fmt::format("the JPEG has {} components; grey and RGB are supported, CMYK is not", components));
        for (int i = 0; i < components; ++i) {
            m_components.push_back({segment.u8(), {}});
            m_components.back().missing_bits.fill(JpegComponent::unknown);
            segment.skip(2);
        }
    }

    /// Annexes B.2.3 and G.1.1: a scan of a progressive picture gives a range of coefficients, down to a certain bit.
    void read_scan(ByteReader segment) {
        std::vector<int> ids(segment.u8());
        for (int& id : ids) {
            id = segment.u8();
            segment.skip(1);
        }
        const int first = segment.u8(), last = segment.u8(), bits = segment.u8() & 15;
        for (JpegComponent& component : m_components) {
            if (std::ranges::find(ids, component.id) == ids.end()) continue;
            if (!m_progressive) component.missing_bits.fill(0);
            for (int i = first; m_progressive && i <= std::min(last, 63); ++i)
                component.missing_bits[static_cast<std::size_t>(i)] = bits;
        }
    }

    ByteReader m_reader;
    PictureHeader m_header;
    bool m_progressive = false;
    std::vector<JpegComponent> m_components;
};

}  // namespace

PictureHeader read_jpeg_header(std::string_view bytes) {
    return JpegHeaderReader(bytes).read();
}

}  // namespace sheer
