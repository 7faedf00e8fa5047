#pragma once
#include <cstdint>

#include "server/postgres/connection.h"

namespace sheer::postgres {

/// The version of a new store.
std::int64_t schema_version();

/// Brings the schema `sheer` of the database to the newest version, or makes it; processes that do so at the same time
/// wait for each other. Throws StoreError for a version that this program does not know, for a schema of that name that
/// is not ours, and for a database whose texts are not UTF-8.
void migrate(Connection& connection, const Address& address);

}  // namespace sheer::postgres
