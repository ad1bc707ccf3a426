#pragma once

#include <filesystem>
#include <string>

namespace chladni::cli::testing {

/// A folder of a test's own, removed at its end.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::size_t n_files() const;

 private:
  std::filesystem::path path_;
};

/// What a program said and how it ended.
struct Ending {
  int exit_code;
  std::string out;
  std::string err;
};

/// Runs a program by the shell in `folder`.
Ending run(const Folder& folder, const std::string& command);

std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

/// `text` with its only `old_part` replaced.
std::string replaced(const std::string& text, const std::string& old_part,
                     const std::string& new_part);

/// The number that follows `"key": ` in a JSON text.
double number_at(const std::string& json, const std::string& key);

}  // namespace chladni::cli::testing
