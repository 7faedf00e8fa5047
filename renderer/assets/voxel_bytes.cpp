#include "renderer/assets/voxel_bytes.h"

#include <bzlib.h>
#include <fmt/format.h>
#define ZLIB_CONST  // input is const
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "renderer/assets/read_volume.h"
#include "renderer/assets/text_fields.h"
#include "renderer/assets/visit_voxels.h"

namespace sheer {

namespace {

constexpr std::string_view white_space = " \t\r\n\v\f";

/// Unpacks a stream that must hold exactly `size` bytes, so that no more memory is ever used. `Codec` is one of those
/// below; a stream may follow another one, as parallel packers write them.
template <typename Codec>
class Unpacker {
  public:
    explicit Unpacker(std::string_view bytes) : m_bytes(bytes) {}

    std::string unpacked(std::size_t size) {
        std::string result(size, '\0');
        std::size_t done = step(result.data(), size);
        while (done < size && m_codec.ended && !m_bytes.empty()) {
            m_codec.restart();
            done += step(result.data() + done, size - done);
        }
        char beyond = 0;
        const std::size_t more = done == size && !m_codec.ended ? step(&beyond, 1) : 0;
        if (more > 0 || (m_codec.ended && !m_bytes.empty()))
            throw AssetError(
                fmt::format("the {} data holds more than the {} bytes required by the sizes", Codec::name, size));
        if (!m_codec.ended) throw AssetError(fmt::format("the {} data ends too early", Codec::name));
        if (done < size)
            throw AssetError(
                fmt::format("the {} data holds {} bytes of voxels, but the sizes require {}", Codec::name, done, size));
        return result;
    }

  private:
    /// Unpacks until there are `size` bytes, the stream has ended, or it cannot continue. Returns the number of bytes.
    std::size_t step(char* out, std::size_t size) {
        std::size_t done = 0;
        while (!m_codec.ended && done < size) {
            const std::string_view in = m_bytes.substr(0, 1 << 20);
            const auto [taken, given] = m_codec.step(in, out + done, std::min<std::size_t>(size - done, 1 << 30));
            m_bytes.remove_prefix(taken);
            done += given;
            if (taken == 0 && given == 0) break;
        }
        return done;
    }

    std::string_view m_bytes;
    Codec m_codec;
};

/// Bytes consumed and produced.
using Step = std::pair<std::size_t, std::size_t>;

class GzipCodec {
  public:
    static constexpr const char* name = "gzip";
    GzipCodec() {
        if (inflateInit2(&m_stream, 16 + MAX_WBITS) != Z_OK) throw AssetError("the gzip data cannot be read");
    }
    ~GzipCodec() { inflateEnd(&m_stream); }
    GzipCodec(const GzipCodec&) = delete;
    GzipCodec& operator=(const GzipCodec&) = delete;

    void restart() {
        inflateReset(&m_stream);
        ended = false;
    }

    Step step(std::string_view in, char* out, std::size_t size) {
        m_stream.next_in = reinterpret_cast<const Bytef*>(in.data());
        m_stream.avail_in = static_cast<uInt>(in.size());
        m_stream.next_out = reinterpret_cast<Bytef*>(out);
        m_stream.avail_out = static_cast<uInt>(size);
        const int status = inflate(&m_stream, Z_NO_FLUSH);
        if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
            throw AssetError("the gzip data is damaged");
        ended = status == Z_STREAM_END;
        return {in.size() - m_stream.avail_in, size - m_stream.avail_out};
    }

    bool ended = false;

  private:
    z_stream m_stream{};
};

class Bzip2Codec {
  public:
    static constexpr const char* name = "bzip2";
    Bzip2Codec() { start(); }
    ~Bzip2Codec() { BZ2_bzDecompressEnd(&m_stream); }
    Bzip2Codec(const Bzip2Codec&) = delete;
    Bzip2Codec& operator=(const Bzip2Codec&) = delete;

    void restart() {
        BZ2_bzDecompressEnd(&m_stream);
        start();
    }

    Step step(std::string_view in, char* out, std::size_t size) {
        m_stream.next_in = const_cast<char*>(in.data());
        m_stream.avail_in = static_cast<unsigned>(in.size());
        m_stream.next_out = out;
        m_stream.avail_out = static_cast<unsigned>(size);
        const int status = BZ2_bzDecompress(&m_stream);
        if (status != BZ_OK && status != BZ_STREAM_END) throw AssetError("the bzip2 data is damaged");
        ended = status == BZ_STREAM_END;
        return {in.size() - m_stream.avail_in, size - m_stream.avail_out};
    }

