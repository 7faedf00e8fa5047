#include "server/archive/facet_bits.h"

#include <SQLiteCpp/VariadicBind.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <map>
#include <utility>

namespace sheer {

namespace {

static_assert(std::endian::native == std::endian::little, "the archive's bytes have the lowest first");

template <typename Numbers>
Numbers numbers_in(std::string_view bytes) {
    Numbers numbers{};
    std::memcpy(numbers.data(), bytes.data(), std::min(bytes.size(), sizeof(Numbers)));
    return numbers;
}

template <typename Numbers>
std::string bytes_from(const Numbers& numbers) {
    std::string bytes(sizeof(Numbers), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

std::string_view blob_in(const SQLite::Column& column) {
    return {static_cast<const char*>(column.getBlob()), static_cast<std::size_t>(column.getBytes())};
}

void insert_with(SQLite::Statement& statement, int index, const std::string& bytes) {
    statement.bind(index, bytes.data(), static_cast<int>(bytes.size()));
    statement.exec();
    statement.reset();
}

struct FoundBlock {
    std::int64_t block = 0, newest = 0;
    BlockBits bits{};
};

/// The blocks in which some slot has all facets.
std::vector<FoundBlock> blocks_with_all(SQLite::Database& database, const std::vector<std::int64_t>& facets) {
    std::vector<FoundBlock> found;
    SQLite::Statement rows(database, "SELECT block, bits FROM facet_bits WHERE facet = ? ORDER BY block");
    for (std::size_t i = 0; i < facets.size(); ++i) {
        rows.bind(1, facets[i]);
        std::vector<FoundBlock> both;
        for (auto known = found.begin(); rows.executeStep();) {
            FoundBlock next{rows.getColumn(0).getInt64(), 0, bits_in(blob_in(rows.getColumn(1)))};
            if (i > 0) {
                while (known != found.end() && known->block < next.block) ++known;
                if (known == found.end()) break;
                if (known->block > next.block) continue;
                std::ranges::transform(next.bits, known->bits, next.bits.begin(), std::bit_and());
            }
            if (std::ranges::any_of(next.bits, [](std::uint64_t word) { return word != 0; })) both.push_back(next);
        }
        rows.reset();
        found = std::move(both);
    }
    return found;
}

/// Those with places in this range, the newest block first.
std::vector<FoundBlock> in_range(SQLite::Database& database, const std::vector<FoundBlock>& all, PlaceRange range) {
    std::vector<FoundBlock> blocks;
    SQLite::Statement row(database, "SELECT newest FROM search_blocks WHERE block = ? AND newest >= ? AND oldest < ?");
    for (FoundBlock block : all) {
        SQLite::bind(row, block.block, range.from, range.before);
        if (row.executeStep()) {
            block.newest = row.getColumn(0).getInt64();
            blocks.push_back(block);
        }
        row.reset();
    }
    std::ranges::sort(blocks, std::greater(), &FoundBlock::newest);
    return blocks;
}

void keep_newest(std::vector<std::int64_t>& places, std::size_t limit) {
    std::ranges::sort(places, std::greater());
    if (places.size() > limit) places.resize(limit);
}

using Blocks = std::map<std::int64_t, BlockPlaces>;
using Bits = std::map<std::pair<std::int64_t, std::int64_t>, BlockBits>;

/// As they should be.
std::pair<Blocks, Bits> blocks_and_bits(SQLite::Database& database) {
    Blocks blocks;
    SQLite::Statement lines(database, "SELECT place, slot FROM search_lines");
    while (lines.executeStep()) {
        const std::int64_t slot = lines.getColumn(1).getInt64();
        blocks[slot / slots_in_block][static_cast<std::size_t>(slot % slots_in_block)] = lines.getColumn(0).getInt64();
    }
    Bits bits;
    SQLite::Statement rows(database, "SELECT facet, slot FROM report_facets JOIN search_lines USING (place)");
    while (rows.executeStep()) {
        const std::int64_t slot = rows.getColumn(1).getInt64();
        const auto at = static_cast<std::size_t>(slot % slots_in_block);
        bits[{rows.getColumn(0).getInt64(), slot / slots_in_block}][at / 64] |= std::uint64_t{1} << (at % 64);
    }
    return {std::move(blocks), std::move(bits)};
}

}  // namespace

PlaceSpan span_of(const BlockPlaces& places) {
    PlaceSpan span;
    for (const std::int64_t place : places) {
        if (place == 0) continue;
        span.oldest = span.newest == 0 ? place : std::min(span.oldest, place);
        span.newest = std::max(span.newest, place);
    }
    return span;
}

BlockPlaces places_in(std::string_view bytes) {
    return numbers_in<BlockPlaces>(bytes);
}

BlockBits bits_in(std::string_view bytes) {
    return numbers_in<BlockBits>(bytes);
}

std::string block_bytes(const BlockPlaces& places) {
    return bytes_from(places);
}

std::string block_bytes(const BlockBits& bits) {
    return bytes_from(bits);
}

std::vector<std::int64_t> newest_with_all(SQLite::Database& database, const std::vector<std::int64_t>& facets,
                                          PlaceRange range, std::size_t limit) {
    std::vector<std::int64_t> places;
    SQLite::Statement row(database, "SELECT places FROM search_blocks WHERE block = ?");
    for (const FoundBlock& block : in_range(database, blocks_with_all(database, facets), range)) {
        if (places.size() >= limit) {
            keep_newest(places, limit);
            if (places.empty() || places.back() > block.newest) break;
        }
        row.bind(1, block.block);
        if (row.executeStep()) {
            const BlockPlaces all = places_in(blob_in(row.getColumn(0)));
            for (std::size_t slot = all.size(); slot-- > 0;)
                if ((block.bits[slot / 64] >> (slot % 64) & 1) != 0 && all[slot] >= range.from &&
                    all[slot] < range.before)
                    places.push_back(all[slot]);
        }
        row.reset();
    }
    keep_newest(places, limit);
    return places;
}

void rebuild_facet_bits(SQLite::Database& database) {
    database.exec("DELETE FROM search_blocks; DELETE FROM facet_bits");
    const auto [blocks, bits] = blocks_and_bits(database);
    SQLite::Statement block(database, "INSERT INTO search_blocks VALUES (?, ?, ?, ?)");
    for (const auto& [number, places] : blocks) {
        const PlaceSpan span = span_of(places);
        SQLite::bind(block, number, span.oldest, span.newest);
        insert_with(block, 4, block_bytes(places));
    }
    SQLite::Statement marks(database, "INSERT INTO facet_bits VALUES (?, ?, ?)");
    for (const auto& [key, words] : bits) {
        SQLite::bind(marks, key.first, key.second);
        insert_with(marks, 3, block_bytes(words));
    }
}

bool facet_bits_are_right(SQLite::Database& database) {
    auto [blocks, bits] = blocks_and_bits(database);
    SQLite::Statement block(database, "SELECT block, oldest, newest, places FROM search_blocks");
    while (block.executeStep()) {
        const auto wanted = blocks.find(block.getColumn(0).getInt64());
        if (wanted == blocks.end()) return false;
        const PlaceSpan span = span_of(wanted->second);
        if (block.getColumn(1).getInt64() != span.oldest || block.getColumn(2).getInt64() != span.newest ||
            blob_in(block.getColumn(3)) != block_bytes(wanted->second))
            return false;
        blocks.erase(wanted);
    }
    SQLite::Statement marks(database, "SELECT facet, block, bits FROM facet_bits");
    while (marks.executeStep()) {
        const auto wanted = bits.find({marks.getColumn(0).getInt64(), marks.getColumn(1).getInt64()});
        if (wanted == bits.end() || blob_in(marks.getColumn(2)) != block_bytes(wanted->second)) return false;
        bits.erase(wanted);
    }
    return blocks.empty() && bits.empty();
}

}  // namespace sheer
