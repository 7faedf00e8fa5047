#include "memory_store.h"

#include <algorithm>
#include <cstring>
#include <tuple>

#include "memory_state.h"
#include "renderer/core/sha256.h"
#include "server/jobs/search.h"

namespace sheer::test::memory_store {

using nlohmann::json;

class MemoryContent : public Content {
  public:
    MemoryContent(std::shared_ptr<MemoryState> state, std::string bytes)
        : m_state(std::move(state)), m_bytes(std::move(bytes)) {}
    std::uint64_t size_bytes() const override { return m_bytes.size(); }
    void read(std::uint64_t offset, std::span<char> bytes) const override {
        m_state->on_call();
        if (offset + bytes.size() > m_bytes.size()) throw StoreError("there are fewer bytes");
        std::memcpy(bytes.data(), m_bytes.data() + offset, bytes.size());
    }

  private:
    const std::shared_ptr<MemoryState> m_state;
    const std::string m_bytes;
};

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool contains(const std::string& text, const std::string& part) {
    return lowered(text).find(lowered(part)) != std::string::npos;
}

bool has_tag(const json& tags, const std::string& wanted) {
    const std::size_t colon = wanted.find(':');
    const auto found = tags.find(wanted.substr(0, colon));
    return found != tags.end() && (colon == std::string::npos || *found == wanted.substr(colon + 1));
}

/// Whether each word of `q` begins a word of the title or of a tag's value.
bool has_words(const Job& job, const std::string& q) {
    if (q.empty()) return true;
    std::string all = job.facets.title;
    for (const json& value : job.facets.tags) all += " " + value.get<std::string>();
    const std::vector<std::string> wanted = words_of(q), there = words_of(all);
    return !wanted.empty() && std::ranges::all_of(wanted, [&](const std::string& word) {
        return std::ranges::any_of(there, [&](const std::string& each) { return each.starts_with(word); });
    });
}

bool fits(const Job& job, const ListFilter& filter) {
    const auto has_method = [&](const std::string& id) {
        return std::ranges::count(job.facets.methods, lowered(id)) > 0;
    };
    const bool is_done = job.record.status == Status::done;
    const json report = is_done ? json::parse(job.record.report) : json::object();
    const std::string device = lowered(renderer_of(report));
    return has_words(job, filter.q) &&
           std::ranges::all_of(filter.tags, [&](const auto& tag) { return has_tag(job.facets.tags, tag); }) &&
           std::ranges::all_of(filter.methods, has_method) &&
           (filter.scene.empty() || job.facets.scene == filter.scene) &&
           (filter.device.empty() || device == lowered(filter.device) ||
            std::ranges::count(words_of(device), lowered(filter.device)) > 0) &&
           (filter.verdict.empty() || report.value("verdict", "") == filter.verdict) &&
           (filter.spec_sha256.empty() || job.record.spec_sha256 == filter.spec_sha256) &&
           (!filter.status || job.record.status == *filter.status) &&
           job.record.created_ms >= filter.since_ms.value_or(INT64_MIN) &&
           job.record.created_ms <= filter.until_ms.value_or(INT64_MAX);
}

ReportSummary summary_of(const Job& job) {
    const ReportRecord& record = job.record;
    ReportSummary summary{.id = record.id, .status = record.status, .progress = record.progress};
    summary.created_ms = record.created_ms;
    summary.finished_ms = record.finished_ms;
    summary.title = job.facets.title;
    summary.scene = job.facets.scene;
    summary.spec_sha256 = record.spec_sha256;
    summary.error = record.error;
    summary.methods = job.facets.methods;
    summary.tags = job.facets.tags;
    if (record.status != Status::done) return summary;
    const json report = json::parse(record.report);
    summary.verdict = report.value("verdict", "");
    summary.device = renderer_of(report);
    summary.preview = preview_of(report);
    return summary;
}

void room_was_made(const Reading& state) {
    for (auto& [id, job] : state->jobs)
        if (job.record.status == Status::queued && job.lacks_room) job.not_before_ms = 0;
}

bool is_named(const Reading& state, const std::string& sha256) {
    return std::ranges::any_of(state->jobs, [&](const auto& each) {
        return std::ranges::count(each.second.blobs, sha256, &BlobName::sha256) > 0;
    });
}

class Reports : public ReportArchive {
  public:
    explicit Reports(const Base& base) : m_base(base) {}

