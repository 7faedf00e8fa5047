#include "renderer/assets/read_volume.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "renderer/assets/nrrd_header.h"
#include "renderer/assets/text_fields.h"
#include "renderer/assets/visit_voxels.h"
#include "renderer/assets/voxel_bytes.h"

namespace sheer {

namespace {

/// Values far outside of a range are clamped to this, so that later sums do not overflow.
constexpr double farthest = 1e6;

/// Voxels in the order of the file.
struct StoredVoxels {
    VoxelLayout layout;
    std::string bytes;
    std::vector<Note> notes;
};

/// The least and the greatest. Throws AssetError for a number that is not finite.
glm::dvec2 extent_of(const StoredVoxels& stored) {
    return visit_voxel_type(stored.layout.type, [&]<typename Number>(Number) {
        Number least = std::numeric_limits<Number>::max(), greatest = std::numeric_limits<Number>::lowest();
        for (std::size_t at = 0; at < stored.bytes.size(); at += sizeof(Number)) {
            const auto number = voxel_at<Number>(&stored.bytes[at], stored.layout.big_endian);
            if constexpr (std::is_floating_point_v<Number>)
                if (!std::isfinite(number))
                    throw AssetError(fmt::format("voxel {} of the volume is not a finite number", at / sizeof(Number)));
            least = std::min(least, number);
            greatest = std::max(greatest, number);
        }
        return glm::dvec2(least, greatest);
    });
}

/// Calls `put` with each voxel's place in the scene's order and its number.
template <typename Number, typename Put>
void for_each_voxel(const StoredVoxels& stored, const glm::ivec3& scene_size, const Put& put) {
    const std::ptrdiff_t strides[3] = {1, scene_size.x, std::ptrdiff_t{scene_size.x} * scene_size.y};
    std::ptrdiff_t steps[3], begin = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const VoxelAxis& lies = stored.layout.axes[static_cast<std::size_t>(axis)];
        steps[axis] = strides[lies.scene_axis] * (lies.reversed ? -1 : 1);
        if (lies.reversed) begin -= steps[axis] * (stored.layout.size[axis] - 1);
    }
    const char* at = stored.bytes.data();
    for (int k = 0; k < stored.layout.size.z; ++k)
        for (int j = 0; j < stored.layout.size.y; ++j)
            for (int i = 0; i < stored.layout.size.x; ++i, at += sizeof(Number))
                put(static_cast<std::size_t>(begin + i * steps[0] + j * steps[1] + k * steps[2]),
                    voxel_at<Number>(at, stored.layout.big_endian));
}

/// What the values of the file become, as a note.
Note range_note(const glm::dvec2& extent, const std::optional<glm::dvec2>& range) {
    if (range)
        return {"value-range",
                fmt::format("Values from {} to {} become 0 to 1, as set by the field range; the file has {} to {}.",
                            range->x, range->y, extent.x, extent.y),
                ""};
    if (extent.x == extent.y) return {"value-range", fmt::format("All voxels are {}; they become 0.", extent.x), ""};
    return {
        "value-range",
        fmt::format("Values from {} to {}, the least and the greatest of the file, become 0 to 1.", extent.x, extent.y),
        ""};
}

Volume make_volume(StoredVoxels stored, const std::optional<glm::dvec2>& wanted) {
    const glm::dvec2 extent = extent_of(stored);
    // If all are equal any width will do, because they become 0.
    const glm::dvec2 range = wanted.value_or(
        extent.x < extent.y ? extent : glm::dvec2(extent.x, extent.x + std::max(1.0, std::abs(extent.x))));
    Volume volume;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int scene_axis = stored.layout.axes[axis].scene_axis;
        volume.size[scene_axis] = stored.layout.size[static_cast<int>(axis)];
        volume.spacing[scene_axis] = stored.layout.spacing[static_cast<int>(axis)];
    }
    volume.notes = std::move(stored.notes);
    add_note(volume.notes, range_note(extent, wanted));
    if (stored.layout.type == VoxelType::uint8) {
        volume.byte_range = range;
        volume.bytes.resize(volume.voxel_count());
        for_each_voxel<std::uint8_t>(stored, volume.size,
                                     [&](std::size_t place, std::uint8_t byte) { volume.bytes[place] = byte; });
        return volume;
    }
    volume.floats.resize(volume.voxel_count());
    // Halved, since the span may overflow a double.
    const double half_span = range.y / 2 - range.x / 2;
    visit_voxel_type(stored.layout.type, [&]<typename Number>(Number) {
        for_each_voxel<Number>(stored, volume.size, [&](std::size_t place, Number number) {
            volume.floats[place] = static_cast<float>(
                std::clamp((static_cast<double>(number) / 2 - range.x / 2) / half_span, -farthest, farthest));
        });
    });
    return volume;
}

