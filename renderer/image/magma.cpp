#include "renderer/image/magma.h"

namespace sheer {
namespace {

constexpr int step = 5;
constexpr std::uint8_t every_fifth[52][3] = {
    {0, 0, 4},       {2, 2, 11},      {5, 4, 22},      {9, 7, 32},      {14, 11, 43},    {20, 14, 54},
    {26, 16, 66},    {33, 17, 78},    {41, 17, 90},    {49, 17, 101},   {57, 15, 110},   {66, 15, 117},
    {74, 16, 121},   {82, 19, 124},   {90, 22, 126},   {98, 25, 128},   {106, 28, 129},  {114, 31, 129},
    {121, 34, 130},  {129, 37, 129},  {137, 40, 129},  {145, 43, 129},  {153, 45, 128},  {161, 48, 126},
    {170, 51, 125},  {178, 53, 123},  {186, 56, 120},  {194, 59, 117},  {202, 62, 114},  {210, 66, 111},
    {217, 70, 107},  {224, 76, 103},  {231, 82, 99},   {236, 88, 96},   {241, 96, 93},   {244, 105, 92},
    {247, 114, 92},  {249, 123, 93},  {251, 133, 96},  {252, 142, 100}, {253, 152, 105}, {254, 161, 110},
    {254, 170, 116}, {254, 180, 123}, {254, 189, 130}, {254, 198, 138}, {254, 207, 146}, {254, 216, 154},
    {253, 226, 163}, {253, 235, 172}, {252, 244, 182}, {252, 253, 191}};

ColorMap interpolate() {
    ColorMap map{};
    for (int level = 0; level < 256; ++level) {
        const int knot = level == 255 ? 50 : level / step;
        const int along = level - knot * step;
        for (int c = 0; c < 3; ++c) {
            const int sum = every_fifth[knot][c] * (step - along) + every_fifth[knot + 1][c] * along;
            map[level][c] = std::uint8_t((sum + step / 2) / step);
        }
    }
    return map;
}

}  // namespace

const ColorMap& magma() {
    static const ColorMap map = interpolate();
    return map;
}

}  // namespace sheer
