#include "server/worker/worker.h"

#include <fmt/format.h>

#include <fstream>
#include <set>
#include <thread>

#include "server/children/supervisor.h"
#include "server/worker/report_folder.h"
#include "server/worker/scratch.h"
#include "store_fixture.h"

namespace sheer::test::worker_test {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

/// A worker whose renderer is a shell script: $1 render, $2 the spec, $3 --out, $4 the folder.
class WorkerTest : public WithStore {
  protected:
    WorkerTest() {
        m_options.scratch = m_data.scratch();
        m_options.data = "the archive";
    }

    void run_with(const std::string& script) {
        std::filesystem::remove(m_folder.path() / "renderer");
        m_options.program = m_folder.file("renderer", "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(m_options.program, std::filesystem::perms::owner_all);
        EXPECT_TRUE(Worker(m_store, m_options, m_clock).run_next(m_stop));
        EXPECT_TRUE(std::filesystem::is_empty(m_options.scratch));
    }

    /// Writes a report with one picture.
    std::string leave_report(const std::string& picture, const std::string& sha256) const {
        return fmt::format(R"(mkdir "$4"; printf %s '{}' > "$4/{}"; printf %s '{}' > "$4/report.json")", picture,
                           sha256,
                           R"({"verdict": "none", "runs": [{"reference": {"images":
                {"color": {"url": "u", "media_type": "image/png", "sha256": ")" +
                               sha256 + R"("}}}}]})");
    }

    JobError error(const std::string& id) { return m_reports.find(id)->error.value_or(JobError{"none", "none"}); }

    StopSignal m_stop;
    WorkerOptions m_options{
        .scratch = {}, .data = {}, .name = "worker", .time_limit = 20s, .rules = {.heartbeat_ms = 50}};
};

TEST_F(WorkerTest, CommitsTheRenderersOutput) {
    const std::string id = submit("title");
    const std::string sha256 = sha256_hex("picture");
    run_with(leave_report("picture", sha256));
    ASSERT_EQ(status(id), Status::done);
    const json report = json::parse(m_reports.find(id)->report);
    EXPECT_EQ(report["id"], id);
    EXPECT_EQ(report["status"], "done");
    EXPECT_EQ(report["progress"], 1.0);
    EXPECT_EQ(report["created_at"], utc_text(m_now_ms));
    EXPECT_EQ(report["finished_at"], utc_text(m_now_ms));
    EXPECT_EQ(report["spec"]["title"], "title");
    EXPECT_EQ(report["spec_sha256"], sha256_hex(report["spec"].dump()));
    EXPECT_EQ(picture(sha256), "picture");
}

TEST_F(WorkerTest, AFailedCheckIsADoneReport) {
    const std::string id = submit();
    run_with(leave_report("p", sha256_hex("p")) + "; exit 1");
    EXPECT_EQ(status(id), Status::done);
}

TEST_F(WorkerTest, TheRendererGetsTheSpec) {
    const std::string id = submit("told");
    run_with(
        R"([ "$1 $3 $5 $6" = "render --out --data the archive" ] || exit 9; grep -q '"title":"told"' "$2" || exit 9; )" +
        leave_report("p", sha256_hex("p")));
    EXPECT_EQ(status(id), Status::done);
}

/// The seventh and eighth words say where compiled shaders are; one that is kept leaves a file there.
TEST_F(WorkerTest, WhatReadsFilesOfOthersGetsACopyOfTheShaders) {
    m_options.shaders = m_folder.path() / "shaders";
    std::filesystem::create_directories(m_options.shaders / "ab");
    std::ofstream(m_options.shaders / "ab" / "known") << "compiled";
    const auto rendered = [&](const json& more, const std::string& name) {
        const std::string id = submit("shaders", more);
        run_with(R"([ "$7" = --shaders ] && grep -q compiled "$8/ab/known" || exit 9; echo new > "$8/)" + name +
                 "\"; " + leave_report("p", sha256_hex("p")));
        EXPECT_EQ(status(id), Status::done) << name;
        return std::filesystem::exists(m_options.shaders / name);
    };
    EXPECT_TRUE(rendered(json::object(), "ours"));
    EXPECT_FALSE(rendered({{"scene", {{"type", "gltf"}, {"model", std::string(64, 'a')}}}}, "upload"));
    EXPECT_FALSE(rendered({{"scene", {{"type", "quads"}, {"shading", {{"glsl", "return tint;"}}}}}}, "program"));
    EXPECT_TRUE(std::filesystem::exists(m_options.shaders / "ab" / "known"));
}

