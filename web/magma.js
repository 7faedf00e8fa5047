// The color map of the pictures of counts and of FLIP: matplotlib's magma at every fifth of 256 levels, as in
// renderer/image/magma.cpp, and back from a color to its level.

const STEP = 5;
const LEVELS = 256;
// prettier-ignore
const KNOTS = [
  0, 0, 4, 2, 2, 11, 5, 4, 22, 9, 7, 32, 14, 11, 43, 20, 14, 54, 26, 16, 66, 33, 17, 78, 41, 17, 90, 49, 17, 101, 57,
  15, 110, 66, 15, 117, 74, 16, 121, 82, 19, 124, 90, 22, 126, 98, 25, 128, 106, 28, 129, 114, 31, 129, 121, 34, 130,
  129, 37, 129, 137, 40, 129, 145, 43, 129, 153, 45, 128, 161, 48, 126, 170, 51, 125, 178, 53, 123, 186, 56, 120,
  194, 59, 117, 202, 62, 114, 210, 66, 111, 217, 70, 107, 224, 76, 103, 231, 82, 99, 236, 88, 96, 241, 96, 93, 244,
  105, 92, 247, 114, 92, 249, 123, 93, 251, 133, 96, 252, 142, 100, 253, 152, 105, 254, 161, 110, 254, 170, 116, 254,
  180, 123, 254, 189, 130, 254, 198, 138, 254, 207, 146, 254, 216, 154, 253, 226, 163, 253, 235, 172, 252, 244, 182,
  252, 253, 191,
];

function interpolate() {
  const levels = [];
  for (let level = 0; level < LEVELS; ++level) {
    const knot = level === LEVELS - 1 ? KNOTS.length / 3 - 2 : Math.floor(level / STEP);
    const along = level - knot * STEP;
    levels.push(
      [0, 1, 2].map((channel) => {
        const [from, to] = [KNOTS[knot * 3 + channel], KNOTS[knot * 3 + 3 + channel]];
        return Math.floor((from * (STEP - along) + to * along + Math.floor(STEP / 2)) / STEP);
      }),
    );
  }
  return levels;
}

/** Red, green and blue of each of the 256 levels. */
export const MAGMA = interpolate();

const LEVEL_OF = new Map(MAGMA.map(([r, g, b], level) => [(r << 16) | (g << 8) | b, level]));

/** The level of a color, undefined if it is none of the map's. */
export function magma_level(r, g, b) {
  return LEVEL_OF.get((r << 16) | (g << 8) | b);
}
