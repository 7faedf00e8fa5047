#include "server/archive/sqlite_functions.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <charconv>
#include <exception>
#include <iterator>
#include <string>

#include "renderer/core/sha256.h"
#include "server/archive/facet_bits.h"
#include "server/storage/packed_text.h"

namespace sheer {

namespace {

constexpr int counter_bits = 12;

std::string_view bytes_of(sqlite3_value* value) {
    const auto* const bytes = static_cast<const char*>(sqlite3_value_blob(value));
    return {bytes == nullptr ? "" : bytes, static_cast<std::size_t>(sqlite3_value_bytes(value))};
}

void give_text(sqlite3_context* context, const std::string& text) {
    sqlite3_result_text64(context, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
}

void pack(sqlite3_context* context, const std::string& text) {
    const std::string packed = pack_text(text);
    sqlite3_result_blob64(context, packed.data(), packed.size(), SQLITE_TRANSIENT);
}

void hash(sqlite3_context* context, const std::string& text) {
    give_text(context, sha256_hex(text));
}

void place(sqlite3_context* context, const std::string& id) {
    sqlite3_result_int64(context, place_of(id));
}

/// An exception must not pass through SQLite.
template <void (*work)(sqlite3_context*, const std::string&)>
void of_text(sqlite3_context* context, int, sqlite3_value** values) {
    try {
        work(context, std::string(bytes_of(values[0])));
    } catch (const std::exception& error) {
        sqlite3_result_error(context, error.what(), -1);
    }
}

void seal(sqlite3_context* context, int count, sqlite3_value** values) {
    try {
        std::string all;
        for (int i = 0; i < count; ++i) {
            const int type = sqlite3_value_type(values[i]);
            const std::string_view bytes = type == SQLITE_NULL ? "" : bytes_of(values[i]);
            all += fmt::format("{}:{}:{};", type, bytes.size(), bytes);
        }
        give_text(context, sha256_hex(all));
    } catch (const std::exception& error) {
        sqlite3_result_error(context, error.what(), -1);
    }
}

void give_blob(sqlite3_context* context, const std::string& bytes) {
    sqlite3_result_blob64(context, bytes.data(), bytes.size(), SQLITE_TRANSIENT);
}

std::size_t slot_in(sqlite3_value* value) {
    return static_cast<std::size_t>(sqlite3_value_int64(value)) % slots_in_block;
}

void with_place(sqlite3_context* context, int, sqlite3_value** values) {
    BlockPlaces places = places_in(bytes_of(values[0]));
    places[slot_in(values[1])] = sqlite3_value_int64(values[2]);
    give_blob(context, block_bytes(places));
}

void with_bit(sqlite3_context* context, int, sqlite3_value** values) {
    BlockBits bits = bits_in(bytes_of(values[0]));
    const std::size_t slot = slot_in(values[1]);
    const std::uint64_t bit = std::uint64_t{1} << (slot % 64);
    if (sqlite3_value_int(values[2]) != 0)
        bits[slot / 64] |= bit;
    else
        bits[slot / 64] &= ~bit;
    give_blob(context, block_bytes(bits));
}

void give_oldest(sqlite3_context* context, int, sqlite3_value** values) {
    sqlite3_result_int64(context, span_of(places_in(bytes_of(values[0]))).oldest);
}

void give_newest(sqlite3_context* context, int, sqlite3_value** values) {
    sqlite3_result_int64(context, span_of(places_in(bytes_of(values[0]))).newest);
}

using Function = void (*)(sqlite3_context*, int, sqlite3_value**);

void add(SQLite::Database& database, const char* name, int arguments, Function function) {
    constexpr bool same_for_same_values = true;
    database.createFunction(name, arguments, same_for_same_values, nullptr, function);
}

}  // namespace

void add_functions(SQLite::Database& database) {
    add(database, "sheer_pack", 1, of_text<pack>);
    add(database, "sheer_sha256", 1, of_text<hash>);
    add(database, "sheer_place", 1, of_text<place>);
    add(database, "sheer_seal", -1, seal);
    add(database, "sheer_with_place", 3, with_place);
    add(database, "sheer_with_bit", 3, with_bit);
    add(database, "sheer_oldest", 1, give_oldest);
    add(database, "sheer_newest", 1, give_newest);
}

std::int64_t place_of(std::string_view id) {
    // The first 48 bits are the time, and the 12 bits after the version's digit count.
    std::string digits;
    std::ranges::copy_if(id.substr(0, 18), std::back_inserter(digits), [](char c) { return c != '-'; });
    if (digits.size() == 16) digits.erase(12, 1);
    std::int64_t number = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
    return number;
}

std::int64_t place_at(std::int64_t time_ms) {
    return std::clamp<std::int64_t>(time_ms, 0, (std::int64_t{1} << 48) - 1) << counter_bits;
}

}  // namespace sheer
