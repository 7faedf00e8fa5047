#pragma once
#include <atomic>
#include <string>

#include "server/http/problem.h"

namespace sheer::http {

/// One of the few requests of a kind that are answered at the same time, since each occupies a processor and a thread
/// that makes answers. Throws Problem (429) with `busy` if all slots are taken.
class Slot {
  public:
    Slot(std::atomic<int>& taken, int slots, const std::string& busy) : m_taken(taken) {
        if (++m_taken <= slots) return;
        --m_taken;
        throw Problem(429, busy).with("Retry-After", "1");
    }
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;
    ~Slot() { --m_taken; }

  private:
    std::atomic<int>& m_taken;
};

}  // namespace sheer::http
