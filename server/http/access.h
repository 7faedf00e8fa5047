#pragma once
#include <functional>
#include <optional>
#include <string>

#include "server/access/known_tokens.h"
#include "server/http/message.h"

namespace sheer::http {

inline constexpr const char* session_cookie = "sheer_token";

/// Who may do what: a request brings a token, as `Authorization: Bearer` (RFC 6750), or in the cookie of the page's
/// session, which a browser also sends for pictures and events.
class Access {
  public:
    /// Everyone who reaches the service may do everything.
    Access() = default;
    /// Tokens are asked for as long as there are any; or always, `even_without`. `tokens` must outlive it.
    Access(KnownTokens& tokens, bool even_without) : m_tokens(&tokens), m_even_without(even_without) {}

    bool is_required() const { return m_tokens != nullptr && (m_even_without || m_tokens->any()); }
    /// The token of the request, if it brings a valid one.
    std::optional<Token> token_of(const Request& request) const;
    /// The token with this secret.
    std::optional<Token> find(const std::string& secret) const;
    /// 401 or 403 if the request may not do what takes the scope `needed`; otherwise nothing.
    std::optional<Response> refusal(const Request& request, Scope needed) const;

  private:
    KnownTokens* m_tokens = nullptr;
    bool m_even_without = false;
};

/// The secret that a request brings; "" for none.
std::string secret_in(const Request& request);

}  // namespace sheer::http
