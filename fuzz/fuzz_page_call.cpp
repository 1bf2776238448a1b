// A request of the page is answered with JSON that holds an answer or problems, whatever it is. The
// first line is the request, the rest a file that it may name "f" or "f.csv".
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "page/answer_call.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tethercalc;
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::size_t line_end = std::min(input.find('\n'), input.size());
  const auto file = std::as_bytes(std::span(input.substr(std::min(line_end + 1, size))));
  const std::string reply =
      page::answer_call(input.substr(0, line_end), {{"f", file}, {"f.csv", file}});
  const nlohmann::json read = nlohmann::json::parse(reply, nullptr, false);
  if (read.is_discarded() || read.contains("answer") == read.contains("problems")) std::abort();
  return 0;
}
