#include "server/access/token.h"

#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <utility>

namespace sheer {

namespace {

constexpr std::pair<Scope, const char*> scopes[] = {
    {Scope::read, "read"}, {Scope::submit, "submit"}, {Scope::admin, "admin"}};
constexpr std::size_t longest_name = 100, secret_bytes = 32;
/// So that a secret is recognised where it does not belong.
constexpr const char* secret_prefix = "sheer_";

}  // namespace

const char* scope_text(Scope scope) {
    for (const auto& [known, text] : scopes)
        if (known == scope) return text;
    return "none";
}

std::optional<Scope> scope_from(std::string_view text) {
    for (const auto& [scope, known] : scopes)
        if (text == known) return scope;
    return std::nullopt;
}

std::string new_secret() {
    std::array<unsigned char, secret_bytes> bytes;
    if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
        throw std::runtime_error("the system has no random numbers for a token");
    constexpr std::string_view digits = "0123456789abcdef";
    std::string secret = secret_prefix;
    for (const unsigned char byte : bytes) {
        secret += digits[byte >> 4];
        secret += digits[byte & 15];
    }
    return secret;
}

bool is_token_name(std::string_view name) {
    const auto is_allowed = [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.' || c == '@';
    };
    return !name.empty() && name.size() <= longest_name && std::ranges::all_of(name, is_allowed);
}

}  // namespace sheer