    std::optional<ReportRecord> find(const std::string& id) override {
        const Reading state(*m_base.state);
        const auto found = state->jobs.find(id);
        if (found == state->jobs.end()) return std::nullopt;
        const Job& job = found->second;
        ReportRecord record = job.record;
        if (job.parts > 0 && !is_final(record.status))
            record.parts = part_states(listed_devices(json::parse(record.spec)), job.ended,
                                       record.status == Status::running ? job.part : "");
        return record;
    }

    ReportPage list(const ListFilter& filter) override {
        const Reading state(*m_base.state);
        ReportPage page;
        for (auto each = state->jobs.rbegin(); each != state->jobs.rend(); ++each) {
            if (!fits(each->second, filter)) continue;
            page.count_is_exact = page.count < max_exact_count;
            if (page.count_is_exact) ++page.count;
            if (page.more || (!filter.before_id.empty() && each->first >= filter.before_id)) continue;
            page.more = static_cast<int>(page.reports.size()) == filter.limit;
            if (page.more) continue;
            page.reports.push_back(summary_of(each->second));
            page.reports.back().pinned = state->pins.contains(each->first);
        }
        return page;
    }

    Removal remove(const std::string& id) override {
        const Writing state(*m_base.state);
        const auto found = state->jobs.find(id);
        if (found == state->jobs.end()) return Removal::not_found;
        Job& job = found->second;
        if (job.record.status == Status::queued) {
            end_attempt(job, {}, Status::cancelled, m_base.clock());
            return Removal::cancelled;
        }
        if (job.record.status == Status::running) {
            job.cancel_requested = true;
            return Removal::cancelling;
        }
        if (std::ranges::count(state->accepted, id, &AcceptedReport::report_id) > 0) return Removal::accepted;
        if (state->pins.contains(id)) return Removal::pinned;
        state->jobs.erase(found);
        std::erase_if(state->blobs, [&](const auto& blob) { return !is_named(state, blob.first); });
        room_was_made(state);
        return Removal::deleted;
    }

  private:
    const Base& m_base;
};

class Pictures : public Blobs {
  public:
    explicit Pictures(const Base& base) : m_base(base) {}

    std::optional<Blob> open(const std::string& sha256) override {
        const Reading state(*m_base.state);
        const auto found = state->blobs.find(sha256);
        if (found == state->blobs.end() || !is_named(state, sha256)) return std::nullopt;
        return Blob{found->second.media_type, std::make_shared<MemoryContent>(m_base.state, found->second.bytes)};
    }

  private:
    const Base& m_base;
};

class Uploads : public Assets {
  public:
    explicit Uploads(const Base& base) : m_base(base) {}

    void add(const Asset& asset, const std::string& bytes) override {
        const Writing state(*m_base.state);
        if (const std::string lack = lack_of_room(state, m_base.clock()); !lack.empty()) throw StoreFull(lack);
        if (sha256_hex(bytes) != asset.sha256) throw StoreError("an upload has another hash");
        if (state->assets.contains(asset.sha256)) return;
        KeptAsset kept{asset, bytes, ++state->assets_added};
        kept.asset.created_ms = m_base.clock();
        state->assets.emplace(asset.sha256, std::move(kept));
    }

    std::optional<Asset> find(const std::string& sha256) override {
        const auto opened = open(sha256);
        if (!opened) return std::nullopt;
        return opened->asset;
    }

    std::optional<OpenAsset> open(const std::string& sha256) override {
        const Reading state(*m_base.state);
        const auto found = state->assets.find(sha256);
        if (found == state->assets.end()) return std::nullopt;
        return OpenAsset{found->second.asset, std::make_shared<MemoryContent>(m_base.state, found->second.bytes)};
    }

    std::vector<Asset> list(int limit) override {
        const Reading state(*m_base.state);
        std::vector<KeptAsset> kept;
        for (const auto& [sha256, asset] : state->assets) kept.push_back(asset);
        std::ranges::sort(kept, std::greater<>(), &KeptAsset::order);
        std::vector<Asset> assets;
        for (const KeptAsset& each : kept)
            if (static_cast<int>(assets.size()) < limit) assets.push_back(each.asset);
        return assets;
    }