/// The renderer, which is asked to join the parts at last, answers what it was asked.
TEST_F(WorkerTest, APartIsRenderedWithItsLabelAndJoinedByTheRenderer) {
    const std::string id = submit("parts", {{"device", {"a", "b"}}, {"checks", json::array()}});
    const std::string joins =
        R"(if [ "$1" = join-stored ]; then question=$(cat /dev/stdin); case "$question" in *'"label":"b"'*) ;; *) exit 9;; esac; )"
        R"(printf '{"report": {"verdict": "none", "devices": [{"label": "a", "status": "done"}]}}\n'; exit 0; fi; )";
    for (const char* label : {"a", "b"}) {
        m_options.label = label;
        run_with(joins + R"(grep -q '"device":")" + label + R"("' "$2" || exit 9; )" +
                 leave_report("p", sha256_hex("p")));
        EXPECT_EQ(status(id), Status::queued);
    }
    m_options.label = "c";
    run_with(joins);
    ASSERT_EQ(status(id), Status::done);
    const json report = json::parse(m_reports.find(id)->report);
    EXPECT_EQ(report["id"], id);
    EXPECT_EQ(report["spec"]["device"], json({"a", "b"}));
    EXPECT_EQ(report["devices"][0]["label"], "a");
}

TEST_F(WorkerTest, ARendererThatDiesIsTriedOnceMore) {
    const std::string id = submit();
    run_with("kill -SEGV $$");
    EXPECT_EQ(status(id), Status::queued);
    run_with("kill -SEGV $$");
    ASSERT_EQ(status(id), Status::failed);
    EXPECT_EQ(error(id).detail, "The renderer died (signal 11).");
}

TEST_F(WorkerTest, ARendererThatExplainsItselfIsNotTriedAgain) {
    const std::string id = submit();
    run_with(R"(echo noise; echo '{"error": {"kind": "unsupported", "detail": "no textures"}}'; exit 3)");
    ASSERT_EQ(status(id), Status::failed);
    EXPECT_EQ(error(id).title, "Not supported on this device");
    EXPECT_EQ(error(id).detail, "no textures");
}

TEST_F(WorkerTest, AJobWhoseFilesTheDiskRefusedIsSetBack) {
    const std::string id = submit();
    run_with(R"(echo '{"error": {"kind": "storage", "detail": "No space left on device", "full": true}}'; exit 3)");
    EXPECT_EQ(status(id), Status::queued);
    EXPECT_EQ(m_reports.find(id)->stage, "waiting: No space left on device");
    EXPECT_NE(m_readiness.lack_of_room(), "");
    EXPECT_FALSE(m_queue.lease("worker"));
    m_now_ms += 2'000;
    run_with(R"(echo '{"error": {"kind": "storage", "detail": "Input/output error"}}'; exit 3)");
    EXPECT_EQ(status(id), Status::queued);
    EXPECT_EQ(m_readiness.lack_of_room(), "");
    m_now_ms += 3'000;
    run_with(leave_report("p", sha256_hex("p")));
    EXPECT_EQ(status(id), Status::done);
}

TEST_F(WorkerTest, AJobThatGetsNoScratchFolderIsSetBack) {
    const std::string id = submit();
    std::filesystem::create_directories(m_data.root);
    m_folder.file("data/scratch", "a file where the folder should be");
    EXPECT_TRUE(Worker(m_store, m_options, m_clock).run_next(m_stop));
    EXPECT_EQ(status(id), Status::queued);
    std::filesystem::remove(m_options.scratch);
    m_now_ms += 1'000;
    run_with(leave_report("p", sha256_hex("p")));
    EXPECT_EQ(status(id), Status::done);
}

TEST_F(WorkerTest, ASpecThatKillsInTheSameWayAgainIsNotTriedTwice) {
    submit("deadly");
    run_with("kill -SEGV $$");
    run_with("kill -SEGV $$");
    const std::string again = submit("deadly");
    run_with("kill -SEGV $$");
    EXPECT_EQ(status(again), Status::failed);
}

TEST_F(WorkerTest, RenderersIgnoreSighup) {
    const std::string id = submit();
    run_with("kill -HUP $$; " + leave_report("p", sha256_hex("p")));
    EXPECT_EQ(status(id), Status::done);
}

