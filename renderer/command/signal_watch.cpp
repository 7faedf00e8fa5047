#include "renderer/command/signal_watch.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <system_error>

#include "renderer/core/exit_codes.h"

namespace sheer::cli {

namespace {

struct Watched {
    int signal;
    const char* name;
};
constexpr std::array watched{Watched{SIGINT, "SIGINT"}, Watched{SIGTERM, "SIGTERM"}, Watched{SIGHUP, "SIGHUP"}};

sigset_t those_not_ignored() {
    sigset_t set;
    sigemptyset(&set);
    for (const Watched& one : watched) {
        struct sigaction action {};
        if (sigaction(one.signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) sigaddset(&set, one.signal);
    }
    return set;
}

}  // namespace

SignalWatch::SignalWatch(std::mutex& busy, std::function<void(int)> conclude)
    : m_busy(busy), m_conclude(std::move(conclude)) {
    const sigset_t set = those_not_ignored();
    m_signals = signalfd(-1, &set, SFD_CLOEXEC);
    m_end = eventfd(0, EFD_CLOEXEC);
    if (m_signals < 0 || m_end < 0) throw std::system_error(errno, std::generic_category(), "cannot wait for signals");
    pthread_sigmask(SIG_BLOCK, &set, &m_before);
    m_thread = std::thread([this] { wait(); });
}

SignalWatch::~SignalWatch() {
    const std::uint64_t one = 1;
    while (write(m_end, &one, sizeof(one)) < 0 && errno == EINTR) {
    }
    m_thread.join();
    pthread_sigmask(SIG_SETMASK, &m_before, nullptr);
    close(m_signals);
    close(m_end);
}

void SignalWatch::wait() {
    std::array<pollfd, 2> polled{pollfd{m_signals, POLLIN, 0}, pollfd{m_end, POLLIN, 0}};
    while (poll(polled.data(), polled.size(), -1) < 0 && errno == EINTR) {
    }
    signalfd_siginfo info{};
    if (polled[0].revents == 0 || read(m_signals, &info, sizeof(info)) != sizeof(info)) return;
    const std::lock_guard lock(m_busy);
    if (m_finished) return;
    const int signal = static_cast<int>(info.ssi_signo);
    try {
        m_conclude(signal);
    } catch (const std::exception& error) {
        fmt::print(stderr, "sheer: {}\n", error.what());
    }
    std::fflush(nullptr);
    // Other threads are still rendering; nothing they use may be destroyed.
    _exit(exit_by_signal + signal);
}

const char* signal_name(int signal) {
    for (const Watched& one : watched)
        if (one.signal == signal) return one.name;
    return "a signal";
}

}  // namespace sheer::cli
