// Random damages to an archive are all found, and none is served. SHEER_DAMAGES says how many, SHEER_SEED with which
// seed.
#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdlib>
#include <fstream>
#include <random>

#include "server/storage/content_folder.h"
#include "store_fixture.h"

namespace sheer::test::damages_test {
namespace {

namespace fs = std::filesystem;

/// Everything that a database says, read without any of our code; "unreadable" if SQLite refuses. When a worker last
/// rendered is left out, since it is written again every second, and so are the counters.
std::string dump(const fs::path& file) {
    std::string all;
    try {
        SQLite::Database database(file.string(), SQLite::OPEN_READONLY);
        std::vector<std::string> tables = {"sqlite_schema"};
        SQLite::Statement names(database, "SELECT name FROM sqlite_schema WHERE type = 'table' ORDER BY name");
        while (names.executeStep()) tables.push_back(names.getColumn(0).getString());
        for (const std::string& table : tables) {
            if (table == "health" || table == "counters" || table == "search_words") continue;
            SQLite::Statement rows(database, "SELECT * FROM \"" + table + "\"");
            while (rows.executeStep())
                for (int i = 0; i < rows.getColumnCount(); ++i)
                    all += std::to_string(rows.getColumn(i).getType()) + rows.getColumn(i).getString() + "\x1f";
        }
        for (const char* pragma : {"PRAGMA application_id", "PRAGMA user_version"})
            all += database.execAndGet(pragma).getString() + "\x1f";
        SQLite::Statement check(database, "PRAGMA integrity_check");
        while (check.executeStep()) all += check.getColumn(0).getString();
        return all;
    } catch (const SQLite::Exception&) {
        return "unreadable";
    }
}

class DamagesTest : public WithSqlite {
  protected:
    /// An archive of which every table has rows, closed.
    void fill(const fs::path& data) {
        SqliteStore store(data, m_rules, m_clock);
        for (int i = 0; i < 12; ++i) {
            m_now_ms += 1;
            const nlohmann::json spec = {{"title", "report " + std::to_string(i)},
                                         {"scene", {{"type", i % 2 ? "quads" : "layers"}}},
                                         {"methods", {{{"id", "b2f"}}, {{"id", i % 3 ? "f2b" : "wboit"}}}},
                                         {"tags", {{"branch", i % 2 ? "main" : "topic"}}}};
            NewReport report{.id = m_ids.next(), .spec = spec.dump()};
            report.spec_sha256 = sha256_hex(report.spec);
            store.queue().submit(report, {100});
            const Lease job = *store.queue().lease("worker");
            if (i % 5 == 4) {
                store.queue().fail(job, {"Rendering failed", "as planned"}, false);
                continue;
            }
            FinishedReport made = finished(job, std::string(400, static_cast<char>('a' + i)) + "of it alone");
            made.report["device"] = {{"renderer", "llvmpipe"}};
            made.report["filler"] = std::string(static_cast<std::size_t>(300 * i), 'x') + std::to_string(i);
            EXPECT_TRUE(store.queue().commit(job, made));
            m_texts[job.id] = made.report.dump();
        }
        const std::string first = m_texts.begin()->first;
        store.baselines().accept({"main", first, 0, "me", "why"});
        store.pins().pin({first, 0, "me", "why"});
        for (const char* bytes : {"upload one", "upload two"})
            store.assets().add({.sha256 = sha256_hex(bytes),
                                .type = "texture",
                                .media_type = "image/png",
                                .size_bytes = 10,
                                .facts = {{"a", 1}}},
                               bytes);
        store.care().collect_garbage();
    }

    std::size_t below(std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(m_random); }

    static std::vector<fs::path> files_below(const fs::path& data) {
        std::vector<fs::path> files;
        for (const char* folder : {"blobs", "assets"})
            for (const auto& entry : fs::recursive_directory_iterator(data / folder))
                if (entry.is_regular_file()) files.push_back(entry.path());
        std::ranges::sort(files);
        return files;
    }

    void write_at(const fs::path& file, std::size_t at, const std::string& bytes) {
        std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekp(static_cast<std::streamoff>(at));
        stream << bytes;
    }

    char byte_at(const fs::path& file, std::size_t at) {
        std::ifstream stream(file, std::ios::binary);
        stream.seekg(static_cast<std::streamoff>(at));
        return static_cast<char>(stream.get());
    }

    void flip(const fs::path& file) {
        const std::size_t at = below(fs::file_size(file));
        write_at(file, at, std::string(1, static_cast<char>(byte_at(file, at) ^ (1 << below(8)))));
    }

