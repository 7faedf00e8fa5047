// How evenly the viewer draws while two large pictures are panned, slid and flipped.

const STEPS = 120;
const FIRST_FRAMES = 5; // in which the pictures are drawn at another scale for the first time

const at_share = (values, share) => [...values].sort((a, b) => a - b)[Math.ceil(values.length * share) - 1];

/**
 * Intervals between frames while `act(step)` is called, and per frame the time in the page's scripts, style and layout. The
 * scripts' time does not depend on how quickly a processor draws pixels, which without a GPU decides the interval.
 */
async function frames(page, act) {
  const client = await page.context().newCDPSession(page);
  await client.send("Performance.enable", { timeDomain: "threadTicks" });
  const spent_s = async () => {
    const { metrics } = await client.send("Performance.getMetrics");
    const value = (name) => metrics.find((metric) => metric.name === name).value;
    return {
      scripts: value("ScriptDuration") + value("LayoutDuration") + value("RecalcStyleDuration"),
      thread: value("TaskDuration"),
    };
  };
  await page.evaluate(() => {
    globalThis.frame_times = [];
    let before = performance.now();
    const next = (now) => {
      globalThis.frame_times.push(now - before);
      before = now;
      globalThis.frame_handle = requestAnimationFrame(next);
    };
    globalThis.frame_handle = requestAnimationFrame(next);
  });
  const begin = await spent_s();
  for (let step = 0; step < STEPS; ++step) await act(step);
  const end = await spent_s();
  const times = await page.evaluate(() => {
    cancelAnimationFrame(globalThis.frame_handle);
    return globalThis.frame_times;
  });
  await client.detach();
  const per_frame_ms = (name) => ((1000 * (end[name] - begin[name])) / times.length).toFixed(1);
  const later = times.slice(FIRST_FRAMES);
  const [half, most] = [0.5, 0.95].map((share) => at_share(later, share).toFixed(1));
  return (
    `frames every ${half} ms, 95 % within ${most} ms, ` +
    `scripts and layout ${per_frame_ms("scripts")} ms, main thread ${per_frame_ms("thread")} ms`
  );
}

/** A sentence for each way of comparing the first two pictures of the report at `url`. */
export async function measure_frames(page, url) {
  const open = async (query) => {
    await page.goto("about:blank");
    await page.goto(`${url}?${query}`);
    await page.locator(".pane-view").first().waitFor();
    await page.locator(".picture > *").evaluateAll((all) => Promise.all(all.map((one) => one.decode?.())));
    await page.locator(".pane-view").first().scrollIntoViewIfNeeded();
    return page.locator(".pane-view").first().boundingBox();
  };
  const told = [];
  for (const layout of ["slider", "grid"]) {
    const box = await open(`layout=${layout}&kept=1,2&zoom=2&at=1024,1024`);
    const [x, y] = [box.x + box.width * 0.3, box.y + box.height * 0.3];
    await page.mouse.move(x, y);
    await page.mouse.down();
    const pan = (step) => page.mouse.move(x + 80 * Math.sin(step / 5), y + 80 * Math.cos(step / 7));
    told.push(`panning (${layout}): ${await frames(page, pan)}`);
    await page.mouse.up();
  }
  const box = await open("layout=slider");
  await page.locator(".divider").hover();
  await page.mouse.down();
  const slide = (step) => page.mouse.move(box.x + box.width * (0.5 + 0.4 * Math.sin(step / 9)), box.y + 200);
  told.push(`slider: ${await frames(page, slide)}`);
  await page.mouse.up();
  await open("layout=flip");
  told.push(`flipping: ${await frames(page, (step) => page.keyboard.press(step % 2 ? "1" : "2"))}`);
  return told.map((one) => `\n  ${one}`).join("");
}
