#pragma once
#include <csignal>
#include <initializer_list>

namespace sheer {

/// SIGTERM and SIGINT as a file descriptor to wait on. During its life they are blocked in the thread that made it and
/// in those which that thread starts, so make it before any other thread.
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
    sigset_t m_blocked_before{};
    bool m_requested = false;
};

/// Waits until one of the descriptors is readable or `timeout_ms` have passed. Negative descriptors are left out.
void wait_readable(std::initializer_list<int> descriptors, int timeout_ms);

}  // namespace sheer
