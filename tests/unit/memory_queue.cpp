#include <algorithm>

#include "memory_state.h"
#include "renderer/core/sha256.h"

namespace sheer::test::memory_store {

using nlohmann::json;

std::string lack_of_room(const Reading& state, std::int64_t now_ms) {
    for (const auto& [id, job] : state->jobs)
        if (job.record.status == Status::queued && job.lacks_room && job.not_before_ms > now_ms)
            return "a report did not fit and is tried again later";
    return "";
}

void requeue(Job& job, int attempts) {
    job.record.status = Status::queued;
    job.record.progress = 0;
    job.record.stage.clear();
    ++job.record.revision;
    job.attempts = attempts;
}

void end_attempt(Job& job, const JobError& error, Status status, std::int64_t now_ms) {
    if (status == Status::queued) return requeue(job, job.attempts);
    if (status != Status::done) job.blobs.clear();
    job.record.status = status;
    job.record.stage.clear();
    job.record.finished_ms = now_ms;
    ++job.record.revision;
    if (status == Status::failed) job.record.error = error;
}

TokenUse use_of(const Reading& state, std::int64_t now_ms, const std::string& token) {
    TokenUse use;
    for (const auto& [id, job] : state->jobs)
        if (job.sender && job.sender->token == token && !is_final(job.record.status)) ++use.jobs;
    for (const auto& [key, hour] : state->token_hours) {
        if (key.first != token || key.second <= now_ms / use_hour_ms - use_hours) continue;
        use.seconds += hour.seconds;
        use.upload_bytes += hour.upload_bytes;
        if (!use.less_at_ms) use.less_at_ms = (key.second + use_hours) * use_hour_ms;
    }
    return use;
}

namespace {

class Queue : public JobQueue {
  public:
    explicit Queue(const Base& base) : m_base(base) {}

    SubmitResult submit(const NewReport& report, const QueueLimits& limits) override {
        using Outcome = SubmitResult::Outcome;
        const Writing state(*m_base.state);
        for (const auto& [id, job] : state->jobs)
            if (report.idempotency && job.idempotency && job.idempotency->key == report.idempotency->key) {
                const bool same = job.idempotency->body_sha256 == report.idempotency->body_sha256;
                return {same ? Outcome::repeated : Outcome::key_reused, id};
            }
        std::int64_t queued = 0;
        double cost_mpx = 0;
        for (const auto& [id, job] : state->jobs) {
            if (job.record.status != Status::queued) continue;
            ++queued;
            cost_mpx += job.cost_mpx;
        }
        if (!limits.have_place(queued, cost_mpx, report.cost_mpx)) return {Outcome::queue_full, ""};
        if (report.sender)
            if (const auto no = refusal_of(*report.sender, use_of(state, m_base.clock(), report.sender->token)))
                return {*no, ""};
        if (const std::string lack = lack_of_room(state, m_base.clock()); !lack.empty()) throw StoreFull(lack);
        Job job{.facets = facets_of(json::parse(report.spec)),
                .idempotency = report.idempotency,
                .sender = report.sender,
                .cost_mpx = report.cost_mpx};
        job.record.id = report.id;
        job.record.revision = 1;
        job.record.created_ms = m_base.clock();
        job.record.spec = report.spec;
        job.record.spec_sha256 = report.spec_sha256;
        job.labels = wanted_devices(json::parse(report.spec));
        job.parts = static_cast<int>(listed_devices(json::parse(report.spec)).size());
        state->jobs.emplace(report.id, std::move(job));
        return {Outcome::created, report.id};
    }

    std::optional<Lease> lease(const std::string& owner, const std::string& label) override {
        const Writing state(*m_base.state);
        const std::int64_t now_ms = m_base.clock();
        for (auto& [id, job] : state->jobs)
            if (job.record.status == Status::running && job.lease_until_ms < now_ms) lose(job);
        for (auto& [id, job] : state->jobs) {
            if (job.record.status != Status::queued || job.not_before_ms > now_ms) continue;
            if (!job.labels.empty() && std::ranges::count(job.labels, label) == 0) continue;
            requeue(job, job.attempts + 1);
            job.record.status = Status::running;
            job.part = job.parts > 0 && !job.labels.empty() ? label : "";
            const int ended = static_cast<int>(job.ended.size());
            job.record.progress = parts_progress(ended, job.parts, 0);
            job.owner = owner;
            job.lease_until_ms = now_ms + m_base.rules.lease_ms;
            job.not_before_ms = 0;
            job.lacks_room = false;
            return Lease{id,
                         owner,
                         job.attempts,
                         job.record.spec,
                         job.record.spec_sha256,
                         job.record.created_ms,
                         job.setbacks,
                         job.part,
                         job.parts,
                         ended};
        }
        return std::nullopt;
    }

    LeaseState heartbeat(const Lease& lease, double progress, const std::string& stage) override {
        const Writing state(*m_base.state);
        Job* const job = find(state, lease);
        if (job == nullptr) return LeaseState::lost;
        count_time(state, *job);
        job->lease_until_ms = m_base.clock() + m_base.rules.lease_ms;
        job->record.revision += job->record.progress != progress || job->record.stage != stage;
        job->record.progress = std::clamp(progress, 0.0, 1.0);
        job->record.stage = stage;
        return state_of(job);
    }

    LeaseState state(const Lease& lease) override {
        const Reading state(*m_base.state);
        return state_of(find(state, lease));
    }

