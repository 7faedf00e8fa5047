#include <fmt/format.h>
#define ZLIB_CONST  // input is const
#include <zlib.h>

#include <algorithm>
#include <array>
#include <optional>

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/picture_header_parts.h"

namespace sheer {

namespace {

constexpr std::size_t png_signature_bytes = 8;

[[noreturn]] void refuse_png(const std::string& why) {
    throw AssetError("the PNG cannot be decoded: " + why);
}

/// Counts what the IDAT chunks inflate to. libpng fills rows with zeros and accepts a wrong checksum.
class PngData {
  public:
    /// `expected`: bytes of all rows with their filters.
    explicit PngData(std::uint64_t expected) : m_expected(expected) {
        if (inflateInit(&m_stream) != Z_OK) refuse_png("zlib does not start");
    }
    ~PngData() { inflateEnd(&m_stream); }
    PngData(const PngData&) = delete;
    PngData& operator=(const PngData&) = delete;

    void add(std::string_view chunk) {
        m_stream.next_in = reinterpret_cast<const Bytef*>(chunk.data());
        m_stream.avail_in = static_cast<uInt>(chunk.size());
        while (m_status == Z_OK && m_found <= m_expected) {
            m_stream.next_out = m_part.data();
            m_stream.avail_out = static_cast<uInt>(m_part.size());
            m_status = inflate(&m_stream, Z_NO_FLUSH);
            m_found += m_part.size() - m_stream.avail_out;
            if (m_status != Z_OK && m_status != Z_STREAM_END && m_status != Z_BUF_ERROR)
                refuse_png("its image data is damaged");
            if (m_stream.avail_out > 0) break;
        }
        if (m_status == Z_BUF_ERROR) m_status = Z_OK;
        m_left_over |= m_stream.avail_in > 0;
    }

    /// Returns whether there is more data than the rows need.
    bool finish() const {
        if (m_found < m_expected || (m_status != Z_STREAM_END && m_found == m_expected))
            refuse_png("its image data ends too early");
        return m_found > m_expected || m_left_over;
    }

  private:
    std::uint64_t m_expected, m_found = 0;
    int m_status = Z_OK;
    bool m_left_over = false;
    std::array<Bytef, 1 << 16> m_part;
    z_stream m_stream{};
};

class PngHeaderReader {
  public:
    explicit PngHeaderReader(std::string_view bytes) : m_bytes(bytes), m_reader(bytes, png_signature_bytes) {}

    PictureHeader read() {
        read_size(chunk("IHDR"));
        while (m_name != "IEND") use(chunk());
        if (!m_data) refuse_png("it has no image data");
        if (m_data->finish())
            add_note(m_header.notes, {"image-data-ignored", "The PNG has more image data than its size needs.", ""});
        note_colors();
        note_trailing_bytes(m_header, m_reader.left());
        set_orientation(m_header, m_orientation);
        return m_header;
    }

  private:
    std::string_view chunk(std::string_view wanted = "") {
        const std::uint32_t length = m_reader.u32_big();
        const std::size_t begin = m_reader.position();
        m_name = m_reader.take(4);
        const std::string_view data = m_reader.take(length);
        if (!wanted.empty() && m_name != wanted) throw AssetError("the PNG does not begin with a header");
        const std::string_view checked = m_bytes.substr(begin, std::size_t{length} + 4);
        const auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(checked.data()), checked.size());
        if (sum != m_reader.u32_big())
            refuse_png(fmt::format("the checksum of its chunk at byte {} is wrong", begin - 4));
        return data;
    }

    void read_size(std::string_view data) {
        if (data.size() != 13) throw AssetError("the PNG does not begin with a header");
        ByteReader reader(data);
        const std::uint32_t width = reader.u32_big(), height = reader.u32_big();
        check_picture_size(PictureFormat::png, width, height);
        m_header = {
            .format = PictureFormat::png, .width_px = static_cast<int>(width), .height_px = static_cast<int>(height)};
        const int depth = reader.u8(), type = reader.u8();
        reader.skip(2);
        const bool interlaced = reader.u8() != 0;
        constexpr int channels_of[] = {1, 0, 3, 1, 2, 0, 4};
        const int channels = type < 7 ? channels_of[type] : 0;
        if (channels == 0 || depth > 16) refuse_png("PNG has no such pixel format");
        m_data.emplace(interlaced ? interlaced_bytes(channels * depth) : bytes_of(width, height, channels * depth));
    }

    static std::uint64_t bytes_of(std::uint64_t width, std::uint64_t height, int bits) {
        return width == 0 ? 0 : height * (1 + (width * static_cast<std::uint64_t>(bits) + 7) / 8);
    }

    /// Adam7: the beginning and the steps of each pass, along x and y.
    std::uint64_t interlaced_bytes(int bits) const {
        constexpr int passes[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                      {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
        std::uint64_t bytes = 0;
        for (const auto& [x, y, step_x, step_y] : passes) {
            const auto share = [](int side, int begin, int step) {
                return static_cast<std::uint64_t>(std::max(0, (side - begin + step - 1) / step));
            };
            bytes += bytes_of(share(m_header.width_px, x, step_x), share(m_header.height_px, y, step_y), bits);
        }
        return bytes;
    }

    void use(std::string_view data) {
        ByteReader reader(data);
        if (m_name == "IDAT") m_data->add(data);
        if (m_name == "eXIf") m_orientation = exif_orientation(data);
        if (m_name == "sRGB") m_srgb = true;
        if (m_name == "iCCP") m_profiled = true;
        if (m_name == "gAMA") m_gamma = reader.u32_big();
        if (m_name == "cHRM") {
            // White comes first here.
            for (const std::size_t i : {6, 7, 0, 1, 2, 3, 4, 5})
                m_chromaticities.emplace(m_chromaticities.value_or(Chromaticities{})).xy[i] = reader.u32_big() / 1e5;
        }
        if (m_name == "acTL")
            add_note(m_header.notes,
                     {"animation-ignored", "The PNG is animated; only its default picture is read.", ""});
    }

    /// A profile or sRGB overrides the older chunks (clause 11.3.2). Profiles are noted where they are read.
    void note_colors() {
        if (m_srgb || m_profiled) return;
        if (m_chromaticities) note_chromaticities(m_header, *m_chromaticities);
        constexpr std::uint32_t usual = 45455, tolerance = 1000;
        if (m_gamma && (*m_gamma < usual - tolerance || *m_gamma > usual + tolerance))
            add_note(m_header.notes, {"gamma-ignored",
                                      fmt::format("The PNG is encoded with a gamma of {:.5g}, not that of sRGB; its "
                                                  "values are used as they are.",
                                                  *m_gamma / 1e5),
                                      ""});
    }

    std::string_view m_bytes;
    ByteReader m_reader;
    std::string_view m_name;
    PictureHeader m_header;
    std::optional<PngData> m_data;
    int m_orientation = 1;
    bool m_srgb = false, m_profiled = false;
    std::optional<std::uint32_t> m_gamma;
    std::optional<Chromaticities> m_chromaticities;
};

}  // namespace

PictureHeader read_png_header(std::string_view bytes) {
    return PngHeaderReader(bytes).read();
}

}  // namespace sheer