    bool ended = false;

  private:
    void start() {
        ended = false;
        m_stream = {};
        if (BZ2_bzDecompressInit(&m_stream, 0, 0) != BZ_OK) throw AssetError("the bzip2 data cannot be read");
    }

    bz_stream m_stream{};
};

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string from_hex(std::string_view text, std::size_t size) {
    std::string bytes;
    bytes.reserve(std::min(size, text.size() / 2));
    int high = -1;
    for (const char c : text) {
        if (white_space.find(c) != std::string_view::npos) continue;
        const int digit = hex_digit(c);
        if (digit < 0)
            throw AssetError(fmt::format("the hex data holds \"{}\", which is not a digit", printable({&c, 1})));
        if (high >= 0) bytes += static_cast<char>(high << 4 | digit);
        high = high >= 0 ? -1 : digit;
    }
    if (high >= 0) throw AssetError("the hex data ends within a byte");
    return bytes;
}

/// Numbers in decimal, between white space or commas.
std::string from_text(const VoxelLayout& layout, std::string_view text, std::size_t count) {
    return visit_voxel_type(layout.type, [&]<typename Number>(Number) {
        using Parsed = std::conditional_t<std::is_floating_point_v<Number>, double, std::int64_t>;
        constexpr std::string_view separators = " \t\r\n\v\f,";
        std::string bytes;
        bytes.reserve(std::min(count, text.size()) * sizeof(Number));
        std::size_t begin = text.find_first_not_of(separators), found = 0;
        for (; begin != std::string_view::npos; begin = text.find_first_not_of(separators, begin)) {
            const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
            const std::string_view word = text.substr(begin, end - begin);
            Parsed parsed{};
            const bool fits = read_number(word, parsed) && (std::is_floating_point_v<Number> ||
                                                            static_cast<Parsed>(static_cast<Number>(parsed)) == parsed);
            if (!fits)
                throw AssetError(fmt::format("the text holds \"{}\", which is not of type {}", printable(word),
                                             kind_of(layout.type).name));
            if (++found > count) throw AssetError(fmt::format("the text holds more than {} voxels", count));
            append_little_endian(bytes, static_cast<Number>(parsed));
            begin = end;
        }
        if (found < count)
            throw AssetError(fmt::format("the text holds {} voxels, but the sizes require {}", found, count));
        return bytes;
    });
}

std::string_view without_first(std::string_view data, std::size_t count) {
    if (count > data.size()) throw AssetError("the NRRD field \"byte skip\" leaves too few bytes for the voxels");
    return data.substr(count);
}

}  // namespace

std::string voxel_bytes(const VoxelLayout& layout, std::string_view data, int skip) {
    const std::size_t count = static_cast<std::size_t>(layout.size.x) * static_cast<std::size_t>(layout.size.y) *
                              static_cast<std::size_t>(layout.size.z),
                      size = count * kind_of(layout.type).bytes;
    const auto skipped = static_cast<std::size_t>(std::max(skip, 0));
    std::string bytes;
    switch (layout.encoding) {
        case VoxelEncoding::gzip:
        case VoxelEncoding::bzip2:
            if (skipped > max_volume_bytes) throw AssetError("the NRRD field \"byte skip\" skips too much");
            bytes = layout.encoding == VoxelEncoding::gzip ? Unpacker<GzipCodec>(data).unpacked(skipped + size)
                                                           : Unpacker<Bzip2Codec>(data).unpacked(skipped + size);
            return bytes.erase(0, skipped);
        case VoxelEncoding::text:
            return from_text(layout, without_first(data, skipped), count);
        case VoxelEncoding::hex:
            bytes = from_hex(without_first(data, skipped), size);
            break;
        case VoxelEncoding::raw:
            if (skip < 0 && data.size() > size) data.remove_prefix(data.size() - size);
            bytes = without_first(data, skipped);
            break;
    }
    if (bytes.size() != size)
        throw AssetError(fmt::format("the file holds {} bytes of voxels, but {} x {} x {} of type {} are {}",
                                     bytes.size(), layout.size.x, layout.size.y, layout.size.z,
                                     kind_of(layout.type).name, size));
    return bytes;
}

}  // namespace sheer
