// What the queue of a PostgreSQL store does with many workers: a simulation with the costs that queue_load measured. Prints
// a table for docs/scaling.md. JOB_S: how long a job is rendered on average; HEARTBEATS: how many a worker sends a second;
// CORES: of the database.
const JOB_S = Number(process.env.JOB_S ?? 30);
const HEARTBEATS = Number(process.env.HEARTBEATS ?? 1);
const CORES = Number(process.env.CORES ?? 2);
const SECONDS = Number(process.env.SECONDS ?? 120);
const LEASE_S = 10;

// In ms: first on any core, then one transaction after the other, since a commit that notifies holds a lock of the whole
// database while it waits for the disk. A heartbeat does not wait for it.
const COSTS = {
  submit: { core: 2.4, alone: 4.5 },
  lease: { core: 2.1, alone: 4.5 },
  heartbeat: { core: 0.9, alone: 0.05 },
  commit: { core: 2.7, alone: 4.5 },
};

/** The earliest first. */
class Events {
  #heap = [];

  push(at, run) {
    const heap = this.#heap;
    let i = heap.push({ at, run }) - 1;
    for (let above; i > 0 && heap[(above = (i - 1) >> 1)].at > heap[i].at; i = above)
      [heap[above], heap[i]] = [heap[i], heap[above]];
  }

  pop() {
    const heap = this.#heap;
    const first = heap[0];
    const last = heap.pop();
    if (heap.length === 0) return first;
    heap[0] = last;
    for (let i = 0; ;) {
      let least = i;
      for (const below of [2 * i + 1, 2 * i + 2])
        if (below < heap.length && heap[below].at < heap[least].at) least = below;
      if (least === i) return first;
      [heap[least], heap[i]] = [heap[i], heap[least]];
      i = least;
    }
  }
}

/** Serves requests in the order in which they come, `count` at a time. */
class Servers {
  #free;

  constructor(count) {
    this.#free = new Array(count).fill(0);
    this.busy_s = 0;
  }

  /** When a request that comes at `now` and takes `ms` is over. */
  serve(now, ms) {
    const next = this.#free.indexOf(Math.min(...this.#free));
    this.#free[next] = Math.max(now, this.#free[next]) + ms / 1000;
    this.busy_s += ms / 1000;
    return this.#free[next];
  }
}

function simulate(workers) {
  const events = new Events();
  const cores = new Servers(CORES);
  const alone = new Servers(1);
  const found = { jobs: 0, rendering_s: 0, longest_heartbeat_s: 0, lost: 0 };
  const ask = (now, what) => alone.serve(cores.serve(now, COSTS[what].core), COSTS[what].alone);
  const begin = (now) => {
    const leased = ask(now, "lease");
    // Somebody queues the next one.
    ask(now, "submit");
    const ends = leased - JOB_S * Math.log(1 - Math.random());
    events.push(leased, (at) => beat(at, ends, at));
  };
  const beat = (now, ends, last) => {
    if (now >= ends) {
      found.rendering_s += Math.min(now, SECONDS) - last;
      events.push(ask(now, "commit"), (at) => {
        ++found.jobs;
        begin(at);
      });
      return;
    }
    const told = ask(now, "heartbeat");
    found.longest_heartbeat_s = Math.max(found.longest_heartbeat_s, told - now);
    if (told - last > LEASE_S) ++found.lost;
    found.rendering_s += now - last;
    events.push(Math.max(told, Math.min(ends, now + 1 / HEARTBEATS)), (at) => beat(at, ends, now));
  };
  // In the middle of a job.
  for (let i = 0; i < workers; ++i)
    events.push(Math.random() / HEARTBEATS, (at) => beat(at, at - JOB_S * Math.log(1 - Math.random()), at));
  for (let event = events.pop(); event.at < SECONDS; event = events.pop()) event.run(event.at);
  return { ...found, cores: cores.busy_s / CORES / SECONDS, alone: alone.busy_s / SECONDS };
}

const percent = (part) => `${Math.round(100 * Math.min(part, 1))} %`;
console.log(
  "| workers | jobs a second | of what they could render | busy: cores | busy: commits | slowest heartbeat | leases lost |",
);
console.log("|---|---|---|---|---|---|---|");
for (const workers of [10, 100, 300, 1000, 3000, 10000]) {
  const found = simulate(workers);
  const possible = (workers * SECONDS) / JOB_S;
  console.log(
    `| ${workers} | ${(found.jobs / SECONDS).toFixed(1)} | ${percent(found.jobs / possible)} | ${percent(found.cores)} | ` +
      `${percent(found.alone)} | ${found.longest_heartbeat_s.toFixed(2)} s | ${found.lost} |`,
  );
}
