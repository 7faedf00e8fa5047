#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "renderer/assets/picture_file.h"
#include "renderer/core/files.h"
#include "renderer/files/data_uri.h"
#include "renderer/litmus/identify.h"
#include "renderer/litmus/pack.h"
#include "renderer/params/json_text.h"
#include "renderer/pictures/picture_file.h"
#include "server/cli/rendering/commands.h"

namespace sheer::cli {

namespace {

using litmus::Color;
using litmus::Drawing;
using litmus::litmus_size_px;
using nlohmann::json;
using std::filesystem::path;

constexpr std::uintmax_t max_picture_bytes = 256u << 20;
constexpr std::size_t most_named = 8;

Image image_of(const litmus::Pixels& pixels) {
    Image image(litmus_size_px, litmus_size_px);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel)
            image.rgba[4 * i + channel] = static_cast<float>(pixels[i][channel]);
        image.rgba[4 * i + 3] = 1;
    }
    return image;
}

/// The correct picture, if these values are blended.
Image expected_picture(const litmus::LitmusScene& scene, litmus::Blending blending) {
    const litmus::FormulaInfo intended = {.id = scene.id,
                                          .make = [&](const json&) -> litmus::Formula { return scene.intended; }};
    return image_of(litmus::Identifier::draw(scene, {.formula = &intended, .blending = blending}));
}

void write_picture(const path& stem, const Image& image) {
    write_file(stem.string() + ".png", encode_png(quantize(image)));
    write_file(stem.string() + ".exr", encode_exr(image));
}

int run_export(const path& folder) {
    const std::array<path, 3> folders = {folder / "scenes", folder / "expected", folder / "expected-linear"};
    for (const path& each : folders) {
        if (std::filesystem::exists(each)) throw UsageError(each.string() + " is already there");
        std::filesystem::create_directories(each);
    }
    for (const litmus::LitmusScene& scene : litmus::all_litmus_scenes()) {
        litmus::GltfScene gltf = scene_gltf(scene);
        gltf.document["buffers"][0]["uri"] = data_uri("application/octet-stream", gltf.bytes);
        write_file(folders[0] / (scene.id + ".json"), json_page(scene_json(scene)));
        write_file(folders[0] / (scene.id + ".gltf"), json_page(gltf.document));
        write_picture(folders[1] / scene.id, expected_picture(scene, litmus::Blending::encoded));
        write_picture(folders[2] / scene.id, expected_picture(scene, litmus::Blending::linear));
    }
    write_file(folder / "README.md", litmus::pack_readme());
    fmt::print("{} scenes: {}\n", litmus::all_litmus_scenes().size(), (folder / "README.md").string());
    return exit_ok;
}

/// The middle of each of the squares that stand for a pixel. Throws UsageError for another size.
litmus::Pixels read_pixels(const path& file) {
    const std::string bytes = read_file(file, max_picture_bytes);
    const PictureHeader header = read_picture_header(bytes);
    const int width_px = header.width_px;
    const bool is_multiplied = header.format == PictureFormat::exr;
    if (width_px != header.height_px || width_px % litmus_size_px != 0)
        throw UsageError(fmt::format("{} has {} x {} pixels: it must be a square of a multiple of {}", file.string(),
                                     width_px, header.height_px, litmus_size_px));
    const int scale = width_px / litmus_size_px;
    litmus::Pixels pixels(std::size_t{litmus_size_px} * litmus_size_px);
    decode_picture(bytes, [&](int y, const float* row) {
        if (y % scale != scale / 2) return;
        for (int x = 0; x < litmus_size_px; ++x) {
            const float* pixel = row + std::size_t{4} * (x * scale + scale / 2);
            // What the reader has divided by alpha is as in the file again.
            const double alpha = is_multiplied && pixel[3] != 0 ? double{pixel[3]} : 1;
            Color& color = pixels[std::size_t(y / scale) * litmus_size_px + x];
            for (std::size_t i = 0; i < 3; ++i) color[i] = std::clamp(pixel[i] * alpha, 0.0, 1.0);
        }
    });
    return pixels;
}

std::map<std::string, litmus::Pixels> read_pictures(const path& folder, std::vector<std::string>& missing) {
    std::map<std::string, litmus::Pixels> pictures;
    for (const litmus::LitmusScene& scene : litmus::all_litmus_scenes()) {
        const path exr = folder / (scene.id + ".exr"), png = folder / (scene.id + ".png");
        const path& file = std::filesystem::exists(exr) ? exr : png;
        if (!std::filesystem::exists(file)) {
            missing.push_back(scene.id);
            continue;
        }
        try {
            pictures[scene.id] = read_pixels(file);
        } catch (const AssetError& error) {
            throw UsageError(fmt::format("{}: {}", file.string(), error.what()));
        }
    }
    if (pictures.empty())
        throw UsageError(
            fmt::format("{} has no picture of a litmus scene, such as {}.png", folder.string(), missing.front()));
    return pictures;
}

