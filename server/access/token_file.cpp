#include "server/access/token_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "renderer/core/files.h"
#include "renderer/core/sha256.h"

namespace sheer {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uintmax_t longest_file_bytes = 16 << 20;

/// Held while the file is replaced, so that of two changes at once none is lost.
class FileLock {
  public:
    explicit FileLock(const fs::path& path) : m_file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
        if (m_file < 0 || flock(m_file, LOCK_EX) != 0) {
            const std::string why = std::generic_category().message(errno);
            if (m_file >= 0) close(m_file);
            throw TokenError(fmt::format("{}: {}", path.string(), why));
        }
    }
    ~FileLock() { close(m_file); }
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    int m_file;
};

Token token_of(const json& object) {
    const auto scope = scope_from(object.at("scope").get<std::string>());
    Token token{object.at("name"), scope.value_or(Scope::none), object.at("sha256"), object.at("created_ms")};
    if (!scope || !is_token_name(token.name) || !is_sha256(token.sha256))
        throw TokenError("a token has another name, scope or hash than a token can have");
    for (const auto& [name, what, limit] : quota_limits)
        if (const auto quota = object.find("quota"); quota != object.end() && quota->contains(name))
            token.quota.*limit = quota->at(name).get<std::int64_t>();
    return token;
}

json json_of(const Token& token) {
    json object = {{"name", token.name},
                   {"scope", scope_text(token.scope)},
                   {"sha256", token.sha256},
                   {"created_ms", token.created_ms}};
    for (const auto& [name, what, limit] : quota_limits)
        if (token.quota.*limit) object["quota"][name] = *(token.quota.*limit);
    return object;
}

/// If root changes the tokens of a service that runs as another user, that user must still be able to read them.
void give_to_owner_of_folder(const fs::path& file) {
    struct stat folder {};
    if (geteuid() != 0 || stat(fs::absolute(file).parent_path().c_str(), &folder) != 0) return;
    if (chown(file.c_str(), folder.st_uid, folder.st_gid) != 0)
        throw TokenError(fmt::format("{}: {}", file.string(), std::generic_category().message(errno)));
}

}  // namespace

std::vector<Token> TokenFile::read() const {
    std::error_code code;
    if (!fs::exists(m_path, code) && !code) return {};
    try {
        std::vector<Token> tokens;
        const json document = json::parse(read_file(m_path, longest_file_bytes));
        for (const json& one : document.at("tokens")) tokens.push_back(token_of(one));
        return tokens;
    } catch (const std::exception& error) {
        throw TokenError(fmt::format("{}: {}", m_path.string(), error.what()));
    }
}

std::string TokenFile::create(const std::string& name, Scope scope, const Quota& quota, std::int64_t now_ms) {
    if (!is_token_name(name)) throw TokenError("a token's name has 1 to 100 letters, digits and -_.@");
    const std::string secret = new_secret();
    change([&](std::vector<Token>& tokens) {
        if (std::ranges::count(tokens, name, &Token::name) > 0)
            throw TokenError(fmt::format("there is a token \"{}\" already; revoke it first", name));
        tokens.push_back({name, scope, sha256_hex(secret), now_ms, quota});
    });
    return secret;
}

void TokenFile::revoke(const std::string& name) {
    change([&](std::vector<Token>& tokens) {
        if (std::erase_if(tokens, [&](const Token& token) { return token.name == name; }) == 0)
            throw TokenError(fmt::format("there is no token \"{}\"", name));
    });
}

void TokenFile::change(const std::function<void(std::vector<Token>&)>& edit) {
    const FileLock lock(m_path.string() + ".lock");
    std::vector<Token> tokens = read();
    edit(tokens);
    json all = json::array();
    for (const Token& token : tokens) all.push_back(json_of(token));
    const fs::path next = m_path.string() + ".new";
    try {
        write_file(next, json{{"tokens", all}}.dump(1) + "\n");
        fs::permissions(next, fs::perms::owner_read | fs::perms::owner_write);
        give_to_owner_of_folder(next);
        fs::rename(next, m_path);
    } catch (const std::exception& error) {
        throw TokenError(error.what());
    }
}

}  // namespace sheer
