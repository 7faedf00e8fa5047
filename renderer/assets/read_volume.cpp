#include "renderer/assets/read_volume.h"

#include <fmt/format.h>
#define ZLIB_CONST  // input is const
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "renderer/assets/nrrd_header.h"

namespace sheer {

namespace {

/// Inflates a gzip stream that must hold `size` bytes, neither more nor fewer, so that no more memory is ever taken.
class Inflater {
  public:
    explicit Inflater(std::string_view bytes) : m_bytes(bytes) {
        if (inflateInit2(&m_stream, gzip_window) != Z_OK) throw AssetError("the gzip data cannot be read");
    }
    ~Inflater() { inflateEnd(&m_stream); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    std::string inflated(std::size_t size) {
        std::string result(size, '\0');
        std::size_t done = 0;
        int status = step(result.data(), size, done);
        char beyond = 0;
        std::size_t more = 0;
        if (status == Z_OK && done == size) status = step(&beyond, 1, more);
        if (status == Z_DATA_ERROR) throw AssetError("the gzip data is damaged");
        if (more > 0 || m_stream.avail_in + m_bytes.size() > 0)
            throw AssetError(fmt::format("the gzip data holds more than the {} bytes that the sizes say", size));
        if (status != Z_STREAM_END) throw AssetError("the gzip data ends too early");
        if (done < size)
            throw AssetError(fmt::format("the gzip data holds {} bytes of voxels; the sizes say {}", done, size));
        return result;
    }

  private:
    static constexpr int gzip_window = 16 + MAX_WBITS;

    /// Until `size` bytes are there, the stream has ended, or it cannot go on.
    int step(char* out, std::size_t size, std::size_t& done) {
        m_stream.next_out = reinterpret_cast<Bytef*>(out);
        m_stream.avail_out = static_cast<uInt>(size);
        int status = Z_OK;
        while (status == Z_OK && m_stream.avail_out > 0) {
            if (m_stream.avail_in == 0) {
                const std::size_t part = std::min<std::size_t>(m_bytes.size(), 1 << 20);
                m_stream.next_in = reinterpret_cast<const Bytef*>(m_bytes.data());
                m_stream.avail_in = static_cast<uInt>(part);
                m_bytes.remove_prefix(part);
            }
            status = inflate(&m_stream, Z_NO_FLUSH);
        }
        done = size - m_stream.avail_out;
        return status;
    }

    std::string_view m_bytes;
    z_stream m_stream{};
};

template <typename Number>
std::vector<float> numbers_in(std::string_view bytes, bool big_endian) {
    const bool swapped = big_endian != (std::endian::native == std::endian::big);
    std::vector<float> numbers(bytes.size() / sizeof(Number));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        char voxel[sizeof(Number)];
        std::memcpy(voxel, bytes.data() + i * sizeof(Number), sizeof(Number));
        if (swapped) std::reverse(std::begin(voxel), std::end(voxel));
        Number number;
        std::memcpy(&number, voxel, sizeof(Number));
        numbers[i] = static_cast<float>(number);
    }
    return numbers;
}

/// The least becomes 0, the greatest 1.
void stretch(std::vector<float>& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (!std::isfinite(numbers[i]))
            throw AssetError(fmt::format("voxel {} of the volume is not a finite number", i));
    const auto [least, greatest] = std::ranges::minmax(numbers);
    const double span = double{greatest} - least;
    for (float& number : numbers) number = span > 0 ? static_cast<float>((double{number} - least) / span) : 0.0f;
}

Volume make_volume(const VoxelLayout& layout, std::string_view bytes) {
    Volume volume{.size = layout.size, .spacing = layout.spacing};
    switch (layout.type) {
        case VoxelType::uint8:
            volume.bytes.assign(bytes.begin(), bytes.end());
            break;
        case VoxelType::uint16:
            volume.floats = numbers_in<std::uint16_t>(bytes, layout.big_endian);
            for (float& number : volume.floats) number /= 65535;
            break;
        case VoxelType::int16:
            volume.floats = numbers_in<std::int16_t>(bytes, layout.big_endian);
            stretch(volume.floats);
            break;
        case VoxelType::float32:
            volume.floats = numbers_in<float>(bytes, layout.big_endian);
            stretch(volume.floats);
            break;
    }
    return volume;
}

Volume read_voxels(const VoxelLayout& layout, std::string_view bytes) {
    const std::size_t size = Volume{.size = layout.size}.voxel_count() * bytes_of(layout.type);
    if (layout.gzip) return make_volume(layout, Inflater(bytes).inflated(size));
    if (bytes.size() != size)
        throw AssetError(fmt::format("the file holds {} bytes of voxels; {} x {} x {} of type {} are {}", bytes.size(),
                                     layout.size.x, layout.size.y, layout.size.z, name_of(layout.type), size));
    return make_volume(layout, bytes);
}

VoxelLayout layout_of(const RawVolume& raw) {
    VoxelLayout layout{.size = raw.size, .spacing = raw.spacing};
    for (const VoxelType type : {VoxelType::uint8, VoxelType::uint16, VoxelType::float32})
        if (raw.voxel == name_of(type)) layout.type = type;
    check_volume_size(layout.size, layout.type);
    return layout;
}

}  // namespace

Volume read_volume(std::string_view bytes, const std::optional<RawVolume>& raw) {
    if (raw) return read_voxels(layout_of(*raw), bytes);
    if (!is_nrrd(bytes))
        throw AssetError("the file is not an NRRD file; for another one \"raw\" must say what it holds");
    const NrrdHeader header = read_nrrd_header(bytes);
    return read_voxels(header.layout, bytes.substr(header.data_begin));
}

nlohmann::json describe_nrrd(std::string_view bytes) {
    const VoxelLayout layout = read_nrrd_header(bytes).layout;
    const Volume volume = read_volume(bytes, std::nullopt);
    return {{"size", {layout.size.x, layout.size.y, layout.size.z}},
            {"spacing", {layout.spacing.x, layout.spacing.y, layout.spacing.z}},
            {"voxel", name_of(layout.type)},
            {"encoding", layout.gzip ? "gzip" : "raw"},
            {"notes", to_json(volume.notes)}};
}

}  // namespace sheer
