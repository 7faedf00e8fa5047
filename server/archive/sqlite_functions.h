#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string_view>

namespace sheer {

/// Functions that the archive's SQL calls; every connection that writes has them:
///
/// sheer_pack(text): pack_text() of it. sheer_sha256(text): lower-case hex. sheer_place(id): place_of() a report.
/// sheer_seal(...): SHA-256 of the values with their types and lengths, so that no other values have the same text.
/// sheer_with_place(places, slot, place), sheer_with_bit(bits, slot, 0 or 1): the bytes of a block with that changed,
/// and sheer_oldest(places), sheer_newest(places): its span (facet_bits.h).
void add_functions(SQLite::Database& database);

/// A number that grows with the time in a report's id (UUID version 7), and is unique but for ids of one millisecond
/// that two services made.
std::int64_t place_of(std::string_view id);
/// The place of the first id that could be made at this time.
std::int64_t place_at(std::int64_t time_ms);

}  // namespace sheer