    bool commit(const Lease& lease, const FinishedReport& finished) override {
        std::map<std::string, Bytes> pictures;
        for (const BlobName& blob : finished.blobs) {
            std::string bytes = finished.read_blob(blob.sha256);
            if (sha256_hex(bytes) != blob.sha256) throw StoreError("a picture has another hash");
            pictures[blob.sha256] = {blob.media_type, std::move(bytes)};
        }
        const Writing state(*m_base.state);
        Job* const job = find(state, lease);
        if (state_of(job) == LeaseState::cancel_requested) end_attempt(*job, {}, Status::cancelled, m_base.clock());
        if (job == nullptr || job->record.status != Status::running) return false;
        count_time(state, *job);
        state->blobs.merge(pictures);
        state->last_rendered_ms = m_base.clock();
        if (!job->part.empty()) {
            job->blobs.insert(job->blobs.end(), finished.blobs.begin(), finished.blobs.end());
            end_part(*job, {.label = job->part, .report = finished.report.dump()});
            return true;
        }
        end_attempt(*job, {}, Status::done, finished.finished_ms);
        job->record.progress = 1;
        job->record.report = finished.report.dump();
        job->blobs = finished.blobs;
        job->died_of.reset();
        return true;
    }

    std::vector<EndedPart> ended_parts(const Lease& lease) override {
        const Reading state(*m_base.state);
        auto parts = state->jobs.at(lease.id).ended;
        std::ranges::sort(parts, {}, &EndedPart::label);
        return parts;
    }

    void fail(const Lease& lease, const JobError& error, bool retry) override {
        const Writing state(*m_base.state);
        if (Job* const job = find(state, lease)) {
            count_time(state, *job);
            const Status over = job->cancel_requested ? Status::cancelled : Status::failed;
            end(*job, error, retry ? after_lost_attempt(job->attempts, job->cancel_requested, m_base.rules) : over);
        }
    }

    void fail_by_signal(const Lease& lease, const JobError& error, int signal) override {
        const Writing state(*m_base.state);
        Job* const job = find(state, lease);
        if (job == nullptr) return;
        count_time(state, *job);
        const bool again = std::ranges::any_of(state->jobs, [&](const auto& each) {
            return each.second.record.spec_sha256 == lease.spec_sha256 && each.second.died_of == signal;
        });
        job->died_of = signal;
        const Status after = after_lost_attempt(job->attempts, job->cancel_requested, m_base.rules);
        end(*job, error, again && !job->cancel_requested ? Status::failed : after);
    }

    void set_back(const Lease& lease, const JobError& error, bool lacks_room) override {
        const Writing state(*m_base.state);
        Job* const job = find(state, lease);
        if (job == nullptr) return;
        if (job->cancel_requested) return end(*job, {}, Status::cancelled);
        if (++job->setbacks > m_base.rules.max_setbacks) return end(*job, error, Status::failed);
        requeue(*job, job->attempts - 1);
        job->record.stage = "waiting: " + error.detail;
        job->not_before_ms = m_base.clock() + setback_ms(job->setbacks, m_base.rules);
        job->lacks_room = lacks_room;
    }

    void cancel(const Lease& lease) override {
        const Writing state(*m_base.state);
        if (Job* const job = find(state, lease)) {
            count_time(state, *job);
            end(*job, {}, Status::cancelled);
        }
    }

    void release(const Lease& lease) override {
        const Writing state(*m_base.state);
        Job* const job = find(state, lease);
        if (job == nullptr) return;
        if (job->cancel_requested) return end(*job, {}, Status::cancelled);
        requeue(*job, job->attempts - 1);
    }

    void end_leases_of(const std::string& owner) override {
        const Writing state(*m_base.state);
        for (auto& [id, job] : state->jobs)
            if (job.record.status == Status::running && job.owner == owner) lose(job);
    }

  private:
    static Job* find(const Reading& state, const Lease& lease) {
        const auto found = state->jobs.find(lease.id);
        if (found == state->jobs.end()) return nullptr;
        Job& job = found->second;
        const bool held = job.record.status == Status::running && job.owner == lease.owner &&
                          job.attempts == lease.attempt && static_cast<int>(job.ended.size()) == lease.parts_ended;
        return held ? &job : nullptr;
    }

    void count_time(const Writing& state, const Job& job) const {
        if (!job.sender) return;
        const std::int64_t last_ms = job.lease_until_ms - m_base.rules.lease_ms;
        state->token_hours[{job.sender->token, m_base.clock() / use_hour_ms}].seconds +=
            static_cast<double>(m_base.clock() - last_ms) / 1000;
    }

    static LeaseState state_of(const Job* job) {
        if (job == nullptr) return LeaseState::lost;
        return job->cancel_requested ? LeaseState::cancel_requested : LeaseState::held;
    }

    void end(Job& job, const JobError& error, Status status) const {
        if (status == Status::failed && !job.part.empty()) return end_part(job, {.label = job.part, .error = error});
        end_attempt(job, error, status, m_base.clock());
    }

    void end_part(Job& job, const EndedPart& part) const {
        job.ended.push_back(part);
        std::erase(job.labels, part.label);
        job.part.clear();
        const bool all_failed = std::ranges::all_of(job.ended, [](const auto& one) { return one.error.has_value(); });
        if (job.labels.empty() && all_failed)
            return end_attempt(job, every_part_failed(job.ended), Status::failed, m_base.clock());
        requeue(job, 0);
        job.record.progress = parts_progress(static_cast<int>(job.ended.size()), job.parts, 0);
        job.setbacks = 0;
        job.died_of.reset();
    }

    void lose(Job& job) const {
        end(job, {"Rendering failed", "The worker died while it rendered this report."},
            after_lost_attempt(job.attempts, job.cancel_requested, m_base.rules));
    }

    const Base& m_base;
};

}  // namespace

std::unique_ptr<JobQueue> make_queue(const Base& base) {
    return std::make_unique<Queue>(base);
}

}  // namespace sheer::test::memory_store