    /// Returns what it did.
    std::string damage(const fs::path& data) {
        const std::vector<fs::path> files = files_below(data);
        const fs::path& file = files[below(files.size())];
        switch (below(6)) {
            case 0:
                flip(file);
                return "a bit of " + file.string();
            case 1:
                fs::resize_file(file, below(fs::file_size(file)));
                return "cut " + file.string();
            case 2:
                fs::remove(file);
                return "deleted " + file.string();
            case 3: {
                const fs::path& other = files[(below(files.size() - 1) + 1 + (&file - files.data())) % files.size()];
                fs::rename(file, data / "swapped");
                fs::rename(other, file);
                fs::rename(data / "swapped", other);
                return "swapped " + file.string() + " and " + other.string();
            }
            case 4:
                return damage_database(data, [&](const fs::path& database) { flip(database); });
            default:
                return damage_database(data, [&](const fs::path& database) {
                    std::string bytes(1 + below(64), '\0');
                    for (char& byte : bytes) byte = static_cast<char>(below(256));
                    write_at(database, below(fs::file_size(database) - bytes.size()), bytes);
                });
        }
    }

    /// Repeated until it hits something: pages have unused space.
    std::string damage_database(const fs::path& data, const std::function<void(const fs::path&)>& hit) {
        const fs::path file = data / "archive.sqlite", whole = data / "whole";
        fs::copy_file(file, whole);
        const std::string before = dump(file);
        int hits = 0;
        do {
            fs::copy_file(whole, file, fs::copy_options::overwrite_existing);
            hit(file);
            ++hits;
            for (const char* suffix : {"-wal", "-shm"}) fs::remove(file.string() + suffix);
        } while (dump(file) == before);
        fs::remove(whole);
        for (const char* suffix : {"-wal", "-shm"}) fs::remove(file.string() + suffix);
        return "the database, hit " + std::to_string(hits);
    }

    /// The first damage that is found, or ""; nothing that is served may differ from what was stored.
    std::string found(const fs::path& data) {
        try {
            SqliteStore store(data, m_rules, m_clock);
            for (const auto& [sha256, bytes] : m_pictures)
                serve([&] {
                    const auto blob = store.blobs().open(sha256);
                    return !blob || read_all(*blob->content, 1000) == bytes;
                });
            for (const auto& [id, text] : m_texts)
                serve([&, &wanted = text, &which = id] {
                    const auto record = store.reports().find(which);
                    return !record || record->status != Status::done || record->report == wanted;
                });
            for (const Finding& finding : store.care().check(false).findings)
                if (finding.kind == Finding::Kind::damage) return finding.text;
            return "";
        } catch (const StoreError& error) {
            return error.what();
        }
    }

    template <typename Serve>
    void serve(const Serve& is_right) {
        try {
            EXPECT_TRUE(is_right());
        } catch (const std::exception&) {
            ++m_refused;
        }
    }

    std::mt19937_64 m_random;
    std::map<std::string, std::string> m_texts;
    int m_refused = 0;
};

TEST_F(DamagesTest, EachIsFoundAndNoneIsServed) {
    const char* const wanted = std::getenv("SHEER_DAMAGES");
    const char* const given_seed = std::getenv("SHEER_SEED");
    const int count = wanted ? std::atoi(wanted) : 25;
    const auto seed = given_seed ? std::strtoull(given_seed, nullptr, 10) : std::random_device()();
    std::cout << "SHEER_SEED=" << seed << '\n';
    m_random.seed(seed);
    const fs::path data = m_folder.path() / "original", copy = m_folder.path() / "copy";
    fill(data);
    std::map<std::string, int> kinds;
    for (int i = 0; i < count; ++i) {
        fs::remove_all(copy);
        fs::copy(data, copy, fs::copy_options::recursive);
        const std::string what = damage(copy);
        ++kinds[what.substr(0, what.find_first_of(" ,", what.starts_with("cut") ? 0 : 4))];
        SCOPED_TRACE("damage " + std::to_string(i) + ": " + what);
        EXPECT_NE(found(copy), "") << "damage " << i << ": " << what;
    }
    for (const auto& [kind, times] : kinds) std::cout << times << " x " << kind << '\n';
    std::cout << m_refused << " requests refused\n";
    fs::remove_all(copy);
    fs::copy(data, copy, fs::copy_options::recursive);
    EXPECT_EQ(found(copy), "");
}

}  // namespace
}  // namespace sheer::test::damages_test
