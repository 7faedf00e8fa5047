#include "server/postgres/report_rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/core/sha256.h"
#include "server/jobs/facets.h"
#include "server/jobs/search.h"
#include "server/storage/packed_text.h"

namespace sheer::postgres {

using nlohmann::json;

namespace {

/// PostgreSQL allows no longer words for searching.
constexpr std::size_t longest_word_bytes = 2000;

std::vector<std::string> indexed_words(const Facets& facets) {
    std::vector<std::string> words = search_words(facets);
    std::erase_if(words, [](const std::string& word) { return word.size() > longest_word_bytes; });
    return words;
}

}  // namespace

bool insert_report(Connection& connection, const NewReport& report, std::optional<std::int64_t> created_ms) {
    const Facets facets = facets_of(json::parse(report.spec));
    const auto& key = report.idempotency;
    const Rows inserted = connection.run(
        "INSERT INTO reports (id, created_ms, title, scene, methods, tags, spec_sha256, spec, idempotency_key, "
        "body_sha256, facets, words) VALUES ($1, coalesce($2, now_ms()), $3, $4, $5, $6, $7, $8, $9, $10, $11, "
        "array_to_tsvector($12)) ON CONFLICT (idempotency_key) DO NOTHING",
        {report.id, created_ms ? Value(*created_ms) : Value(nullptr), facets.title, facets.scene, facets.methods,
         facets.tags.dump(), report.spec_sha256, report.spec, key ? Value(key->key) : Value(nullptr),
         key ? Value(key->body_sha256) : Value(nullptr), facet_texts(facets, report.spec_sha256),
         indexed_words(facets)});
    return inserted.changed() > 0;
}

void finish_report(Connection& connection, const std::string& id, const FinishedReport& finished) {
    const std::string verdict = finished.report.value("verdict", ""), device = renderer_of(finished.report);
    const json preview = preview_of(finished.report);
    connection.run(
        "WITH job AS (DELETE FROM jobs WHERE report_id = $1 RETURNING revision) UPDATE reports SET status = 'done', "
        "progress = 1, revision = coalesce((SELECT revision FROM job), 0) + 1, finished_ms = $2, verdict = $3, device "
        "= "
        "$4, preview = $5, died_of = NULL, facets = facets || $6::text[] WHERE id = $1",
        {id, finished.finished_ms, verdict, device, preview.is_null() ? Value(nullptr) : Value(preview.dump()),
         outcome_facet_texts(verdict, device)});
    const std::string text = finished.report.dump(), packed = pack_text(text);
    connection.run("INSERT INTO documents VALUES ($1, $2, $3)", {id, sha256_hex(text), Bytes{packed}});
    if (!finished.numbers.names.empty()) add_numbers(connection, id, finished.numbers);
    connection.run("DELETE FROM parts WHERE report_id = $1", {id});
    name_pictures(connection, id, finished.blobs);
}

void name_pictures(Connection& connection, const std::string& id, const std::vector<BlobName>& blobs) {
    std::vector<std::string> pictures;
    for (const BlobName& blob : blobs) pictures.push_back(blob.sha256);
    connection.run(
        "INSERT INTO report_blobs SELECT DISTINCT $1, sha256 FROM unnest($2::text[]) sha256 ON CONFLICT DO NOTHING",
        {id, pictures});
}

int put_blobs(Connection& connection, const FinishedReport& finished, bool mend) {
    std::vector<BlobName> blobs = finished.blobs;
    // In one order, so that two transactions do not wait for each other.
    std::ranges::sort(blobs, {}, &BlobName::sha256);
    int written = 0;
    for (const BlobName& blob : blobs) {
        // The lock keeps a deletion away until the report names it.
        const Rows stored = connection.run(fmt::format("SELECT {} FROM blobs WHERE sha256 = $1 FOR KEY SHARE",
                                                       mend ? "encode(sha256(bytes), 'hex') = sha256" : "true"),
                                           {blob.sha256});
        if (!stored.empty() && stored.flag(0, 0)) continue;
        const std::string bytes = finished.read_blob(blob.sha256);
        if (sha256_hex(bytes) != blob.sha256)
            throw StoreError("the bytes of the picture " + blob.sha256 + " are others");
        connection.run(
            "INSERT INTO blobs VALUES ($1, $2, $3, $4) ON CONFLICT (sha256) DO UPDATE SET bytes = excluded.bytes, "
            "size_bytes = excluded.size_bytes",
            {blob.sha256, blob.media_type, static_cast<std::int64_t>(bytes.size()), Bytes{bytes}});
        ++written;
    }
    return written;
}

void add_numbers(Connection& connection, const std::string& report_id, const ReportNumbers& numbers) {
    const std::string hash = sha256_hex(numbers.names), packed = pack_numbers(numbers.numbers);
    connection.run("INSERT INTO number_names (sha256, names) VALUES ($1, $2) ON CONFLICT DO NOTHING",
                   {hash, numbers.names});
    connection.run(
        "INSERT INTO report_numbers SELECT $1, id, $3 FROM number_names WHERE sha256 = $2 FOR KEY SHARE ON CONFLICT DO "
        "NOTHING",
        {report_id, hash, Bytes{packed}});
}

}  // namespace sheer::postgres
