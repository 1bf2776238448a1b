#include "tethercalc/files/threads.hpp"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

void run(unsigned threads, std::uint64_t first, std::uint64_t last,
         const ChunkRunner::MakeWorker& make_worker, const ChunkRunner::Consume& consume) {
  std::vector<bool> ready(std::size_t{4} * threads);
  std::mutex mutex;
  std::condition_variable slot_free;
  std::condition_variable slot_ready;
  std::uint64_t next = first;      // chunk to compute
  std::uint64_t consumed = first;  // chunks before it are done with
  bool stop = false;
  std::exception_ptr failure;

  const auto work = [&] {
    try {
      const auto worker = make_worker();
      std::unique_lock lock(mutex);
      while (true) {
        slot_free.wait(lock,
                       [&] { return stop || next == last || next < consumed + ready.size(); });
        if (stop || next == last) return;
        const std::uint64_t chunk = next++;
        lock.unlock();
        worker(chunk, chunk % ready.size());
        lock.lock();
        ready[chunk % ready.size()] = true;
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
    try {
      for (unsigned i = 0; i < threads; ++i) pool.emplace_back(work);
    } catch (const std::system_error& error) {
      // No more threads are to be had (ulimit -u): those that run do the work of all.
      if (pool.empty()) {
        throw InputError("threads", "cannot be started: " + error.code().message());
      }
    }
    std::unique_lock lock(mutex);
    while (consumed < last) {
      const std::size_t slot = consumed % ready.size();
      slot_ready.wait(lock, [&] { return stop || ready[slot]; });
      if (stop) break;
      lock.unlock();
      bool go_on = false;
      try {
        go_on = consume(slot);
        lock.lock();
      } catch (...) {
        lock.lock();
        if (!failure) failure = std::current_exception();
      }
      ready[slot] = false;
      ++consumed;
      stop = stop || !go_on;
      slot_free.notify_all();
      if (stop) break;
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

unsigned all_cores() {
  const unsigned cores = std::thread::hardware_concurrency();
  return cores > 0 ? cores : 1;
}

ChunkRunner several_threads(unsigned threads) {
  return {std::size_t{4} * threads, [threads](auto... work) { run(threads, work...); }};
}

}  // namespace tethercalc
