#include "server/postgres/migrate.h"

#include <fmt/format.h>

#include <array>

#include "embedded_postgres_files.h"

namespace sheer::postgres {

namespace {

/// Each turns a store of one version into one of the next.
constexpr std::array<const char*, 3> migrations = {{"schema.sql", "quotas.sql", "parts.sql"}};

/// Any number that no other program is likely to lock.
constexpr std::int64_t lock_number = 0x5368656572;

std::string migration_text(const std::string& name) {
    for (const EmbeddedFile& file : embedded_postgres_files())
        if (file.path == name) return std::string(file.bytes);
    throw StoreError("the program was built without " + name);
}

/// 0 if there is no schema yet.
std::int64_t version_of(Connection& connection, const Address& address) {
    if (connection.run("SELECT 1 FROM pg_namespace WHERE nspname = 'sheer'").empty()) return 0;
    const StoreError foreign(
        fmt::format("{} has a schema \"sheer\" of another program; choose another database", address.text()));
    const Rows ours = connection.run(
        "SELECT 1 FROM information_schema.columns WHERE table_schema = 'sheer' AND table_name = 'store' AND "
        "column_name "
        "IN ('program', 'version')");
    if (ours.count() != 2) {
        // An administrator may have made an empty one, if the user may not.
        const auto any = "SELECT 1 FROM pg_class c JOIN pg_namespace n ON n.oid = relnamespace WHERE nspname = 'sheer'";
        if (connection.run(any).empty()) return 0;
        throw foreign;
    }
    const Rows row = connection.run("SELECT version FROM store WHERE program = 'sheer transparency'");
    if (row.empty()) throw foreign;
    return row.integer(0, 0);
}

void check_version(std::int64_t version, const Address& address) {
    if (version < 0 || version > schema_version())
        throw StoreError(fmt::format("the store in {} has version {}, but this program knows only version {}",
                                     address.text(), version, schema_version()));
}

}  // namespace

std::int64_t schema_version() {
    return static_cast<std::int64_t>(migrations.size());
}

void migrate(Connection& connection, const Address& address) {
    std::int64_t version = version_of(connection, address);
    check_version(version, address);
    if (version == schema_version()) return;
    if (connection.run("SELECT current_setting('server_encoding')").text(0, 0) != "UTF8")
        throw StoreError(fmt::format("{} has an encoding other than UTF-8", address.text()));
    connection.script("BEGIN");
    connection.run("SELECT pg_advisory_xact_lock($1)", {lock_number});
    version = version_of(connection, address);
    check_version(version, address);
    for (auto i = static_cast<std::size_t>(version); i < migrations.size(); ++i)
        connection.script(migration_text(migrations[i]));
    connection.run("UPDATE store SET version = $1", {schema_version()});
    connection.script("COMMIT");
}

}  // namespace sheer::postgres
