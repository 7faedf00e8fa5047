#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace sheer {

/// What somebody may do; each includes those before it.
enum class Scope {
    none,
    read,    ///< reports, pictures, the archive
    submit,  ///< post reports and files, cancel and delete them
    admin    ///< baselines and pins, which decide what others may delete
};

/// "read", "submit" or "admin".
const char* scope_text(Scope scope);
/// None for any other text.
std::optional<Scope> scope_from(std::string_view text);

/// A right to use a service. Its secret is shown once, when it is made; here is only its hash.
struct Token {
    std::string name;
    Scope scope = Scope::read;
    std::string sha256;
    std::int64_t created_ms = 0;
};

/// A secret of 256 random bits, as text without spaces. Throws std::runtime_error if there is no randomness.
std::string new_secret();

/// 1 to 100 letters, digits and -_.@
bool is_token_name(std::string_view name);

}  // namespace sheer
