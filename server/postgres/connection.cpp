#include "server/postgres/connection.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace sheer::postgres {

namespace {

/// The types of columns that we read, by their fixed ids in PostgreSQL's catalog.
enum Type : Oid {
    bool_type = 16,
    bytea_type = 17,
    bigint_type = 20,
    smallint_type = 21,
    integer_type = 23,
    text_type = 25,
    float8_type = 701,
    text_array_type = 1009
};

constexpr int as_text = 0, as_binary = 1;

/// For every parameter that the address does not set. A server that vanishes is noticed within half a minute.
constexpr std::array<std::pair<const char*, const char*>, 8> defaults = {{{"application_name", "sheer"},
                                                                          {"client_encoding", "UTF8"},
                                                                          {"connect_timeout", "10"},
                                                                          {"keepalives_idle", "10"},
                                                                          {"keepalives_interval", "5"},
                                                                          {"keepalives_count", "3"},
                                                                          {"tcp_user_timeout", "30000"},
                                                                          {"target_session_attrs", "read-write"}}};

/// A client that hangs inside a transaction must not keep its locks. Lists are read by their indexes, for which
/// compiling a query takes longer than running it.
constexpr const char* settings =
    "SET search_path TO sheer, pg_catalog; SET idle_in_transaction_session_timeout = '60s'; SET lock_timeout = '60s'; "
    "SET client_min_messages = error; SET default_transaction_isolation = 'read committed'; SET jit = off";

/// PostgreSQL's texts have no NUL.
std::string without_nul(std::string text) {
    for (std::size_t at = text.find('\0'); at != std::string::npos; at = text.find('\0', at))
        text.replace(at, 1, "\xef\xbf\xbd");
    return text;
}

std::string array_text(const std::vector<std::string>& texts) {
    std::string array = "{";
    for (const std::string& text : texts) {
        array += array.size() > 1 ? ",\"" : "\"";
        for (const char c : text) {
            if (c == '"' || c == '\\') array += '\\';
            array += c;
        }
        array += '"';
    }
    return array + "}";
}

/// A value as libpq wants it.
struct Sent {
    std::string text;
    const char* data = nullptr;
    int length = 0;
    int format = as_text;

    explicit Sent(const Value& value) {
        if (std::holds_alternative<std::nullptr_t>(value)) return;
        if (const auto* const bytes = std::get_if<Bytes>(&value)) {
            // A null pointer would be NULL.
            data = bytes->bytes.empty() ? "" : bytes->bytes.data();
            length = static_cast<int>(bytes->bytes.size());
            format = as_binary;
            return;
        }
        if (const auto* const flag = std::get_if<bool>(&value)) text = *flag ? "t" : "f";
        if (const auto* const integer = std::get_if<std::int64_t>(&value)) text = std::to_string(*integer);
        if (const auto* const number = std::get_if<double>(&value)) text = fmt::format("{}", *number);
        if (const auto* const letters = std::get_if<std::string>(&value)) text = without_nul(*letters);
        if (const auto* const list = std::get_if<std::vector<std::string>>(&value))
            text = without_nul(array_text(*list));
        data = text.c_str();
    }
    Sent(const Sent&) = delete;
    Sent& operator=(const Sent&) = delete;
    ~Sent() = default;
};

template <typename Number>
Number big_endian(std::string_view bytes) {
    std::make_unsigned_t<Number> value = 0;
    for (const char byte : bytes.substr(0, sizeof value))
        value = static_cast<decltype(value)>(value << 8 | static_cast<unsigned char>(byte));
    return static_cast<Number>(value);
}

[[noreturn]] void wrong_type(Oid type) {
    throw StoreError(fmt::format("database: a column has the unexpected type {}", type));
}

}  // namespace

std::int64_t Rows::changed() const {
    const std::string text = PQcmdTuples(m_result.get());
    return text.empty() ? 0 : std::stoll(text);
}

std::string_view Rows::raw(int row, int column) const {
    return {PQgetvalue(m_result.get(), row, column),
            static_cast<std::size_t>(PQgetlength(m_result.get(), row, column))};
}

std::string Rows::text(int row, int column) const {
    if (const Oid type = PQftype(m_result.get(), column); type != text_type) wrong_type(type);
    return std::string(raw(row, column));
}

std::int64_t Rows::integer(int row, int column) const {
    if (is_null(row, column)) return 0;
    switch (const Oid type = PQftype(m_result.get(), column)) {
        case smallint_type:
            return big_endian<std::int16_t>(raw(row, column));
        case integer_type:
            return big_endian<std::int32_t>(raw(row, column));
        case bigint_type:
            return big_endian<std::int64_t>(raw(row, column));
        default:
            wrong_type(type);
    }
}

