#pragma once
#include <csignal>
#include <functional>
#include <mutex>
#include <thread>

namespace sheer::cli {

/// While it lives, SIGINT, SIGTERM and SIGHUP wait until what is due is written: a thread of its own takes the signal,
/// locks `busy`, calls `conclude`, and ends the process with 128 plus the signal's number, whatever the other threads
/// are at. A signal that is ignored, as under nohup, stays ignored.
///
/// Make it before any other thread: threads inherit which signals they leave to this one.
class SignalWatch {
  public:
    /// Throws std::system_error. `busy` outlives it; hold it while what `conclude` uses is being changed.
    SignalWatch(std::mutex& busy, std::function<void(int signal)> conclude);
    SignalWatch(const SignalWatch&) = delete;
    SignalWatch& operator=(const SignalWatch&) = delete;
    ~SignalWatch();

    /// With `busy` held: everything is written, and nothing is to be concluded any more.
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
