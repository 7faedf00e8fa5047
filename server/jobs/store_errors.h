#pragma once
#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace sheer {

/// The store could not carry out a request: disk full, archive damaged, database locked for too long.
class StoreError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What the store stands on failed: its disk, or the connection to it. It may work another time.
class DiskError : public StoreError {
    using StoreError::StoreError;
};

/// There is no room for the data. The text is a message for the client.
class StoreFull : public DiskError {
    using DiskError::DiskError;
};

/// The store's server cannot be reached. If the connection was lost while something was written, it may have been
/// written or not.
class StoreUnreachable : public DiskError {
    using DiskError::DiskError;
};

/// Stored data is missing, cannot be read, or does not match its hash. The text is a message for the client.
class DamagedData : public StoreError {
    using StoreError::StoreError;
};

/// Whether a system error means that there is no room, including those of std::filesystem and the renderer's
/// WriteError.
inline bool means_full_disk(const std::error_code& code) {
    return code == std::errc::no_space_on_device || code == std::error_code(EDQUOT, std::generic_category());
}

}  // namespace sheer
