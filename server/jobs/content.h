#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "server/jobs/store_errors.h"

namespace sheer {

/// Bytes in a store, opened for reading: they stay readable even if they are deleted from it meanwhile. Each call may
/// wait for a disk or a network. Thread-safe.
class Content {
  public:
    virtual ~Content() = default;
    virtual std::uint64_t size_bytes() const = 0;
    /// Fills `bytes` from `offset` on; there must be enough bytes. Throws StoreError.
    virtual void read(std::uint64_t offset, std::span<char> bytes) const = 0;
};

using ContentPtr = std::shared_ptr<const Content>;

/// All of it. Throws StoreError, also if it is longer than `max_bytes`.
inline std::string read_all(const Content& content, std::uint64_t max_bytes) {
    if (content.size_bytes() > max_bytes) throw StoreError("the stored data is longer than the limit for reading");
    std::string bytes(content.size_bytes(), '\0');
    content.read(0, bytes);
    return bytes;
}

}  // namespace sheer
