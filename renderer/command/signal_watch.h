#pragma once
#include <csignal>
#include <functional>
#include <mutex>
#include <thread>

namespace sheer::cli {

/// While it exists, SIGINT, SIGTERM and SIGHUP do not end the process until output has been written: a separate thread
/// takes the signal, locks `busy`, calls `conclude`, and ends the process with 128 plus the signal's number, whatever
/// the other threads are doing. A signal that is ignored, as under nohup, stays ignored.
///
/// Create it before any other thread: threads inherit the set of signals that they leave to this one.
class SignalWatch {
  public:
    /// Throws std::system_error. `busy` outlives it; hold it while changing anything that `conclude` uses.
    SignalWatch(std::mutex& busy, std::function<void(int signal)> conclude);
    SignalWatch(const SignalWatch&) = delete;
    SignalWatch& operator=(const SignalWatch&) = delete;
    ~SignalWatch();

    /// Call it with `busy` held: everything has been written, so `conclude` is not called any more.
    void finish() { m_finished = true; }

  private:
    void wait();

    std::mutex& m_busy;
    std::function<void(int)> m_conclude;
    bool m_finished = false;  ///< guarded by m_busy
    sigset_t m_before{};
    int m_signals = -1, m_end = -1;
    std::thread m_thread;
};

/// "SIGINT" and so on.
const char* signal_name(int signal);

}  // namespace sheer::cli
