#include "geometry/base/process/side_by_side.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "geometry/base/process/stop_signals.hpp"

namespace cutterflow {

void side_by_side(std::size_t count, int jobs, const std::function<void(std::size_t)>& task) {
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::exception_ptr failure;
    const StopSignals signals;
    const auto work = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            try {
                signals.require_none();
                task(i);
            } catch (...) {
                const std::lock_guard<std::mutex> lock(mutex);
                if (!failure) failure = std::current_exception();
                next = count;
            }
        }
    };
    std::vector<std::thread> workers;
    const std::size_t side_by_side = std::min({static_cast<std::size_t>(jobs), count, k_most_children});
    workers.reserve(side_by_side);
    while (workers.size() < side_by_side) workers.emplace_back(work);
    for (std::thread& worker : workers) worker.join();
    if (failure) std::rethrow_exception(failure);
    signals.require_none();
}

}  // namespace cutterflow