TEST_F(WorkerTest, ARendererThatSaysNothingFailsCleanly) {
    const std::string id = submit();
    run_with("exit 3");
    EXPECT_EQ(error(id).detail, "The renderer ended with exit code 3.");
}

TEST_F(WorkerTest, ARendererThatTakesTooLongIsStopped) {
    const std::string id = submit();
    m_options.time_limit = 200ms;
    run_with("sleep 60");
    EXPECT_EQ(error(id).title, "Rendering took too long");
}

TEST_F(WorkerTest, ARendererThatWritesTooMuchIsStopped) {
    const std::string id = submit();
    m_options.output_limit_bytes = 1'000'000;
    run_with(
        R"sh(mkdir -p "$4/a/b"; n=0; while :; do head -c 300000 /dev/zero >> "$4/a/b/$((n = n + 1))"; sleep 0.05; done)sh");
    EXPECT_EQ(error(id).title, "Rendering wrote too much");
    EXPECT_EQ(error(id).detail, "It wrote more than 1000000 bytes.");
    const std::string less = submit();
    run_with(leave_report("p", sha256_hex("p")));
    EXPECT_EQ(status(less), Status::done);
}

TEST_F(WorkerTest, AnIncompleteReportIsNotKept) {
    const std::string of_other_bytes = leave_report("picture", sha256_hex("other"));
    const std::string no_report = "mkdir $4";
    const std::string no_json = "mkdir $4; echo x > $4/report.json";
    for (const std::string& script : {of_other_bytes, no_report, no_json}) {
        const std::string id = submit();
        run_with(script);
        EXPECT_EQ(status(id), Status::queued);
        run_with(script);
        EXPECT_EQ(status(id), Status::failed) << script;
        // The log has the paths, but readers do not see them.
        EXPECT_EQ(error(id).detail, "The service's log says why.");
    }
    EXPECT_FALSE(m_blobs.open(sha256_hex("picture")));
}

TEST_F(WorkerTest, ProgressIsKept) {
    const std::string id = submit();
    std::string seen;
    std::thread watcher([&] {
        const auto reader = m_place->open(m_rules, m_clock);
        for (int i = 0; i < 500 && seen.empty(); ++i) {
            const auto record = reader->reports().find(id);
            if (record->progress == 0.5) seen = record->stage;
            std::this_thread::sleep_for(10ms);
        }
    });
    run_with(R"(echo '{"progress": 0.5, "stage": "timing"}'; sleep 1; exit 3)");
    watcher.join();
    EXPECT_EQ(seen, "timing");
    EXPECT_EQ(m_readiness.last_rendered_ms(), m_now_ms);
}

TEST_F(WorkerTest, ACancelledJobIsKilled) {
    const std::string id = submit();
    std::thread canceller([&] {
        const auto other = m_place->open(m_rules, m_clock);
        while (other->reports().find(id)->status != Status::running) std::this_thread::sleep_for(10ms);
        EXPECT_EQ(other->reports().remove(id), ReportArchive::Removal::cancelling);
    });
    run_with("sleep 60");
    canceller.join();
    EXPECT_EQ(status(id), Status::cancelled);
}

TEST_F(WorkerTest, AJobTakenByAnotherWorkerIsLeftToIt) {
    const std::string id = submit();
    std::thread thief([&] {
        const auto other = m_place->open(m_rules, m_clock);
        while (other->reports().find(id)->status != Status::running) std::this_thread::sleep_for(10ms);
        other->queue().end_leases_of("worker");
    });
    run_with("sleep 60");
    thief.join();
    EXPECT_EQ(status(id), Status::queued);
}

TEST_F(WorkerTest, AStopGivesTheJobBack) {
    const std::string id = submit();
    // Sent to this thread, since threads left by other tests do not block the signal.
    std::thread stopper([&, worker_thread = pthread_self()] {
        const auto other = m_place->open(m_rules, m_clock);
        while (other->reports().find(id)->status != Status::running) std::this_thread::sleep_for(10ms);
        pthread_kill(worker_thread, SIGTERM);
    });
    run_with("sleep 60");
    stopper.join();
    EXPECT_TRUE(m_stop.requested());
    EXPECT_EQ(status(id), Status::queued);
    EXPECT_EQ(lease().attempt, 1);
}

