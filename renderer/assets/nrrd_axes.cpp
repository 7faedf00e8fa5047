#include "renderer/assets/nrrd_axes.h"

#include <algorithm>
#include <cmath>

#include "renderer/assets/text_fields.h"

namespace sheer {

namespace {

/// The text in each pair of parentheses.
std::vector<std::string_view> groups_in(std::string_view text) {
    std::vector<std::string_view> groups;
    while (true) {
        const std::size_t open = text.find('('), close = text.find(')');
        if (open == std::string_view::npos || close == std::string_view::npos || close < open) return groups;
        groups.push_back(text.substr(open + 1, close - open - 1));
        text.remove_prefix(close + 1);
    }
}

glm::dvec3 numbers_of(const std::vector<std::string_view>& words, std::string_view field) {
    glm::dvec3 numbers(0);
    for (int i = 0; i < 3; ++i) numbers[i] = number_in<double>(three(words, field)[static_cast<std::size_t>(i)], field);
    return numbers;
}

void check_spacing(const glm::dvec3& spacing, std::string_view field) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(spacing[axis] >= 1e-9 && spacing[axis] <= 1e9))
            throw AssetError(fmt::format("the NRRD field \"{}\" has unusable distances between voxels", field));
}

bool is_left_handed(std::string_view space) {
    const std::string name = lower(space);
    return name == "left-anterior-superior" || name == "las" || name == "3d-left-handed";
}

/// The axes of the space that are nearest to the columns, which have the length 1, with the same handedness.
std::array<VoxelAxis, 3> nearest_axes(const glm::dmat3& directions) {
    std::array<int, 3> order = {0, 1, 2};
    std::array<VoxelAxis, 3> best;
    double best_sum = -1;
    do {
        glm::dmat3 axes(0);
        std::array<VoxelAxis, 3> candidate;
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto column = static_cast<int>(i);
            const double along = directions[column][order[i]];
            candidate[i] = {order[i], along < 0};
            axes[column][order[i]] = along < 0 ? -1 : 1;
            sum += std::abs(along);
        }
        if (sum <= best_sum || glm::determinant(axes) * glm::determinant(directions) < 0) continue;
        best_sum = sum;
        best = candidate;
    } while (std::ranges::next_permutation(order).found);
    return best;
}

void note_tilt(const glm::dmat3& directions, const std::array<VoxelAxis, 3>& axes, std::vector<Note>& notes) {
    double least = 1;
    for (std::size_t i = 0; i < 3; ++i)
        least = std::min(least, std::abs(directions[static_cast<int>(i)][axes[i].scene_axis]));
    constexpr double degrees = 180 / 3.14159265358979, tolerance_deg = 0.5;
    const double tilt_deg = std::acos(std::min(least, 1.0)) * degrees;
    if (tilt_deg <= tolerance_deg) return;
    add_note(notes,
             {"oblique-axes",
              fmt::format("The axes of the volume are rotated by up to {:.0f} degrees relative to its space; it is "
                          "drawn along the nearest axes.",
                          std::ceil(tilt_deg)),
              ""});
}

void place_by_directions(std::string_view text, bool left_handed, VoxelLayout& layout, std::vector<Note>& notes) {
    constexpr std::string_view field = "space directions";
    const std::vector<std::string_view> groups = three(groups_in(text), field);
    glm::dmat3 directions(0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 direction = numbers_of(split(groups[static_cast<std::size_t>(axis)], ", \t"), field);
        if (left_handed) direction.x = -direction.x;
        layout.spacing[axis] = glm::length(direction);
        directions[axis] = direction / layout.spacing[axis];
    }
    check_spacing(layout.spacing, field);
    constexpr double flat = 1e-3;
    if (!(std::abs(glm::determinant(directions)) > flat))
        throw AssetError("the NRRD field \"space directions\" has three directions in one plane");
    layout.axes = nearest_axes(directions);
    note_tilt(directions, layout.axes, notes);
}

}  // namespace

void place_nrrd_axes(const NrrdAxisFields& fields, VoxelLayout& layout, std::vector<Note>& notes) {
    const bool left_handed = fields.space && is_left_handed(*fields.space);
    if (left_handed)
        add_note(notes, {"left-handed-space",
                         "The space of the volume is left-handed; its first axis is reversed, so that nothing is "
                         "mirrored.",
                         ""});
    if (fields.space_directions) return place_by_directions(*fields.space_directions, left_handed, layout, notes);
    layout.axes[0].reversed = left_handed;
    if (!fields.spacings) return;
    const glm::dvec3 spacings = numbers_of(split(*fields.spacings, " \t"), "spacings");
    layout.spacing = glm::abs(spacings);
    check_spacing(layout.spacing, "spacings");
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (spacings[static_cast<int>(axis)] < 0) layout.axes[axis].reversed = !layout.axes[axis].reversed;
}

}  // namespace sheer
