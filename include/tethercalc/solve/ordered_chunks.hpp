// Work done by several threads whose results come back in order.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace tethercalc {

/// Number of threads that use every core.
[[nodiscard]] inline unsigned all_cores() {
  const unsigned cores = std::thread::hardware_concurrency();
  return cores > 0 ? cores : 1;
}

/// Computes chunks first … last − 1 on `threads` (≥ 1) threads and hands their results to `consume`
/// on the calling thread, strictly in rising order, so that what comes out does not depend on the
/// number of threads. At most four results a thread exist at a time: memory does not grow with the
/// number of chunks, and a slow consumer slows the producers.
///
/// `make_worker()` is called once a thread, in it, and returns a callable
/// `void(std::uint64_t chunk, Result& result)`; `result` may hold an older chunk's result, whose
/// memory can be used again. `bool consume(Result&)` returns false to stop early. An exception of
/// either ends the work and is thrown again here.
template <class Result, class MakeWorker, class Consume>
void compute_in_order(std::uint64_t first, std::uint64_t last, unsigned threads,
                      const MakeWorker& make_worker, const Consume& consume) {
  struct Slot {
    Result result;
    bool ready = false;
  };
  std::vector<Slot> slots(std::size_t{4} * threads);
  std::mutex mutex;
  std::condition_variable slot_free;
  std::condition_variable slot_ready;
  std::uint64_t next = first;      // chunk to compute
  std::uint64_t consumed = first;  // chunks before it are done with
  bool stop = false;
  std::exception_ptr failure;

  const auto work = [&] {
    try {
      auto worker = make_worker();
      std::unique_lock lock(mutex);
      while (true) {
        slot_free.wait(lock,
                       [&] { return stop || next == last || next < consumed + slots.size(); });
        if (stop || next == last) return;
        const std::uint64_t chunk = next++;
        Slot& slot = slots[chunk % slots.size()];
        lock.unlock();
        worker(chunk, slot.result);
        lock.lock();
        slot.ready = true;
        if (chunk == consumed) slot_ready.notify_one();
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      stop = true;
      slot_ready.notify_one();
      slot_free.notify_all();
    }
  };

  {
    std::vector<std::jthread> pool;
    for (unsigned i = 0; i < threads; ++i) pool.emplace_back(work);
    std::unique_lock lock(mutex);
    while (consumed < last) {
      Slot& slot = slots[consumed % slots.size()];
      slot_ready.wait(lock, [&] { return stop || slot.ready; });
      if (stop) break;
      lock.unlock();
      bool go_on = false;
      std::exception_ptr thrown;
      try {
        go_on = consume(slot.result);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      slot.ready = false;
      ++consumed;
      if (thrown && !failure) failure = thrown;
      if (thrown || !go_on) stop = true;
      slot_free.notify_all();
      if (stop) break;
    }
    lock.unlock();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace tethercalc