    Removal remove(const std::string& sha256) override {
        const Writing state(*m_base.state);
        if (!state->assets.contains(sha256)) return Removal::not_found;
        for (const auto& [id, job] : state->jobs)
            if (!is_final(job.record.status) && contains(job.record.spec, sha256)) return Removal::in_use;
        state->assets.erase(sha256);
        room_was_made(state);
        return Removal::removed;
    }

  private:
    const Base& m_base;
};

class Named : public Baselines {
  public:
    explicit Named(const Base& base) : m_base(base) {}

    Acceptance accept(const AcceptedReport& accepted) override {
        const Writing state(*m_base.state);
        const auto found = state->jobs.find(accepted.report_id);
        if (found == state->jobs.end()) return Acceptance::not_found;
        if (found->second.record.status != Status::done) return Acceptance::not_done;
        const auto known = std::erase_if(state->accepted, [&](const AcceptedReport& one) {
            return one.name == accepted.name && one.report_id == accepted.report_id;
        });
        state->accepted.push_back(accepted);
        state->accepted.back().accepted_ms = m_base.clock();
        return known > 0 ? Acceptance::renewed : Acceptance::added;
    }

    std::vector<AcceptedReport> list(const std::string& name) override {
        const Reading state(*m_base.state);
        std::vector<AcceptedReport> all;
        for (const AcceptedReport& one : state->accepted)
            if (name.empty() || one.name == name) all.push_back(one);
        std::ranges::sort(all, [](const AcceptedReport& a, const AcceptedReport& b) {
            return std::tuple(a.name, b.accepted_ms, b.report_id) < std::tuple(b.name, a.accepted_ms, a.report_id);
        });
        return all;
    }

    std::size_t forget(const std::string& name, const std::string& report_id) override {
        const Writing state(*m_base.state);
        return std::erase_if(state->accepted, [&](const AcceptedReport& one) {
            return one.name == name && (report_id.empty() || one.report_id == report_id);
        });
    }

  private:
    const Base& m_base;
};

class Kept : public Pins {
  public:
    explicit Kept(const Base& base) : m_base(base) {}

    Pinning pin(const Pin& pin) override {
        const Writing state(*m_base.state);
        const auto found = state->jobs.find(pin.report_id);
        if (found == state->jobs.end()) return Pinning::not_found;
        if (!is_final(found->second.record.status)) return Pinning::not_final;
        Pin now = pin;
        now.pinned_ms = m_base.clock();
        return state->pins.insert_or_assign(pin.report_id, now).second ? Pinning::added : Pinning::renewed;
    }

    std::optional<Pin> find(const std::string& report_id) override {
        const Reading state(*m_base.state);
        const auto found = state->pins.find(report_id);
        return found == state->pins.end() ? std::nullopt : std::optional(found->second);
    }

    bool unpin(const std::string& report_id) override { return Writing(*m_base.state)->pins.erase(report_id) > 0; }

  private:
    const Base& m_base;
};

/// The care of files and databases has its own tests.
class NoCare : public Care {
  public:
    CheckResult check(bool) override { return {}; }
    Garbage collect_garbage() override { return {}; }
    BackupResult back_up(const std::filesystem::path&) override { throw StoreError("there is nothing to copy"); }
    std::vector<StoredReport> stored_reports() override { return {}; }
    Import import_report(const ImportedReport&) override { throw StoreError("nothing can be imported"); }
    StoreSize size() override { return {}; }
};

class NoActivity : public Activity {
  public:
    ActivityCounts counts() override { return {}; }
};

class Seen : public Workers {
  public:
    explicit Seen(const Base& base) : m_base(base) {}
    void note(const SeenWorker& worker) override {
        SeenWorker& kept = Writing(*m_base.state)->workers[worker.label + " " + worker.name];
        kept = worker;
        kept.seen_ms = m_base.clock();
    }
    std::vector<SeenWorker> list(std::int64_t age_ms) override {
        const Reading state(*m_base.state);
        std::vector<SeenWorker> all;
        for (auto [key, worker] : state->workers) {
            for (const auto& [id, job] : state->jobs)
                if (job.record.status == Status::running && job.owner == worker.name) {
                    worker.job = id;
                    worker.seen_ms = std::max(worker.seen_ms, job.lease_until_ms - m_base.rules.lease_ms);
                }
            if (worker.seen_ms >= m_base.clock() - age_ms) all.push_back(worker);
        }
        return all;
    }

