#include "server/worker/joining.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/core/exit_codes.h"
#include "renderer/spec/spec.h"
#include "server/jobs/facets.h"
#include "server/jobs/limits.h"
#include "server/worker/report_folder.h"

namespace sheer {

using nlohmann::json;

namespace {

/// In the order of the spec.
json told_parts(const json& spec, const std::vector<EndedPart>& parts) {
    json told = json::array();
    for (const std::string& label : listed_devices(spec)) {
        const auto part = std::ranges::find(parts, label, &EndedPart::label);
        if (part == parts.end()) throw StoreError("a part of the report is missing: " + label);
        const std::string reason = part->error ? fmt::format("{}: {}", part->error->title, part->error->detail) : "";
        told.push_back(
            {{"label", label}, {"reason", reason}, {"report", part->error ? json() : json::parse(part->report)}});
    }
    return told;
}

}  // namespace

std::string spec_to_render(const Lease& lease) {
    if (lease.part.empty()) return lease.spec;
    return spec_of_device(json::parse(lease.spec), lease.part).dump();
}

FinishedReport joined_report(Store& store, const Lease& lease, std::int64_t finished_ms, const std::string& data,
                             const ChildLimits& limits) {
    const json spec = json::parse(lease.spec);
    const std::string question =
        json{{"spec", spec}, {"parts", told_parts(spec, store.queue().ended_parts(lease))}}.dump();
    store.bring_here(question);
    const ChildReply reply = ask_child({"join-stored", "--data", data}, question, limits);
    const json line = json::parse(reply.line, nullptr, false);
    if (reply.status.code != exit_ok || !line.is_object() || !line.contains("report"))
        throw std::runtime_error("the parts were not joined: " + ending_text("join-stored", reply.status));
    FinishedReport finished = finished_report_of(from_document<report::Report>(line["report"]), lease, finished_ms);
    finished.read_blob = [&store](const std::string& sha256) {
        const auto blob = store.blobs().open(sha256);
        if (!blob) throw StoreError("a picture of a part is missing: " + sha256);
        return read_all(*blob->content, max_picture_bytes);
    };
    for (const BlobName& blob : finished.blobs) check_picture_name(blob);
    return finished;
}

}  // namespace sheer
