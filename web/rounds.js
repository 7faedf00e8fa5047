// How many rounds an interval needs, as the service judges times.

const ERROR_RATE = 0.05;

/**
 * The fewest rounds from which the intervals of `methods` methods hold together with 95 %: of n rounds, least and
 * greatest miss the median with a probability of 2 / 2^n, and all but the baseline are compared with it.
 */
export function rounds_needed(methods) {
  const compared = Math.max(methods - 1, 1);
  return Math.ceil(Math.log2((2 * compared) / ERROR_RATE));
}

/** "" where the rounds are enough. */
export function rounds_warning(rounds, methods) {
  const needed = rounds_needed(methods);
  if (!(rounds < needed)) return "";
  return `Too few rounds: ${rounds}, needs ${needed} to tell ${methods > 1 ? `${methods} methods` : "methods"} apart.`;
}