VoxelLayout layout_of(const RawVolume& raw) {
    VoxelLayout layout{.size = raw.size, .spacing = raw.spacing, .big_endian = raw.big_endian};
    for (const VoxelKind& kind : voxel_kinds)
        if (raw.voxel == kind.name) layout.type = kind.type;
    check_volume_size(layout.size, layout.type);
    return layout;
}

std::string_view without_lines(std::string_view data, int count) {
    for (; count > 0; --count) {
        const std::size_t end = data.find('\n');
        if (end == std::string_view::npos) throw AssetError("the NRRD field \"line skip\" skips all the lines");
        data.remove_prefix(end + 1);
    }
    return data;
}

/// For a detached header. Throws AssetError.
std::string data_file_of(const NrrdHeader& header, const DataFiles& data_files) {
    constexpr std::string_view what = "the NRRD file keeps its data in another file";
    if (!data_files)
        throw AssetError(
            fmt::format("{}, \"{}\"; upload one with the data attached", what, printable(header.data_file)));
    try {
        return data_files(header.data_file);
    } catch (const AssetError& error) {
        throw AssetError(fmt::format("{}: {}", what, error.what()));
    }
}

StoredVoxels read_nrrd(std::string_view bytes, const DataFiles& data_files) {
    NrrdHeader header = read_nrrd_header(bytes);
    const std::string other = header.data_file.empty() ? "" : data_file_of(header, data_files);
    const std::string_view data = header.data_file.empty() ? bytes.substr(header.data_begin) : other;
    return {header.layout, voxel_bytes(header.layout, without_lines(data, header.line_skip), header.byte_skip),
            std::move(header.notes)};
}

}  // namespace

Volume read_volume(std::string_view bytes, const VolumeOptions& options, const DataFiles& data_files) {
    if (options.raw) {
        const VoxelLayout layout = layout_of(*options.raw);
        return make_volume({layout, voxel_bytes(layout, bytes, 0), {}}, options.range);
    }
    if (!is_nrrd(bytes))
        throw AssetError("the file is not an NRRD file; for other files, \"raw\" must describe the contents");
    return make_volume(read_nrrd(bytes, data_files), options.range);
}

nlohmann::json describe_nrrd(std::string_view bytes) {
    const StoredVoxels stored = read_nrrd(bytes, {});
    const VoxelLayout& layout = stored.layout;
    const glm::dvec2 extent = extent_of(stored);
    constexpr const char* encodings[] = {"raw", "ascii", "hex", "gzip", "bzip2"};
    return {{"size", {layout.size.x, layout.size.y, layout.size.z}},
            {"spacing", {layout.spacing.x, layout.spacing.y, layout.spacing.z}},
            {"voxel", kind_of(layout.type).name},
            {"encoding", encodings[static_cast<std::size_t>(layout.encoding)]},
            {"range", {extent.x, extent.y}},
            {"notes", to_json(stored.notes)}};
}

}  // namespace sheer
