#pragma once
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include "server/access/token_file.h"

namespace sheer {

/// The tokens of a file as they are now: a change takes effect with the next question. Thread-safe.
class KnownTokens {
  public:
    explicit KnownTokens(TokenFile file) : m_file(std::move(file)) {}

    /// Whether there are any. True if the file cannot be read, so that damage lets nobody in.
    bool any();
    /// The token with this secret, if there is one. Takes the same time wherever the secret differs.
    std::optional<Token> find(std::string_view secret);

  private:
    using Tokens = std::shared_ptr<const std::vector<Token>>;
    /// Null if the file cannot be read.
    Tokens current();

    struct Version {
        bool exists = false;
        std::int64_t modified_ns = 0;
        std::uint64_t inode = 0, size_bytes = 0;
        bool operator==(const Version&) const = default;
    };
    Version version() const;

    const TokenFile m_file;
    std::mutex m_mutex;  ///< guards what follows
    std::optional<Version> m_version;
    Tokens m_tokens;
};

}  // namespace sheer
