// Files that are written whole or not at all, or row by row and usable whenever writing stops.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tethercalc {

/// Writes `content` to a temporary file beside `path` and renames it, so that `path` holds either
/// what it held before or all of `content`. Devices and pipes, such as /dev/stdout, are written
/// directly. Throws InputError, naming the file and the system's reason, where that fails.
void write_whole_file(const std::filesystem::path& path, std::string_view content);

/// The same for content that comes part by part, of which no more than a part is kept in memory.
/// One such file is open at a time.
class WholeFile {
 public:
  /// Throws InputError, naming the file and the system's reason, where it cannot be written.
  explicit WholeFile(std::filesystem::path path);
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;
  /// Without `commit` nothing is left of what was appended.
  ~WholeFile();

  /// Throws InputError as the constructor does.
  void append(std::string_view part);
  /// Gives the file its name. Nothing may be appended after it. Throws likewise.
  void commit();

 private:
  std::filesystem::path path_;
  std::string temporary_;  ///< empty where `path_` is written directly
  std::filesystem::path target_;
  int file_ = -1;
  bool owned_ = true;  ///< whether the file is this one's to close
};

/// Removes what a WholeFile has written so far, if one is open: for a signal's handler that ends
/// the process.
void remove_unfinished_file() noexcept;

/// Whether both name one regular file that is there.
[[nodiscard]] bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Refuses a path that `write_whole_file` could not write, before anything takes time.
void check_can_be_written(const std::filesystem::path& path);

/// Refuses a path with a file that is anything but `unedited`.
void check_unedited(const std::filesystem::path& path, std::string_view unedited);

/// Lines written one after the other. Whatever ends the writing, the file holds a prefix of them:
/// where a write fails, what it left of a line is cut off again, and where the process is killed
/// within one, the next line after `resume` takes its place.
class RowFile {
 public:
  /// Standard output; `name()` is "standard output".
  [[nodiscard]] static RowFile standard_output();

  /// The file at `path`, emptied. Throws InputError where it cannot be opened for writing.
  [[nodiscard]] static RowFile create(const std::string& path);

  /// The file at `path` with what it holds; an empty one where there is none. Takes the time to
  /// read it once and changes nothing before `append`. Throws InputError where it cannot be opened
  /// for reading and writing, or is no regular file.
  [[nodiscard]] static RowFile resume(const std::string& path);

  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;
  ~RowFile();

  /// The path, or "standard output".
  [[nodiscard]] const std::string& name() const { return name_; }
  /// False for devices, pipes and terminals.
  [[nodiscard]] bool is_regular() const { return regular_; }

  /// Number of lines that `resume` found.
  [[nodiscard]] std::uint64_t lines_found() const { return lines_found_; }
  /// The first of them, without its newline.
  [[nodiscard]] const std::string& first_line() const { return first_line_; }
  /// The last of them, without its newline.
  [[nodiscard]] const std::string& last_line() const { return last_line_; }
  /// What it found after the last newline.
  [[nodiscard]] const std::string& broken_line() const { return broken_line_; }

  /// Appends `lines`, each with its newline. Throws std::system_error where that fails (no space
  /// left, reader gone); a regular file then ends with the last line that was written whole.
  void append(std::string_view lines);

  /// Closes the file; throws std::system_error where the system reports only now that it could not
  /// be written.
  void close();

 private:
  RowFile(int file, std::string name, bool owned);
  RowFile(int file, std::string name);  ///< that is resumed
  void read_what_is_there();

  int file_;
  bool owned_;
  bool regular_;
  std::string name_;
  std::uint64_t size_ = 0;  ///< bytes up to the end of the last whole line
  std::uint64_t lines_found_ = 0;
  std::string first_line_;
  std::string last_line_;
  std::string broken_line_;
};

}  // namespace tethercalc
