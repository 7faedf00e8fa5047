#include "server/postgres/address.h"

#include <fmt/format.h>
#include <libpq-fe.h>

#include <algorithm>
#include <memory>

#include "server/jobs/store_errors.h"

namespace sheer::postgres {

namespace {

using ConninfoPtr = std::unique_ptr<PQconninfoOption, decltype(&PQconninfoFree)>;

void replace_all(std::string& text, const std::string& what, std::string_view by) {
    if (what.empty()) return;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
}

}  // namespace

bool is_postgres_url(std::string_view text) {
    return text.starts_with("postgresql://") || text.starts_with("postgres://");
}

Address::Address(const std::string& url) {
    char* message = nullptr;
    const ConninfoPtr parsed(PQconninfoParse(url.c_str(), &message), PQconninfoFree);
    // The message may quote any part of the URL.
    PQfreemem(message);
    if (!parsed || !is_postgres_url(url))
        throw StoreError(
            "the store's URL cannot be read; it has the form postgresql://USER@HOST:PORT/DATABASE, with %XX for "
            "special "
            "characters");
    for (const PQconninfoOption* option = parsed.get(); option->keyword != nullptr; ++option)
        if (option->val != nullptr) m_parameters.emplace_back(option->keyword, option->val);
    // What libpq would take from the environment: the rest of the program's life must not depend on it.
    const ConninfoPtr defaults(PQconndefaults(), PQconninfoFree);
    for (const PQconninfoOption* option = defaults.get(); option && option->keyword != nullptr; ++option)
        if (option->val != nullptr && value_of(option->keyword).empty())
            m_parameters.emplace_back(option->keyword, option->val);
    const std::string host = value_of("host"), port = value_of("port");
    m_text = fmt::format("the database {} on {}{}", value_of("dbname"), host.empty() ? "this machine" : host,
                         port.empty() ? "" : ":" + port);
}

std::string Address::value_of(std::string_view name) const {
    const auto found =
        std::ranges::find(m_parameters, name, [](const auto& each) -> std::string_view { return each.first; });
    return found == m_parameters.end() ? "" : found->second;
}

std::string Address::without_password(std::string message) const {
    replace_all(message, value_of("password"), "***");
    while (!message.empty() && (message.back() == '\n' || message.back() == ' ')) message.pop_back();
    replace_all(message, "\n", "; ");
    return message;
}

}  // namespace sheer::postgres