  private:
    const Base& m_base;
};

class Used : public Usage {
  public:
    explicit Used(const Base& base) : m_base(base) {}
    TokenUse of(const std::string& token) override { return use_of(Reading(*m_base.state), m_base.clock(), token); }
    void add_upload(const std::string& token, std::int64_t bytes) override {
        Writing(*m_base.state)->token_hours[{token, m_base.clock() / use_hour_ms}].upload_bytes += bytes;
    }

  private:
    const Base& m_base;
};

class NoTrends : public Trends {
  public:
    std::vector<TrendReport> reports(const ListFilter&) override { return {}; }
    void keep(const std::string&, const ReportNumbers&) override {}
};

class Health : public Readiness {
  public:
    explicit Health(const Base& base) : m_base(base) {}
    void note_rendered() override { Writing(*m_base.state)->last_rendered_ms = m_base.clock(); }
    std::optional<std::int64_t> last_rendered_ms() override { return Reading(*m_base.state)->last_rendered_ms; }
    std::string lack_of_room() override { return memory_store::lack_of_room(Reading(*m_base.state), m_base.clock()); }

  private:
    const Base& m_base;
};

class Watch : public ChangeWatch {
  public:
    explicit Watch(std::shared_ptr<MemoryState> state) : m_state(std::move(state)), m_seen(Reading(*m_state)->writes) {}

    bool wait(std::chrono::milliseconds limit) override {
        m_state->on_call();
        std::unique_lock lock(m_state->mutex);
        const bool changed = m_state->written.wait_for(lock, limit, [this] { return m_state->writes != m_seen; });
        m_seen = m_state->writes;
        return changed;
    }

  private:
    const std::shared_ptr<MemoryState> m_state;
    std::uint64_t m_seen;
};

}  // namespace sheer::test::memory_store

namespace sheer::test {

std::shared_ptr<MemoryState> make_memory_state() {
    return std::make_shared<MemoryState>();
}

struct MemoryStore::Parts {
    memory_store::Base base;
    std::unique_ptr<JobQueue> queue = memory_store::make_queue(base);
    memory_store::Reports reports{base};
    memory_store::Pictures blobs{base};
    memory_store::Uploads assets{base};
    memory_store::Named baselines{base};
    memory_store::Kept pins{base};
    memory_store::Health readiness{base};
    memory_store::NoCare care;
    memory_store::NoTrends trends;
    memory_store::NoActivity activity;
    memory_store::Seen workers{base};
    memory_store::Used usage{base};
};

MemoryStore::MemoryStore(std::shared_ptr<MemoryState> state, LeaseRules rules, ClockMs clock)
    : m_parts(std::make_unique<Parts>(memory_store::Base{std::move(state), rules, std::move(clock)})) {}

MemoryStore::~MemoryStore() = default;

JobQueue& MemoryStore::queue() {
    return *m_parts->queue;
}
ReportArchive& MemoryStore::reports() {
    return m_parts->reports;
}
Blobs& MemoryStore::blobs() {
    return m_parts->blobs;
}
Assets& MemoryStore::assets() {
    return m_parts->assets;
}
Baselines& MemoryStore::baselines() {
    return m_parts->baselines;
}
Pins& MemoryStore::pins() {
    return m_parts->pins;
}
Readiness& MemoryStore::readiness() {
    return m_parts->readiness;
}
Care& MemoryStore::care() {
    return m_parts->care;
}
Trends& MemoryStore::trends() {
    return m_parts->trends;
}
Activity& MemoryStore::activity() {
    return m_parts->activity;
}
Workers& MemoryStore::workers() {
    return m_parts->workers;
}
Usage& MemoryStore::usage() {
    return m_parts->usage;
}
std::unique_ptr<ChangeWatch> MemoryStore::watch() {
    return std::make_unique<memory_store::Watch>(m_parts->base.state);
}

}  // namespace sheer::test
