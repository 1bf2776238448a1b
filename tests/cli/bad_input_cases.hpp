// Bad inputs as files, ready for the reader or the program, with what must be said about them.
#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace bad_input {

struct Case {
  std::string name;
  std::string spec;                    ///< path
  std::vector<std::string> overrides;  ///< values of --set
  std::vector<std::string> says;       ///< what the message must contain
};

inline std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline void write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string from_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  return bytes;
}

inline std::string spec_text(const nlohmann::ordered_json& test, const std::string& source_folder) {
  using Json = nlohmann::ordered_json;
  if (test.contains("text")) return test["text"];
  if (test.contains("bytes")) return from_hex(test["bytes"]);
  Json spec = Json::parse(text_of(source_folder + "/examples/holybro-x500.json"));
  const Json removed = test.value("remove", Json::array());
  for (const Json& pointer : removed) {
    const Json::json_pointer at(pointer.get<std::string>());
    spec.at(at.parent_pointer()).erase(at.back());
  }
  const Json edits = test.value("edit", Json::object());
  for (const auto& [pointer, value] : edits.items()) {
    spec[Json::json_pointer(pointer)] = value;
  }
  return spec.dump(2);
}

/// Files that cannot be committed: what is no file, may not be read, or is large (and sparse).
inline void make_odd_file(const std::filesystem::path& folder, const std::string& name) {
  namespace fs = std::filesystem;
  if (name == "folder") fs::create_directories(folder / name);
  if (name == "large.json") {
    write(folder / name, "{}");
    fs::resize_file(folder / name, 100'000'000);
  }
  if (name == "unreadable.json") {
    write(folder / name, "{}");
    fs::permissions(folder / name, fs::perms::none);
  }
}

/// All cases of tests/cli/bad_input_cases.json, each with its files in a folder of its own below
/// `folder`.
inline std::vector<Case> prepare(const std::string& source_folder,
                                 const std::filesystem::path& folder) {
  using Json = nlohmann::ordered_json;
  const Json all = Json::parse(text_of(source_folder + "/tests/cli/bad_input_cases.json"));
  std::vector<Case> cases;
  for (const Json& test : all["cases"]) {
    const std::string file = test.value("file", std::string("spec.json"));
    const std::filesystem::path place = folder / std::to_string(cases.size());
    write(place / "spec.json", spec_text(test, source_folder));
    make_odd_file(place, file);
    const Json others = test.value("files", Json::object());
    for (const auto& [name, text] : others.items()) {
      write(place / name, text);
    }
    cases.push_back({test["name"], (place / file).string(),
                     test.value("set", std::vector<std::string>()), test["says"]});
  }
  return cases;
}

}  // namespace bad_input
