#include "files/text_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

#include "io/closest_name.hpp"
#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

namespace fs = std::filesystem;

std::string closest_file_hint(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return fmt::format("; the folder {} does not exist either", folder.string());
  }
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    names.push_back(entry.path().filename().string());
  }
  return did_you_mean(path.filename().string(), names);
}

std::string read_all(std::FILE* file, const std::string& name) {
  std::string text;
  std::array<char, 1 << 16> buffer{};
  while (true) {
    const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file);
    text.append(buffer.data(), count);
    if (text.size() > text_file_limit) {
      throw InputError(name,
                       fmt::format("is larger than {} bytes, the most that a spec, a motor or a "
                                   "material may have; is it the right file?",
                                   text_file_limit));
    }
    if (count < buffer.size()) break;
  }
  if (std::ferror(file) != 0)
    throw InputError(name, fmt::format("cannot be read: {}", std::strerror(errno)));
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) throw InputError(name, "is empty");
  return text;
}

}  // namespace

LoadedText read_text_file(const std::string& path) {
  if (path == "-") {
    const std::string name = "standard input";
    return {name, read_all(stdin, name)};
  }
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (path.empty() || status.type() == fs::file_type::not_found) {
    const bool dangling = fs::is_symlink(fs::symlink_status(path, error));
    throw InputError(path.empty() ? "\"\"" : path, dangling
                                                       ? "is a link to a file that is not there"
                                                       : "no such file" + closest_file_hint(path));
  }
  if (fs::is_directory(status)) throw InputError(path, "is a directory, not a file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (file == nullptr)
    throw InputError(path, fmt::format("cannot be opened: {}", std::strerror(errno)));
  return {path, read_all(file.get(), path)};
}

}  // namespace tethercalc
