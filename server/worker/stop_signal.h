#pragma once
#include <initializer_list>

namespace sheer {

/// SIGTERM and SIGINT as a file descriptor to wait on. They are blocked in the thread that makes this object and in
/// those it starts, so make it before any other thread.
class StopSignal {
  public:
    /// Throws std::system_error.
    StopSignal();
    StopSignal(const StopSignal&) = delete;
    StopSignal& operator=(const StopSignal&) = delete;
    ~StopSignal();

    int descriptor() const { return m_descriptor; }
    /// Whether one has come; once true it stays so.
    bool requested();

  private:
    int m_descriptor = -1;
    bool m_requested = false;
};

/// Waits until one of the descriptors is readable or `timeout_ms` have passed. Negative descriptors are left out.
void wait_readable(std::initializer_list<int> descriptors, int timeout_ms);

}  // namespace sheer
