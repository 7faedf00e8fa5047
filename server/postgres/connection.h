#pragma once
#include <libpq-fe.h>

#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/jobs/store_errors.h"
#include "server/postgres/address.h"

namespace sheer::postgres {

/// Another transaction was in the way; the same one may succeed if it is begun again.
class Conflict : public StoreError {
    using StoreError::StoreError;
};

/// A value of type bytea. It must outlive the statement.
struct Bytes {
    std::string_view bytes;
};

/// A value for a statement. Texts become `text`, or what the statement needs there; a list becomes `text[]`.
using Value = std::variant<std::nullptr_t, bool, std::int64_t, double, std::string, Bytes, std::vector<std::string>>;

/// What a statement gave. Columns are read as the types that they have; another one throws StoreError.
class Rows {
  public:
    explicit Rows(PGresult* result) : m_result(result, PQclear) {}

    int count() const { return PQntuples(m_result.get()); }
    bool empty() const { return count() == 0; }
    /// How many rows an INSERT, UPDATE or DELETE changed.
    std::int64_t changed() const;

    bool is_null(int row, int column) const { return PQgetisnull(m_result.get(), row, column) != 0; }
    std::string text(int row, int column) const;
    /// Of a smallint, integer or bigint.
    std::int64_t integer(int row, int column) const;
    double number(int row, int column) const;
    bool flag(int row, int column) const;
    std::vector<std::string> texts(int row, int column) const;
    /// Of a bytea, valid as long as this object.
    std::string_view bytes(int row, int column) const;

  private:
    std::string_view raw(int row, int column) const;

    std::shared_ptr<PGresult> m_result;
};

/// A connection to a PostgreSQL server. For one thread at a time.
class Connection {
  public:
    /// Throws StoreUnreachable.
    explicit Connection(Address address);

    /// One statement; $1, $2, ... are its values. Throws StoreUnreachable if the connection is lost, Conflict,
    /// StoreFull, and StoreError.
    Rows run(const std::string& sql, std::initializer_list<Value> values = {});
    Rows run(const std::string& sql, const std::vector<Value>& values);
    /// Several statements without values.
    void script(const std::string& sql);

    bool is_lost() const { return PQstatus(m_connection.get()) != CONNECTION_OK; }
    bool is_in_transaction() const { return PQtransactionStatus(m_connection.get()) != PQTRANS_IDLE; }
    /// Whether a notification has come; none of those that came so far is reported again. Waits until `limit` for one.
    /// Throws StoreUnreachable.
    bool wait_for_notification(std::chrono::milliseconds limit);
    /// Readable when a notification may have come.
    int descriptor() const { return PQsocket(m_connection.get()); }

  private:
    Rows checked(PGresult* result);
    [[noreturn]] void fail(const std::string& state, const std::string& message) const;
    bool take_notifications();

    Address m_address;
    std::unique_ptr<PGconn, decltype(&PQfinish)> m_connection;
};

}  // namespace sheer::postgres
