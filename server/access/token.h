#pragma once
#include <array>
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

/// What the holder of a token may take up, besides the limits for all; see Usage.
struct Quota {
    std::optional<std::int64_t> jobs;          ///< queued or running at once
    std::optional<std::int64_t> seconds;       ///< of rendering within a day
    std::optional<std::int64_t> upload_bytes;  ///< within a day
};

/// One of its limits, as files, commands and answers name it.
struct QuotaLimit {
    const char* name;
    const char* what;
    std::optional<std::int64_t> Quota::*limit;
};

inline constexpr QuotaLimit jobs_limit{"jobs", "comparisons that wait or run", &Quota::jobs};
inline constexpr QuotaLimit seconds_limit{"seconds", "seconds of rendering within a day", &Quota::seconds};
inline constexpr QuotaLimit upload_limit{"upload_bytes", "bytes of uploads within a day", &Quota::upload_bytes};
inline constexpr std::array quota_limits = {jobs_limit, seconds_limit, upload_limit};

/// A right to use a service. Its secret is shown once, when it is made; here is only its hash.
struct Token {
    std::string name;
    Scope scope = Scope::read;
    std::string sha256;
    std::int64_t created_ms = 0;
    Quota quota;
};

/// A secret of 256 random bits, as text without spaces. Throws std::runtime_error if there is no randomness.
std::string new_secret();

/// 1 to 100 letters, digits and -_.@
bool is_token_name(std::string_view name);

}  // namespace sheer
