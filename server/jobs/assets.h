#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/content.h"

namespace sheer {

/// An uploaded file that specs may refer to by its SHA-256.
struct Asset {
    std::string sha256;
    std::string type;  ///< texture, model or volume
    std::string media_type;
    std::string name;  ///< given by its sender; may be empty
    std::int64_t size_bytes = 0;
    std::int64_t created_ms = 0;
    nlohmann::json facts;  ///< an object with what its check found
    std::string
        broken;  ///< what is missing from it; empty if it is complete as far as is known without reading its bytes
};

struct OpenAsset {
    Asset asset;
    ContentPtr content;
};

class Assets {
  public:
    enum class Removal { not_found, in_use, removed };

    virtual ~Assets() = default;
    /// Stores an asset with its bytes, as created now; one that already exists keeps its name and type, and its bytes
    /// are restored if they are damaged. Throws StoreFull.
    virtual void add(const Asset& asset, const std::string& bytes) = 0;
    /// Does not read its bytes.
    virtual std::optional<Asset> find(const std::string& sha256) = 0;
    /// Its bytes have been read and have this hash. Throws DamagedData.
    virtual std::optional<OpenAsset> open(const std::string& sha256) = 0;
    /// Newest first.
    virtual std::vector<Asset> list(int limit) = 0;
    /// Does not remove an asset to which a queued or running report refers.
    virtual Removal remove(const std::string& sha256) = 0;
};

}  // namespace sheer
