#pragma once
#include <atomic>
#include <functional>

namespace sheer {

/// Numbered pieces of work, each handed out once.
class WorkQueue {
  public:
    explicit WorkQueue(int count) : m_count(count) {}
    /// The next piece in `index`, 0..count-1; false when there is none left.
    bool take(int& index) {
        index = m_next.fetch_add(1, std::memory_order_relaxed);
        return index < m_count;
    }

  private:
    std::atomic<int> m_next{0};
    int m_count;
};

/// Calls `worker` once on each of a few threads, including the caller's; each takes pieces until the queue is empty.
/// Which thread gets which piece varies, so a piece's result must not depend on it. Rethrows a worker's exception after
/// all of them have ended. `max_threads` 0 means one per core, up to 8.
void share_work(int count, const std::function<void(WorkQueue&)>& worker, int max_threads = 0);

}  // namespace sheer
