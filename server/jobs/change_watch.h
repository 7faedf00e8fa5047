#pragma once
#include <chrono>

namespace sheer {

/// Notices when any process writes to a store what a reader of reports can see. For one thread.
class ChangeWatch {
  public:
    virtual ~ChangeWatch() = default;
    /// Waits until something was written since the last call, or since this object was made, and returns true, which
    /// may also happen if nothing was written. False when `limit` has passed. Throws StoreError.
    virtual bool wait(std::chrono::milliseconds limit) = 0;
    /// Readable when wait() may have something to report; -1 if there is no such thing, at present or at all.
    virtual int descriptor() { return -1; }
};

}  // namespace sheer
