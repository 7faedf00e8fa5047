#include "renderer/core/work_queue.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace sheer {

void share_work(int count, const std::function<void(WorkQueue&)>& worker, int max_threads) {
    WorkQueue queue(count);
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto guarded = [&] {
        try {
            worker(queue);
        } catch (...) {
            const std::scoped_lock lock(failure_mutex);
            if (!failure) failure = std::current_exception();
        }
    };

    const int cores = std::clamp(int(std::thread::hardware_concurrency()), 1, 8);
    const int threads = std::min(max_threads > 0 ? max_threads : cores, count);
    {
        std::vector<std::jthread> helpers;
        helpers.reserve(std::size_t(std::max(threads, 1)));
        try {
            while (int(helpers.size()) < threads - 1) helpers.emplace_back(guarded);
        } catch (const std::system_error&) {
            // A sandbox may forbid threads: those that did start do all the work.
        }
        guarded();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace sheer
