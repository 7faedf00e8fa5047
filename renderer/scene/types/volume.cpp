// A grid of scalars as slices that face the camera: the box of the volume cut by planes that are parallel to the
// picture. A transfer function gives each value a color and an opacity. Each slice has one depth and none cuts
// another, so drawing them in the order of their depths is exact. Vertices are in camera space, where the corners of a
// slice have the same z to the last bit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/scene/camera.h"
#include "renderer/scene/scene_info.h"
#include "renderer/scene/solids.h"

namespace sheer {

namespace {

using glm::dvec2;
using glm::dvec3;
using nlohmann::json;

constexpr const char* transfer_function = "transfer-function";  ///< the shading
constexpr double longest_side = 2;
constexpr dvec3 box_middle{0, 1.5, 0};
/// A path of this length has the opacity that the transfer function gives.
constexpr double reference_length = longest_side / 256;
constexpr int transfer_entries = 1024;
/// For shadings that know nothing of the volume, over the reference length.
constexpr double fog_alpha = 0.02;
constexpr double largest_side = 1024;

struct Box {
    dvec3 half_sides;
    dvec3 corner(unsigned i) const {
        return box_middle + half_sides * dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    }
};

/// Grows with the angle of `v` against x, from 0 to 4.
double turn_of(const dvec2& v) {
    const double sum = std::abs(v.x) + std::abs(v.y);
    if (sum == 0) return 0;
    const double x = v.x / sum;
    return v.y >= 0 ? 1 - x : 3 + x;
}

/// The corners, in camera space and in order, of the polygon in which the plane at this z cuts the box.
std::vector<dvec2> cut_box(const std::array<dvec3, 8>& corners, double z) {
    std::vector<dvec2> cut;
    for (unsigned from = 0; from < 8; ++from)
        for (const unsigned axis : {1u, 2u, 4u}) {
            const dvec3 &a = corners[from], &b = corners[from | axis];
            if ((from & axis) != 0 || (a.z < z) == (b.z < z)) continue;
            cut.emplace_back(glm::mix(a, b, (z - a.z) / (b.z - a.z)));
        }
    dvec2 middle(0);
    for (const dvec2& point : cut) middle += point / static_cast<double>(cut.size());
    std::ranges::sort(cut, {}, [&](const dvec2& point) { return turn_of(point - middle); });
    return cut;
}

/// `count` slices, each in the middle of its share of the box's depth. Returns the distance between them.
double add_slices(Geometry& geometry, const Box& box, const glm::dmat4& view, int count, double density) {
    std::array<dvec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i) corners[i] = dvec3(view * glm::dvec4(box.corner(i), 1));
    const auto [far, near] = std::ranges::minmax(corners, {}, &dvec3::z);
    const double distance = (near.z - far.z) / count, radius = glm::length(box.half_sides);
    const dvec2 middle(view * glm::dvec4(box_middle, 1));
    const double alpha = opacity_of(fog_alpha, density * distance / reference_length);
    for (int i = 0; i < count; ++i) {
        const double z = far.z + (i + 0.5) * distance;
        const auto primitive = static_cast<std::uint32_t>(geometry.primitives.size());
        const auto first_vertex = static_cast<std::uint32_t>(geometry.vertices.size());
        const dvec3 color = glm::mix(dvec3(0.35, 0.55, 0.95), dvec3(1.0, 0.75, 0.35), (i + 0.5) / count);
        const std::vector<dvec2> cut = cut_box(corners, z);
        for (const dvec2& at : cut) {
            const dvec2 uv = 0.5 + (at - middle) / (2 * radius);
            geometry.vertices.push_back({glm::vec3(dvec3(at, z)), glm::vec2(uv.x, 1 - uv.y),
                                         glm::vec4(glm::vec3(color), static_cast<float>(alpha)), primitive});
        }
        geometry.primitives.push_back({static_cast<std::uint32_t>(geometry.indices.size()), 0, 0, false});
        for (std::uint32_t corner = 2; corner < cut.size(); ++corner) {
            for (const std::uint32_t offset : {0u, corner - 1, corner})
                geometry.indices.push_back(first_vertex + offset);
            geometry.primitives.back().index_count += 3;
        }
    }
    return distance;
}

/// A plinth whose top reaches into the box, and a ring with four pins that hold its contents: opaque objects in front
/// of the volume, within it and behind it.
void add_frame(Geometry& geometry, const Box& box) {
    const auto paint = [](const dvec3& color) -> Shade {
        return [color](const dvec3&, const dvec3& normal) { return daylight(color, normal); };
    };
    const dvec3 half = box.half_sides;
    const double width = std::min(half.x, half.z), bottom = box_middle.y - half.y;
    const auto disc = [&](double from, double to, double from_radius, double to_radius) {
        add_limb(geometry, {0, from, 0}, {0, to, 0}, from_radius * width, to_radius * width, paint({0.30, 0.34, 0.40}));
    };
    disc(bottom - 0.22, bottom - 0.15, 0.74, 0.74);
    disc(bottom - 0.15, bottom - 0.04, 0.56, 0.46);
    disc(bottom - 0.04, bottom + 0.05, 0.62, 0.62);
    const auto on_ring = [&](const dvec2& around, double out) {
        return box_middle + half * dvec3(1.1 * out * around.x, 0.47 - 0.06 * around.y, out * around.y);
    };
    const std::vector<dvec2> around = circle(64);
    for (std::size_t i = 0; i < around.size(); ++i) {
        const dvec3 from = on_ring(around[i], 1), to = on_ring(around[(i + 1) % around.size()], 1);
        add_limb(geometry, from, to, 0.028, 0.028, paint({0.50, 0.53, 0.58}));
    }
    for (std::size_t i = 8; i < around.size(); i += 16)
        add_limb(geometry, on_ring(around[i], 1.07), on_ring(around[i], 0.62), 0.026, 0.012, paint({0.80, 0.62, 0.26}));
}

glm::vec4 look_up(const json& points, double value) {
    const auto color_of = [](const json& point) {
        const auto color = point.at("color").get<std::array<double, 3>>();
        return glm::dvec4(color[0], color[1], color[2], point.at("alpha").get<double>());
    };
    const auto next = std::ranges::find_if(points, [&](const json& point) { return point.at("value") >= value; });
    if (next == points.end()) return glm::vec4(color_of(points.back()));
    if (next == points.begin()) return glm::vec4(color_of(points.front()));
    const json& last = *(next - 1);
    const double from = last.at("value"), to = next->at("value");
    return glm::vec4(glm::mix(color_of(last), color_of(*next), (value - from) / (to - from)));
}

std::vector<glm::vec4> bake(const json& points, double length) {
    std::vector<glm::vec4> baked;
    for (int i = 0; i < transfer_entries; ++i) {
        glm::vec4 entry = look_up(points, static_cast<double>(i) / (transfer_entries - 1));
        entry.a = static_cast<float>(opacity_of(entry.a, length));
        baked.push_back(entry);
    }
    return baked;
}

VolumeOptions options_of(const json& volume) {
    VolumeOptions options;
    if (const json& range = volume.at("range"); !range.is_null()) options.range = glm::dvec2(range[0], range[1]);
    const json& raw = volume.at("raw");
    if (raw.is_null()) return options;
    const auto sides = raw.at("size").get<std::array<double, 3>>();
    const auto spacing = raw.at("spacing").get<std::array<double, 3>>();
    options.raw = RawVolume{glm::ivec3(sides[0], sides[1], sides[2]),
                            {spacing[0], spacing[1], spacing[2]},
                            raw.at("voxel").get<std::string>(),
                            raw.at("endian") == "big"};
    return options;
}

Volume read_volume(const json& volume, AssetReader& assets) {
    const auto data = volume.at("data").get<std::string>();
    if (data == "head") return make_head(volume.at("resolution").get<int>());
    return assets.volume(data, options_of(volume));
}

/// Factor and offset from a texture's 0..1 to values.
glm::vec2 value_of_texture(const Volume& volume) {
    if (volume.bytes.empty()) return {1, 0};
    const double span = volume.byte_range.y - volume.byte_range.x;
    return glm::vec2(255 / span, volume.byte_range.x == 0 ? 0 : -volume.byte_range.x / span);
}

Geometry build_volume(const json& scene, const ImageSpec& image, AssetReader& assets) {
    const double aspect = static_cast<double>(image.width_px) / image.height_px;
    const auto density = scene.at("density").get<double>();
    Volume volume = read_volume(scene.at("volume"), assets);
    const Box box{volume.sides() * (longest_side / 2)};
    Geometry geometry;
    add_notes_of(geometry.notes, volume.notes, "/scene/volume");
    if (scene.at("frame").get<bool>()) add_frame(geometry, box);
    std::vector<Vertex> whole = geometry.vertices;
    for (unsigned i = 0; i < 8; ++i) whole.push_back({glm::vec3(box.corner(i)), {}, {}, 0});
    const Sphere bounds = bounding_sphere(whole);
    const Camera camera = read_camera(scene.at("camera"), bounds, {-0.55, 0.24, 1}, aspect);
    const glm::dmat4 view = camera.view();
    for (Vertex& vertex : geometry.vertices)
        vertex.position = glm::vec3(view * glm::dvec4(glm::dvec3(vertex.position), 1));
    const double distance = add_slices(geometry, box, view, scene.at("slices").get<int>(), density);
    look_from_camera_space(geometry, camera, aspect);
    geometry.parallel = true;

    glm::dmat4 to_texture(1);
    for (int axis = 0; axis < 3; ++axis) {
        to_texture[axis][axis] = 0.5 / box.half_sides[axis];
        to_texture[3][axis] = 0.5 - box_middle[axis] * to_texture[axis][axis];
    }
    const glm::vec2 value = value_of_texture(volume);
    geometry.volume = VolumeShading{
        .volume = std::move(volume),
        .to_texture = glm::mat4(to_texture * glm::inverse(view)),
        .value = value,
        .transfer = bake(scene.at("transfer"), density * distance / reference_length),
        .light = scene.at("light").get<bool>(),
        .to_sun = glm::vec3(glm::normalize(dvec3(view * glm::dvec4(-0.5, 0.8, 0.55, 0)))),
    };
    return geometry;
}

/// Fields that already have an error are null here, or absent.
void check(const json& scene, const std::string& pointer, std::vector<FieldError>& errors) {
    check_camera(scene, pointer, errors);
    const json& points = scene.at("transfer");
    for (std::size_t i = 1; i < points.size(); ++i) {
        const json &last = points[i - 1].at("value"), &value = points[i].at("value");
        if (last.is_number() && value.is_number() && value <= last)
            errors.push_back({pointer + "/transfer/" + std::to_string(i) + "/value",
                              "must be greater than that of the previous point"});
    }
    const json &volume = scene.at("volume"), &range = volume.at("range");
    for (const std::string name : {"raw", "range"})
        if (volume.at("data") == "head" && !volume.at(name).is_null())
            errors.push_back({pointer + "/volume/" + name, "does not apply to the built-in head"});
    if (range.is_array() && range[1] <= range[0])
        errors.push_back({pointer + "/volume/range/1", "must be greater than the first"});
}

/// Translucent skin, a pink brain, clear flesh and an opaque skull: the materials of the built-in head.
json usual_transfer() {
    const auto point = [](double value, const std::array<double, 3>& color, double alpha) -> json {
        return {{"value", value}, {"color", color}, {"alpha", alpha}};
    };
    return {point(0.06, {0.95, 0.70, 0.56}, 0),    point(0.20, {0.95, 0.68, 0.54}, 0.11),
            point(0.27, {0.90, 0.58, 0.46}, 0),    point(0.30, {0.85, 0.45, 0.45}, 0),
            point(0.36, {0.88, 0.50, 0.48}, 0.06), point(0.42, {0.85, 0.50, 0.48}, 0),
            point(0.56, {0.90, 0.90, 0.90}, 0),    point(0.60, {0.90, 0.92, 0.95}, 0.02),
            point(0.66, {0.90, 0.82, 0.66}, 0.06), point(0.85, {0.94, 0.89, 0.76}, 0.75),
            point(1, {1, 1, 0.97}, 0.95)};
}

std::vector<Param> volume_parameters() {
    const std::vector<std::string> axes = {"x", "y", "z"};
    Param size = Param::numbers("size", "voxels along each axis; x is the fastest", "", {64, 64, 64}, 1, largest_side)
                     .of(axes)
                     .required();
    size.whole = true;
    Param raw = Param::object(
        "raw", "the contents of a file without a header; omit it for NRRD",
        {std::move(size),
         Param::choice("voxel", "type of the voxels", "uint8",
                       {"uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"}),
         Param::choice("endian", "which byte of a voxel comes first: the least or the greatest", "little",
                       {"little", "big"}),
         Param::numbers("spacing", "from voxel to voxel along each axis", "", {1, 1, 1}, 1e-6, 1e6).of(axes)});
    raw.optional = true;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Param range =
        Param::numbers("range", "values of the file that become 0 and 1; by default its least and its greatest", "",
                       {0, 1}, -infinity, infinity);
    range.optional = true;
    range.default_value = nullptr;
    Param transfer = Param::list(
        "transfer", "color and opacity by value, linear between the points",
        {Param::number("value", "of the volume", "", 0, 0, 1).required(),
         Param::color("color", "of the volume there", {1, 1, 1}).required(),
         Param::number("alpha", "opacity of a path as long as 1/256 of the volume's longest side", "", 0, 0, 1)
             .required()},
        1, 64);
    transfer.default_value = usual_transfer();
    return {
        Param::object("volume", "the scalars",
                      {Param::asset("data", "the head, or an NRRD or raw file", "volume", "head", {"head"}),
                       Param::integer("resolution", "of the head: voxels a side", "", 128, 32, 512), std::move(range),
                       std::move(raw)}),
        Param::integer("slices", "how many, from the nearest to the farthest corner of the volume", "", 256, 1, 2048),
        std::move(transfer),
        Param::number("density", "of the whole volume; 2 is as opaque as going through it twice", "", 1, 0.001, 1000),
        Param::boolean("light",
                       fmt::format("whether the shading {} lights boundaries using their gradient", transfer_function),
                       true),
        Param::boolean("frame", "an opaque plinth, and a ring with pins around and within the volume", true),
        camera_parameter()};
}

}  // namespace

SceneInfo scene_volume() {
    return {
        .id = "volume",
        .name = "Volume",
        .summary = "A grid of scalars, such as a head with its skull, as slices that face the camera.",
        .source = "Sheer",
        .parameters = volume_parameters(),
        .own_shading = transfer_function,
        .check = check,
        .build = build_volume,
        .asset_field = "volume/data",
    };
}

}  // namespace sheer
