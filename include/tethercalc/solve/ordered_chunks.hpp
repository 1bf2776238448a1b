// Work cut into chunks whose results come back in order, whoever computes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace tethercalc {

/// What computes chunks: this thread one after the other, or several threads at once.
struct ChunkRunner {
  /// Computes a chunk into the result of that slot.
  using Worker = std::function<void(std::uint64_t chunk, std::size_t slot)>;
  /// Makes a worker; called once a thread, in it.
  using MakeWorker = std::function<Worker()>;
  /// Takes the next chunk's result from its slot; false to stop.
  using Consume = std::function<bool(std::size_t slot)>;

  std::size_t slots = 1;  ///< results that exist at a time
  /// Computes the chunks first … last − 1 and has them consumed on the calling thread, strictly in
  /// rising order. An exception of a worker or of the consumer ends the work and is thrown again.
  std::function<void(std::uint64_t first, std::uint64_t last, const MakeWorker& make_worker,
                     const Consume& consume)>
      run = [](std::uint64_t first, std::uint64_t last, const MakeWorker& make_worker,
               const Consume& consume) {
        const Worker worker = make_worker();
        for (std::uint64_t chunk = first; chunk < last; ++chunk) {
          worker(chunk, 0);
          if (!consume(0)) return;
        }
      };
};

/// Computes chunks first … last − 1 by `runner` and hands their results to `consume` on the calling
/// thread, strictly in rising order, so that what comes out does not depend on the runner.
///
/// `make_worker()` is called once a thread, in it, and returns a callable
/// `void(std::uint64_t chunk, Result& result)`; `result` may hold an older chunk's result, whose
/// memory can be used again. `bool consume(Result&)` returns false to stop early. An exception of
/// either ends the work and is thrown again here.
template <class Result, class MakeWorker, class Consume>
void compute_in_order(std::uint64_t first, std::uint64_t last, const ChunkRunner& runner,
                      const MakeWorker& make_worker, const Consume& consume) {
  std::vector<Result> results(runner.slots);
  runner.run(
      first, last,
      [&] {
        // Shared, since a std::function must be copyable and a worker need not be.
        const auto worker = std::make_shared<decltype(make_worker())>(make_worker());
        return [&results, worker](std::uint64_t chunk, std::size_t slot) {
          (*worker)(chunk, results[slot]);
        };
      },
      [&](std::size_t slot) { return consume(results[slot]); });
}

}  // namespace tethercalc
