#pragma once
#include <optional>
#include <string>

#include "server/jobs/content.h"

namespace sheer {

/// A picture, named by the hash of its bytes.
struct BlobName {
    std::string sha256;
    std::string media_type;
};

struct Blob {
    std::string media_type;
    ContentPtr content;
};

/// The pictures of done reports. JobQueue::commit adds them; they are removed with the last report that names them.
class Blobs {
  public:
    virtual ~Blobs() = default;
    /// Nothing if no report names it. Its bytes have been read and have this hash. Throws DamagedData.
    virtual std::optional<Blob> open(const std::string& sha256) = 0;
};

}  // namespace sheer
