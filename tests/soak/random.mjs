// Numbers that a seed gives. The seed is the day's, so that each day tries others; SHEER_SEED repeats a day.

export const SEED = Number(process.env.SHEER_SEED ?? Math.floor(Date.now() / 86_400_000));
/** How many times as much is tried; `./dev soak` tries more. */
export const SIZE = Number(process.env.SHEER_SOAK ?? 1);

export class Random {
  constructor(seed = SEED) {
    this.state = seed >>> 0;
    console.log(`SHEER_SEED=${seed}`);
  }

  /** From 0 to less than 1 (Numerical Recipes' linear congruential generator). */
  next() {
    this.state = (Math.imul(this.state, 1664525) + 1013904223) >>> 0;
    return this.state / 2 ** 32;
  }

  below(end) {
    return Math.floor(this.next() * end);
  }

  of(list) {
    return list[this.below(list.length)];
  }
}