json drawing_json(const Drawing& drawing) {
    return {{"formula", drawing.formula->id},
            {"name", drawing.formula->name},
            {"parameters", drawing.parameters},
            {"order", drawing.formula->depends_on_order ? json(name_of(drawing.order)) : json()},
            {"colors", name_of(drawing.colors)},
            {"blends", name_of(drawing.blending)}};
}

json fit_json(const litmus::Fit& fit) {
    return {{"rms_levels", fit.rms_levels}, {"greatest_levels", fit.greatest_levels}, {"worst_scene", fit.worst_scene}};
}

json identification_json(const litmus::Identification& found, const std::vector<std::string>& missing) {
    json drawings = json::array();
    for (const Drawing& drawing : found.drawings) drawings.push_back(drawing_json(drawing));
    return {{"found", found.found},
            {"drawings", drawings},
            {"distance", fit_json(found.fit)},
            {"next", drawing_json(found.next)},
            {"next_distance", fit_json(found.next_fit)},
            {"missing", missing}};
}

std::string in_words(const Drawing& drawing) {
    std::string text = fmt::format("{}, {}", drawing.formula->id, drawing.formula->name);
    if (!drawing.parameters.empty()) text += " " + drawing.parameters.dump();
    if (drawing.formula->depends_on_order) text += fmt::format("; {}", name_of(drawing.order));
    return text + fmt::format("; colors: {}; blends: {}", name_of(drawing.colors), name_of(drawing.blending));
}

std::string in_words(const litmus::Fit& fit) {
    return fmt::format("off by {:.2f} of 255 levels (RMS), at most by {:.1f}; least alike: {}", fit.rms_levels,
                       fit.greatest_levels, fit.worst_scene);
}

int run_identify(const path& folder, bool as_json) {
    std::vector<std::string> missing;
    const std::map<std::string, litmus::Pixels> pictures = read_pictures(folder, missing);
    const litmus::Identification found = litmus::Identifier().identify(pictures);
    if (as_json) {
        fmt::print("{}", json_page(identification_json(found, missing)));
        return found.found ? exit_ok : exit_check_failed;
    }
    if (!missing.empty()) fmt::print("Without pictures of {}.\n", fmt::join(missing, ", "));
    fmt::print("{}{}\n  {}\n", found.found ? "" : "None of these. The nearest is:\n", in_words(found.drawings.front()),
               in_words(found.fit));
    const std::size_t shown = std::min(found.drawings.size(), most_named);
    if (shown > 1) fmt::print("The same pictures come from:\n");
    for (std::size_t i = 1; i < shown; ++i) fmt::print("  {}\n", in_words(found.drawings[i]));
    if (shown < found.drawings.size()) fmt::print("  and {} more (--json)\n", found.drawings.size() - shown);
    fmt::print("Next: {}\n  {}\n", in_words(found.next), in_words(found.next_fit));
    return found.found ? exit_ok : exit_check_failed;
}

}  // namespace

void add_litmus(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("litmus", "Scenes that show by which formula a renderer blends");
    command->require_subcommand(1);
    command->footer("Example: sheer litmus identify pictures");
    const auto folder = std::make_shared<std::string>();
    const auto as_json = std::make_shared<bool>(false);

    CLI::App* export_command = command->add_subcommand(
        "export", "Write the scenes as glTF and JSON, and their correct pictures, for another renderer");
    export_command->add_option("folder", *folder, "Where to")->required();
    export_command->footer("Example: sheer litmus export litmus");
    export_command->callback([=, &exit_code] { exit_code = guarded([&] { return run_export(*folder); }); });

    CLI::App* identify_command =
        command->add_subcommand("identify", "Name the formula that made the pictures of the scenes");
    identify_command->add_option("folder", *folder, "The folder of the pictures, each named like its scene")
        ->required()
        ->check(CLI::ExistingDirectory);
    identify_command->add_flag("--json", *as_json, "Print JSON");
    identify_command->footer(
        "Example: sheer litmus identify pictures\nThe exit code is 1 if it is none of the formulas that are known.");
    identify_command->callback(
        [=, &exit_code] { exit_code = guarded([&] { return run_identify(*folder, *as_json); }); });
}

}  // namespace sheer::cli
