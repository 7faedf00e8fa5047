#pragma once
#include <csignal>
#include <initializer_list>

namespace sheer {

/// SIGTERM and SIGINT as a file descriptor to wait on. While it exists they are blocked in the thread that made it and
/// in threads started by that thread, so make it before any other thread.
class StopSignal {
  public:
    /// Throws std::system_error.
    StopSignal();
    StopSignal(const StopSignal&) = delete;
    StopSignal& operator=(const StopSignal&) = delete;
    ~StopSignal();

    int descriptor() const { return m_descriptor; }
    /// Whether one has arrived; stays true afterwards.
    bool requested();

  private:
    int m_descriptor = -1;
    sigset_t m_blocked_before{};
    bool m_requested = false;
};

/// Waits until one of the descriptors is readable or `timeout_ms` have passed. Negative descriptors are ignored.
void wait_readable(std::initializer_list<int> descriptors, int timeout_ms);

}  // namespace sheer
