#include "server/access/known_tokens.h"

#include <openssl/crypto.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include "renderer/core/sha256.h"

namespace sheer {

bool KnownTokens::any() {
    const Tokens tokens = current();
    return !tokens || !tokens->empty();
}

std::optional<Token> KnownTokens::find(std::string_view secret) {
    const Tokens tokens = current();
    if (!tokens) return std::nullopt;
    const std::string sha256 = sha256_hex(secret);
    std::optional<Token> found;
    for (const Token& token : *tokens)
        if (CRYPTO_memcmp(token.sha256.data(), sha256.data(), sha256.size()) == 0) found = token;
    return found;
}

KnownTokens::Tokens KnownTokens::current() {
    const std::lock_guard lock(m_mutex);
    const Version now = version();
    if (m_version == now) return m_tokens;
    m_version = now;
    try {
        m_tokens = std::make_shared<const std::vector<Token>>(m_file.read());
    } catch (const TokenError& error) {
        spdlog::error("nobody is let in, as the tokens cannot be read: {}", error.what());
        m_tokens = nullptr;
    }
    return m_tokens;
}

KnownTokens::Version KnownTokens::version() const {
    struct stat status {};
    if (stat(m_file.path().c_str(), &status) != 0) return {};
    return {true, std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec, status.st_ino,
            static_cast<std::uint64_t>(status.st_size)};
}

}  // namespace sheer
