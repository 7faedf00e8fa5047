// How many jobs the queue of a store hands out and takes back, with workers that do not render. docs/results/store.md
// has its figures.
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "renderer/core/clock.h"
#include "renderer/core/sha256.h"
#include "server/cli/open_store.h"
#include "server/jobs/report_id.h"

namespace sheer {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::size_t picture_bytes = 40'000;

double ms_since(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

struct Place {
    std::string url, folder;

    std::unique_ptr<Store> open() const { return cli::open_store(url, folder, {}); }
};

/// A report with a text of 16 KB and one picture of its own.
FinishedReport finished(const Lease& job) {
    std::string picture = job.id;
    picture.resize(picture_bytes, 'x');
    const std::string sha256 = sha256_hex(picture);
    FinishedReport report{.report = {{"id", job.id}, {"status", "done"}, {"verdict", "passed"}},
                          .finished_ms = system_now_ms()};
    for (int i = 0; i < 400; ++i) report.report["numbers"].push_back(fmt::format("{} {}", job.id, i * 7919));
    report.blobs = {{sha256, "image/png"}};
    report.read_blob = [picture](const std::string&) { return picture; };
    return report;
}

void submit(const Place& place, int jobs) {
    const auto store = place.open();
    ReportIds ids(system_now_ms);
    for (int i = 0; i < jobs; ++i) {
        json spec = {
            {"title", fmt::format("job {}", i)}, {"scene", {{"type", "quads"}}}, {"methods", {{{"id", "b2f"}}}}};
        NewReport report{.id = ids.next(), .spec = spec.dump()};
        report.spec_sha256 = sha256_hex(report.spec);
        store->queue().submit(report, {1'000'000});
    }
}

/// What a worker's calls took.
struct Spent {
    int jobs = 0;
    double lease_ms = 0, heartbeat_ms = 0, commit_ms = 0;
};

Spent work(const Place& place, int number) {
    const auto store = place.open();
    Spent spent;
    while (true) {
        const auto begin = Clock::now();
        const auto job = store->queue().lease(fmt::format("worker {} {}", getpid(), number));
        if (!job) return spent;
        spent.lease_ms += ms_since(begin);
        const auto beat = Clock::now();
        store->queue().heartbeat(*job, 0.5, "timing");
        spent.heartbeat_ms += ms_since(beat);
        const FinishedReport report = finished(*job);
        const auto commit = Clock::now();
        if (!store->queue().commit(*job, report)) throw std::runtime_error("a job was lost");
        spent.commit_ms += ms_since(commit);
        ++spent.jobs;
    }
}

/// In processes, as workers are. Prints a row of the table; returns jobs a second.
double measure(const Place& place, int workers, int jobs, double of_one) {
    const auto filling = Clock::now();
    submit(place, jobs);
    const double submit_ms = ms_since(filling) / jobs;
    std::vector<int> pipes;
    const auto begin = Clock::now();
    for (int i = 0; i < workers; ++i) {
        int ends[2];
        if (pipe(ends) != 0) throw std::runtime_error("pipe");
        if (fork() == 0) {
            const Spent spent = work(place, i);
            _exit(write(ends[1], &spent, sizeof spent) == sizeof spent ? 0 : 1);
        }
        close(ends[1]);
        pipes.push_back(ends[0]);
    }
    Spent all;
    for (const int end : pipes) {
        Spent spent;
        if (read(end, &spent, sizeof spent) != sizeof spent) throw std::runtime_error("a worker failed");
        close(end);
        all.jobs += spent.jobs;
        all.lease_ms += spent.lease_ms;
        all.heartbeat_ms += spent.heartbeat_ms;
        all.commit_ms += spent.commit_ms;
    }
    while (wait(nullptr) > 0) continue;
    const double per_second = all.jobs * 1000 / ms_since(begin);
    if (all.jobs != jobs) throw std::runtime_error(fmt::format("{} of {} jobs", all.jobs, jobs));
    fmt::print("| {} | {:.0f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", workers, per_second,
               of_one > 0 ? per_second / of_one : 1, submit_ms, all.lease_ms / jobs, all.heartbeat_ms / jobs,
               all.commit_ms / jobs);
    return per_second;
}

}  // namespace
}  // namespace sheer

int main(int count, char** arguments) {
    if (count < 3) {
        fmt::print(stderr, "Usage: queue_load FOLDER JOBS [URL]\n");
        return 2;
    }
    const sheer::Place place{count > 3 ? arguments[3] : "", arguments[1]};
    const int jobs = std::atoi(arguments[2]);
    fmt::print("| workers | jobs / s | of one worker's | submit ms | lease ms | heartbeat ms | commit ms |\n");
    fmt::print("|---|---|---|---|---|---|---|\n");
    double of_one = 0;
    for (const int workers : {1, 2, 4, 8}) {
        const double per_second = sheer::measure(place, workers, jobs, of_one);
        if (of_one == 0) of_one = per_second;
    }
}
