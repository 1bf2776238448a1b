#include "tethercalc/files/read_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "files/input_files.hpp"
#include "files/log_file.hpp"
#include "io/closest_name.hpp"
#include "io/entry_readers.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/spec_fields.hpp"

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

struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

/// What can be read of an open file, but no more than a little beyond `most` bytes.
std::string read_to_end(int descriptor, const std::string& name, std::size_t most) {
  std::string all;
  std::array<char, 1 << 16> part;
  while (all.size() <= most) {
    const ssize_t got = ::read(descriptor, part.data(), part.size());
    if (got == 0) break;
    if (got > 0) {
      all.append(part.data(), static_cast<std::size_t>(got));
    } else if (errno != EINTR) {
      throw InputError(name, fmt::format("cannot be read: {}", std::strerror(errno)));
    }
  }
  return all;
}

using FileIdentity = std::pair<dev_t, ino_t>;

/// Those that were read, by whichever name.
class FilesRead {
 public:
  void add(int descriptor) {
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return;
    const std::lock_guard lock(mutex_);
    files_.insert({status.st_dev, status.st_ino});
  }
  [[nodiscard]] bool contains(const fs::path& path) const {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return false;
    const std::lock_guard lock(mutex_);
    return files_.contains({status.st_dev, status.st_ino});
  }

 private:
  mutable std::mutex mutex_;
  std::set<FileIdentity> files_;
};

FilesRead& files_read() {
  static FilesRead files;
  return files;
}

LoadedText checked_text(int descriptor, const std::string& name) {
  std::string text = read_to_end(descriptor, name, text_file_limit);
  if (text.size() > text_file_limit) {
    throw InputError(name,
                     fmt::format("is larger than {} bytes, the most that a spec, a motor or a "
                                 "material may have; is it the right file?",
                                 text_file_limit));
  }
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) throw InputError(name, "is empty");
  return {name, std::move(text)};
}

}  // namespace

LoadedText read_text_file(const std::string& path) {
  if (path == "-") return checked_text(STDIN_FILENO, "standard input");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (path.empty() || status.type() == fs::file_type::not_found) {
    const bool dangling = fs::is_symlink(fs::symlink_status(path, error));
    throw InputError(path.empty() ? "\"\"" : path, dangling
                                                       ? "is a link to a file that is not there"
                                                       : "no such file" + closest_file_hint(path));
  }
  if (fs::is_directory(status)) throw InputError(path, "is a directory, not a file");
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.number < 0) {
    throw InputError(path, fmt::format("cannot be opened: {}", std::strerror(errno)));
  }
  files_read().add(file.number);
  return checked_text(file.number, path);
}

bool has_been_read(const fs::path& path) { return files_read().contains(path); }

namespace {

/// A mapping that is there while `name` is.
struct Mapping {
  std::atomic<const char*> name;
  std::atomic<std::uintptr_t> begin;
  std::atomic<std::uintptr_t> end;
};
// More logs at once than a command line names; of those beyond, a message lacks the name.
std::array<Mapping, 64> mappings;

void note_mapping(std::span<const std::byte> bytes, const char* name) {
  for (Mapping& mapping : mappings) {
    if (mapping.name != nullptr) continue;
    mapping.begin = reinterpret_cast<std::uintptr_t>(bytes.data());
    mapping.end = mapping.begin + bytes.size();
    mapping.name = name;
    return;
  }
}

void forget_mapping(const char* name) {
  for (Mapping& mapping : mappings) {
    if (mapping.name == name) mapping.name = nullptr;
  }
}

}  // namespace

const char* mapped_file_at(const void* address) noexcept {
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  for (const Mapping& mapping : mappings) {
    if (mapping.name != nullptr && mapping.begin <= at && at < mapping.end) return mapping.name;
  }
  return nullptr;
}

MappedFile::MappedFile(const std::filesystem::path& path) : name_(path.string()) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  struct stat status {};
  if (file.number < 0 || ::fstat(file.number, &status) != 0) {
    throw InputError(path.string(), fmt::format("cannot be opened: {}", std::strerror(errno)));
  }
  if (S_ISDIR(status.st_mode)) throw InputError(path.string(), "is a directory, expected a file");
  if (S_ISREG(status.st_mode) && status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* const start = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number, 0);
    if (start != MAP_FAILED) {
      bytes_ = {static_cast<const std::byte*>(start), size};
      note_mapping(bytes_, name_.c_str());
      return;
    }
  }
  // Pipes, devices, and files whose size is not known beforehand (those under /proc say 0).
  constexpr std::size_t most = std::size_t{256} << 20;
  copy_ = read_to_end(file.number, path.string(), most);
  if (copy_.size() > most) {
    throw InputError(path.string(), fmt::format("goes on beyond {} MiB, and is no regular file; a "
                                                "log as large is read from a file of its own",
                                                most >> 20));
  }
  bytes_ = std::as_bytes(std::span(copy_));
}

MappedFile::~MappedFile() {
  if (copy_.empty() && !bytes_.empty()) {
    forget_mapping(name_.c_str());
    ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
  }
}

TextLoader files_in(std::filesystem::path folder) {
  return [folder = std::move(folder)](const std::string& reference) {
    return read_text_file((folder / reference).string());
  };
}

namespace {

/// The folder from which relative paths in the spec at `path` lead on.
fs::path folder_of_spec(const std::string& path) {
  return path == "-" ? fs::path() : fs::path(path).parent_path();
}

}  // namespace

DesignFile read_design(const std::string& path, std::span<const std::string> overrides) {
  const LoadedText file = read_text_file(path);
  return parse_design(file.text, file.name, files_in(folder_of_spec(path)), overrides);
}

nlohmann::ordered_json spec_for_folder(nlohmann::ordered_json spec, const std::string& path,
                                       const fs::path& folder) {
  const fs::path from = fs::weakly_canonical(fs::current_path() / folder_of_spec(path));
  const fs::path to = fs::weakly_canonical(fs::current_path() / folder);
  if (from == to) return spec;
  for (const SpecField& field : spec_fields()) {
    const bool may_name_file = field.kind == FieldKind::motor ||
                               field.kind == FieldKind::conductor ||
                               field.kind == FieldKind::insulation_material;
    const nlohmann::ordered_json::json_pointer pointer{std::string(field.pointer)};
    if (!may_name_file || !spec.contains(pointer) || !spec.at(pointer).is_string()) continue;
    const auto reference = spec.at(pointer).get<std::string>();
    if (!names_a_file(reference) || fs::path(reference).is_absolute()) continue;
    const std::string there = fs::weakly_canonical(from / reference).lexically_relative(to);
    spec[pointer] = names_a_file(there) ? there : "./" + there;
  }
  return spec;
}

FlightLogReading read_flight_log(const std::filesystem::path& path,
                                 const FlightLogOptions& options) {
  const LogFile file(path);
  return parse_flight_log(file.bytes(), path.string(), options);
}

PowerLogReading read_power_log(const std::filesystem::path& path, const PowerLogOptions& options) {
  const LogFile file(path);
  return parse_power_log(file.bytes(), path.string(), options);
}

}  // namespace tethercalc
