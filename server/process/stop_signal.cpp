#include "server/process/stop_signal.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <vector>

namespace sheer {

StopSignal::StopSignal() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals, &m_blocked_before);
    m_descriptor = signalfd(-1, &signals, SFD_NONBLOCK | SFD_CLOEXEC);
    if (m_descriptor < 0) throw std::system_error(errno, std::generic_category(), "signalfd");
}

StopSignal::~StopSignal() {
    close(m_descriptor);
    pthread_sigmask(SIG_SETMASK, &m_blocked_before, nullptr);
}

bool StopSignal::requested() {
    signalfd_siginfo info;
    if (!m_requested) m_requested = read(m_descriptor, &info, sizeof info) == static_cast<ssize_t>(sizeof info);
    return m_requested;
}

void wait_readable(std::initializer_list<int> descriptors, int timeout_ms) {
    std::vector<pollfd> polled;
    for (const int descriptor : descriptors)
        if (descriptor >= 0) polled.push_back({descriptor, POLLIN, 0});
    poll(polled.data(), polled.size(), timeout_ms);
}

}  // namespace sheer
