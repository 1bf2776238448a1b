// The page's program: answer_call for JavaScript, which puts texts and files into its memory.
// call.js is the other side, cmake/page_program.cmake names the functions that it finds.
#include <cstddef>
#include <string>

#include "page/answer_call.hpp"

namespace {

tethercalc::page::NamedFiles& named_files() {
  static tethercalc::page::NamedFiles files;
  return files;
}

std::string& answer() {
  static std::string text;
  return text;
}

}  // namespace

extern "C" {

/// A file that the next call may name; its bytes stay where they are until `forget`.
void name_file(const char* name, std::size_t name_size, const std::byte* bytes, std::size_t size) {
  named_files()[std::string(name, name_size)] = {bytes, size};
}

/// Answers a request; `answer_text` and `answer_size` then tell where the answer is.
void call_page(const char* request, std::size_t size) {
  answer() = tethercalc::page::answer_call({request, size}, named_files());
}

const char* answer_text() { return answer().data(); }
std::size_t answer_size() { return answer().size(); }

/// Of files and answer nothing is kept.
void forget() {
  named_files().clear();
  answer() = {};
}
}
