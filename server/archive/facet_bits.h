#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sheer {

inline constexpr int slots_in_block = 1024;

/// The place in each slot of a block, 0 for an empty one, and which slots have a facet: as search_blocks and facet_bits
/// have them. Missing bytes are 0.
using BlockPlaces = std::array<std::int64_t, slots_in_block>;
using BlockBits = std::array<std::uint64_t, slots_in_block / 64>;

BlockPlaces places_in(std::string_view bytes);
BlockBits bits_in(std::string_view bytes);
std::string block_bytes(const BlockPlaces& places);
std::string block_bytes(const BlockBits& bits);

/// The least and the greatest place of a block; 0 if it is empty.
struct PlaceSpan {
    std::int64_t oldest = 0, newest = 0;
};
PlaceSpan span_of(const BlockPlaces& places);

/// From a place, and before another one.
struct PlaceRange {
    std::int64_t from = 0, before = INT64_MAX;
};

/// The places of the newest reports in this range that have all of these facets, newest first. Reads the bits of each
/// facet, and the places of only those blocks that have such reports.
std::vector<std::int64_t> newest_with_all(SQLite::Database& database, const std::vector<std::int64_t>& facets,
                                          PlaceRange range, std::size_t limit);

/// Makes all blocks and bits again.
void rebuild_facet_bits(SQLite::Database& database);

/// Whether the blocks and bits are exactly those of the reports and their facets.
bool facet_bits_are_right(SQLite::Database& database);

}  // namespace sheer