TEST_F(WorkerTest, AProbeRecordsThatItRendered) {
    m_options.program = "/bin/false";
    Worker(m_store, m_options, m_clock).probe(m_stop);
    EXPECT_FALSE(m_readiness.last_rendered_ms());
    m_options.program = "/bin/true";
    Worker(m_store, m_options, m_clock).probe(m_stop);
    EXPECT_EQ(m_readiness.last_rendered_ms(), m_now_ms);
}

TEST_F(WorkerTest, ScratchOfJobsThatDoNotRunIsSwept) {
    const std::string running = submit();
    const Lease job = lease();
    const std::filesystem::path scratch = m_options.scratch;
    std::filesystem::create_directories(scratch / (running + "-1"));
    std::filesystem::create_directories(scratch / (submit() + "-1"));
    std::filesystem::create_directories(scratch / "odd");
    sweep_scratch(scratch, m_reports);
    EXPECT_TRUE(std::filesystem::exists(scratch / (running + "-1")));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch), {}), 1);
    const ScratchFolder second(scratch, running, 2);
    EXPECT_FALSE(std::filesystem::exists(scratch / (running + "-1")));
}

TEST_F(WorkerTest, TheSupervisorReplacesWorkersAndEndsTheirLeases) {
    const std::string script = m_folder.file(
        "worker", fmt::format("#!/bin/sh\necho \"$3\" >> {}\nexec sleep 60\n", (m_folder.path() / "names").string()));
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    const auto name = [&](int index) {
        for (int i = 0; i < 500; ++i) {
            std::ifstream names(m_folder.path() / "names");
            std::string line;
            for (int skipped = 0; skipped <= index && std::getline(names, line); ++skipped)
                if (skipped == index) return line;
            std::this_thread::sleep_for(10ms);
        }
        return std::string();
    };
    Supervisor supervisor(m_queue, {.workers = 1, .program = script, .arguments = {"worker"}, .first_backoff = 10ms});
    const std::string first = name(0);
    ASSERT_NE(first, "");
    const std::string id = submit();
    m_queue.lease(first);
    // The name begins with our process id; the worker is our only child with that name.
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream children(entry.path() / "children");
        for (pid_t child; children >> child;) kill(child, SIGKILL);
    }
    const std::string second = name(1);
    EXPECT_NE(second, "");
    EXPECT_NE(second, first);
    EXPECT_EQ(status(id), Status::queued);
    supervisor.stop();
    EXPECT_EQ(name(1), second);
}

TEST(ReportFolder, PicturesOfReferencesAndResultsAreFoundOnce) {
    const auto image = [](const char* sha256) {
        return json{{"sha256", sha256}, {"url", "u"}, {"media_type", "image/png"}};
    };
    const json run = {
        {"reference", {{"images", {{"linear", image("c")}}}}},
        {"results",
         {{{"images", {{"color", image("a")}, {"flip", image("b")}}}}, {{"images", {{"color", image("a")}}}}}}};
    std::multiset<std::string> named;
    for (const BlobName& blob : named_blobs(from_document<report::Report>({{"runs", {run, run}}})))
        named.insert(blob.sha256);
    EXPECT_EQ(named, (std::multiset<std::string>{"a", "b", "c"}));
}

TEST(ReportFolder, APageIsNotAPicture) {
    const TemporaryFolder folder;
    const std::string sha256 = sha256_hex("<script>");
    folder.file(sha256, "<script>");
    for (const char* type : {"text/html", "image/svg+xml"}) {
        const json images = {{"color", {{"sha256", sha256}, {"url", "u"}, {"media_type", type}}}};
        folder.file("report.json", json{{"runs", {{{"reference", {{"images", images}}}}}}}.dump());
        EXPECT_THROW(read_report_folder(folder.path(), Lease{.spec = "{}"}, 0), StoreError) << type;
    }
}

TEST(ReportFolder, AReportWithWrongTypesIsRefusedByPointer) {
    const TemporaryFolder folder;
    folder.file("report.json", R"({"runs": [{"rounds": {"done": "three"}}]})");
    try {
        read_report_folder(folder.path(), Lease{.spec = "{}"}, 0);
        FAIL();
    } catch (const StoreError& error) {
        EXPECT_STREQ(error.what(),
                     "report.json is not a report: /runs/0/rounds/done must be a whole number, not \"three\"");
    }
}

}  // namespace
}  // namespace sheer::test::worker_test
