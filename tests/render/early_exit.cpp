#include "tests/render/early_exit.h"

#include <fmt/format.h>

namespace sheer::test {

namespace {

constexpr int layers = 100;
constexpr double one_px = 1.0 / litmus_size_px;
constexpr std::array<double, 4> everywhere = {0, 0, 1, 1};

/// Surfaces from near to far, which are submitted as they come.
class Builder {
  public:
    void add(const std::array<double, 4>& rect, const Color& color, double alpha) {
        const double depth = 0.05 + 0.001 * static_cast<double>(m_surfaces.size());
        m_surfaces.push_back({.rect = rect, .left_depth = depth, .right_depth = depth, .color = color, .alpha = alpha});
    }
    void add_full(int count, double alpha) {
        for (int i = 0; i < count; ++i) add(everywhere, i % 2 == 0 ? Color{1, 0.2, 0} : Color{0, 0.4, 1}, alpha);
    }
    LitmusScene scene(const std::string& id) { return {.id = id, .surfaces = std::move(m_surfaces)}; }

  private:
    std::vector<LitmusSurface> m_surfaces;
};

LitmusScene never() {
    Builder builder;
    builder.add_full(layers, 1.0 / 128);
    return builder.scene("never");
}

LitmusScene at_once() {
    Builder builder;
    builder.add_full(1, 1);
    builder.add_full(layers - 1, 0.5);
    return builder.scene("at_once");
}

LitmusScene hole() {
    Builder builder;
    for (int ring = 0; ring < layers / 4; ++ring)
        for (const std::array<double, 4>& side : {std::array{0.0, 0.0, 1.0, 0.5}, std::array{0.0, 0.75, 1.0, 1.0},
                                                  std::array{0.0, 0.5, 0.5, 0.75}, std::array{0.75, 0.5, 1.0, 0.75}})
            builder.add(side, {0.2, 0.6, 0.2}, 1);
    builder.add(everywhere, {1, 1, 0}, 1);
    return builder.scene("hole");
}

LitmusScene just_under() {
    Builder builder;
    builder.add_full(1, 0.98);
    builder.add_full(1, 0.49);
    builder.add_full(layers - 2, 1e-4);
    return builder.scene("just_under");
}

LitmusScene checkerboard() {
    Builder builder;
    for (int y = 0; y < litmus_size_px; ++y)
        for (int x = y % 2; x < litmus_size_px; x += 2)
            builder.add({x * one_px, y * one_px, (x + 1) * one_px, (y + 1) * one_px}, {0.9, 0.9, 0.9}, 1);
    builder.add_full(layers, 1.0 / 128);
    return builder.scene("checkerboard");
}

}  // namespace

const std::vector<EarlyExitScene>& early_exit_scenes() {
    static const std::vector<EarlyExitScene> all = {
        {"Never", "100 layers of alpha 1/128: half of the light comes through all of them, so nothing is closed.",
         never()},
        {"At once", "One layer of alpha 1 in front of 99 others: everything is closed by the first.", at_once()},
        {"Hole",
         "25 layers of alpha 1, each of four rectangles, leave a hole of 4 x 4 pixels, which the last layer fills.",
         hole()},
        {"Just under",
         "Two layers leave 0.0102 of the light, slightly more than the threshold, and 98 faint ones behind them never "
         "reach it.",
         just_under()},
        {"Checkerboard",
         "Every second pixel is closed by a rectangle of its own, and 100 layers of alpha 1/128 cover all of them: no "
         "tile is ever closed.",
         checkerboard()}};
    return all;
}

std::string early_exit_section(const std::vector<MethodRow>& rows) {
    std::string text =
        "\n## Stopping early\nScenes made to hurt methods that stop at the threshold, here 0.01. The table says how "
        "many "
        "fragments they shade at most for each one that is needed, with llvmpipe, which draws primitives one after the "
        "other; the test (`tests/render/early_exit_test.cpp`) also compares the pictures.\n\n| scene | what it is "
        "|\n|---|---|\n";
    for (const EarlyExitScene& one : early_exit_scenes()) text += fmt::format("| {} | {} |\n", one.name, one.what);
    text += "\n| method |";
    std::string line = "|---|";
    for (const EarlyExitScene& one : early_exit_scenes()) {
        text += fmt::format(" {} |", one.name);
        line += "---|";
    }
    text += fmt::format(" because |\n{}---|\n", line);
    for (const MethodRow& row : rows)
        for (const EarlyExit& entry : row.early_exit) {
            text += fmt::format("| `{}` |", method_json(row, entry.parameters).dump());
            for (const double most : entry.most_shaded) text += fmt::format(" {:.4g} |", most);
            text += fmt::format(" {} |\n", entry.why);
        }
    return text;
}

}  // namespace sheer::test
