#pragma once
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace sheer::http {

/// Bodies that take long to make and are often asked for; those that were not used for longest are forgotten.
/// Thread-safe.
class BodyCache {
  public:
    struct Kept {
        std::string body;
        std::string etag = {};
        std::int64_t version = 0;  ///< of the store from which it was read
    };
    using KeptPtr = std::shared_ptr<const Kept>;

    /// A longer body than `max_bytes` is not kept.
    explicit BodyCache(std::size_t max_bytes) : m_max_bytes(max_bytes) {}

    /// The body that is known by `key`, or the result of `make`, which then is. Threads that ask for an unknown one at
    /// the same time all make it. Throws what `make` throws.
    template <typename Make>
    std::string get(const std::string& key, const Make& make) {
        if (const auto known = find(key)) return known->body;
        std::string body = make();
        keep(key, {body});
        return body;
    }

    /// Null if it is not known.
    KeptPtr find(const std::string& key);
    /// In place of what is known by `key`.
    void keep(const std::string& key, Kept kept);

  private:
    struct Entry {
        std::string key;
        KeptPtr kept;
    };

    void forget(std::list<Entry>::iterator entry);

    const std::size_t m_max_bytes;
    std::mutex m_mutex;  ///< guards what follows
    std::size_t m_bytes = 0;
    std::list<Entry> m_entries;  ///< the one used last is first
    std::map<std::string, std::list<Entry>::iterator> m_by_key;
};

}  // namespace sheer::http