double Rows::number(int row, int column) const {
    if (const Oid type = PQftype(m_result.get(), column); type != float8_type) wrong_type(type);
    return is_null(row, column) ? 0 : std::bit_cast<double>(big_endian<std::int64_t>(raw(row, column)));
}

bool Rows::flag(int row, int column) const {
    if (const Oid type = PQftype(m_result.get(), column); type != bool_type) wrong_type(type);
    return !is_null(row, column) && raw(row, column)[0] != 0;
}

std::vector<std::string> Rows::texts(int row, int column) const {
    if (const Oid type = PQftype(m_result.get(), column); type != text_array_type) wrong_type(type);
    // Dimensions, flags, element type, then length and first index of the only dimension, then each with its length.
    constexpr std::size_t header_bytes = 20, length_bytes = 4;
    std::string_view bytes = raw(row, column);
    std::vector<std::string> all;
    if (bytes.size() < header_bytes) return all;
    for (bytes.remove_prefix(header_bytes); bytes.size() >= length_bytes;) {
        const auto length = static_cast<std::size_t>(std::max(big_endian<std::int32_t>(bytes), 0));
        all.emplace_back(bytes.substr(length_bytes, length));
        bytes.remove_prefix(std::min(bytes.size(), length_bytes + length));
    }
    return all;
}

std::string_view Rows::bytes(int row, int column) const {
    if (const Oid type = PQftype(m_result.get(), column); type != bytea_type) wrong_type(type);
    return raw(row, column);
}

Connection::Connection(Address address) : m_address(std::move(address)), m_connection(nullptr, PQfinish) {
    std::vector<const char*> names, values;
    const auto add = [&](const char* name, const char* value) {
        names.push_back(name);
        values.push_back(value);
    };
    for (const auto& [name, value] : defaults) add(name, value);
    // The last of two equal names counts.
    for (const auto& [name, value] : m_address.parameters())
        if (!value.empty() && name != "client_encoding") add(name.c_str(), value.c_str());
    names.push_back(nullptr);
    values.push_back(nullptr);
    m_connection.reset(PQconnectdbParams(names.data(), values.data(), 0));
    if (is_lost())
        throw StoreUnreachable(fmt::format("{} cannot be reached: {}", m_address.text(),
                                           m_address.without_password(PQerrorMessage(m_connection.get()))));
    script(settings);
}

Rows Connection::run(const std::string& sql, std::initializer_list<Value> values) {
    return run(sql, std::vector<Value>(values));
}

Rows Connection::run(const std::string& sql, const std::vector<Value>& values) {
    std::vector<std::unique_ptr<Sent>> sent;
    std::vector<const char*> data;
    std::vector<int> lengths, formats;
    for (const Value& value : values) {
        sent.push_back(std::make_unique<Sent>(value));
        data.push_back(sent.back()->data);
        lengths.push_back(sent.back()->length);
        formats.push_back(sent.back()->format);
    }
    return checked(PQexecParams(m_connection.get(), sql.c_str(), static_cast<int>(values.size()), nullptr, data.data(),
                                lengths.data(), formats.data(), as_binary));
}

void Connection::script(const std::string& sql) {
    checked(PQexec(m_connection.get(), sql.c_str()));
}

Rows Connection::checked(PGresult* result) {
    Rows rows(result);
    const ExecStatusType status = PQresultStatus(result);
    if (status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK) return rows;
    const char* const state = PQresultErrorField(result, PG_DIAG_SQLSTATE);
    const char* const primary = PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY);
    fail(state ? state : "", primary ? primary : PQerrorMessage(m_connection.get()));
}

void Connection::fail(const std::string& state, const std::string& message) const {
    const std::string text = fmt::format("{}: {}", m_address.text(), m_address.without_password(message));
    // Codes of appendix A of PostgreSQL's manual. The third is that of a server that became a copy of another one.
    if (is_lost() || state.starts_with("08") || state.starts_with("57P") || state == "25006" || state == "25P03")
        throw StoreUnreachable(text);
    if (state == "53100") throw StoreFull("the database's disk is full");
    if (state.starts_with("53")) throw StoreUnreachable(text);
    if (state == "40001" || state == "40P01") throw Conflict(text);
    throw StoreError(text);
}

bool Connection::take_notifications() {
    if (PQconsumeInput(m_connection.get()) == 0) fail("", PQerrorMessage(m_connection.get()));
    bool any = false;
    while (PGnotify* const notification = PQnotifies(m_connection.get())) {
        PQfreemem(notification);
        any = true;
    }
    return any;
}

bool Connection::wait_for_notification(std::chrono::milliseconds limit) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (true) {
        if (take_notifications()) return true;
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
        if (left.count() <= 0) return false;
        pollfd wanted{.fd = descriptor(), .events = POLLIN, .revents = 0};
        poll(&wanted, 1, static_cast<int>(left.count()));
    }
}

}  // namespace sheer::postgres
