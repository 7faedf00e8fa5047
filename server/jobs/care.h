#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/jobs/job_queue.h"

namespace sheer {

/// Something that a check found.
struct Finding {
    enum class Kind {
        damage,   ///< something that was stored is missing or different
        leftover  ///< something that nothing refers to; collect_garbage() removes it
    };
    Kind kind = Kind::damage;
    std::string text;  ///< a sentence that names what it is about
};

struct CheckResult {
    std::vector<Finding> findings;
    std::vector<std::string> repairs;  ///< what was done, as sentences
    std::int64_t reports = 0, pictures = 0, uploads = 0;
    std::uint64_t bytes = 0;  ///< of the files that were read

    bool is_damaged() const;
};

/// What collect_garbage() removed.
struct Garbage {
    std::int64_t files = 0, rows = 0;
    std::uint64_t bytes = 0;
};

struct BackupResult {
    std::int64_t reports = 0, pictures = 0, uploads = 0;
    std::uint64_t bytes = 0;
    std::vector<std::string> damaged;  ///< what could not be copied as it was stored, as sentences
};

/// A report that has ended, for deciding whether it is kept.
struct StoredReport {
    std::string id;
    std::int64_t created_ms = 0;
    nlohmann::json tags = nlohmann::json::object();
    bool is_kept = false;  ///< pinned, or accepted in a baseline
    /// What its deletion would free if all older ones were deleted before: its text, and the pictures that no newer
    /// report names.
    std::uint64_t bytes = 0;
};

/// A done report of another store.
struct ImportedReport {
    std::string id;
    std::int64_t created_ms = 0;
    std::string spec;  ///< canonical text
    std::string spec_sha256;
    FinishedReport finished;
};

/// How much a store holds.
struct StoreSize {
    std::uint64_t database_bytes = 0, picture_bytes = 0, upload_bytes = 0;
    std::int64_t reports = 0, pictures = 0, uploads = 0;
};

/// The care of a store, beside a running service.
class Care {
  public:
    virtual ~Care() = default;
    /// Reads everything and compares it with its hashes and with what refers to it. `repair`: moves what is damaged or
    /// left over into a quarantine, and makes again what can be derived; nothing is deleted.
    virtual CheckResult check(bool repair) = 0;
    /// Removes what nothing refers to.
    virtual Garbage collect_garbage() = 0;
    /// Copies the state of one moment, with everything that was done before it, into a folder, which must not exist or
    /// be empty. The copy has the form of a data folder. Throws StoreError.
    virtual BackupResult back_up(const std::filesystem::path& folder) = 0;
    /// Newest first.
    virtual std::vector<StoredReport> stored_reports() = 0;
    enum class Import { added, known, restored, differs };
    /// Adds a done report with its pictures; one that is there already gets the pictures that it lacks. Throws
    /// StoreFull, and StoreError, also if a picture has another hash.
    virtual Import import_report(const ImportedReport& report) = 0;
    virtual StoreSize size() = 0;
};

inline bool CheckResult::is_damaged() const {
    for (const Finding& finding : findings)
        if (finding.kind == Finding::Kind::damage) return true;
    return false;
}

}  // namespace sheer
