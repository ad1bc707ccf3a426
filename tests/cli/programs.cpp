#include "tests/cli/programs.hpp"

#include <stdlib.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace chladni::cli::testing {

Folder::Folder()
{
  std::string name = (std::filesystem::temp_directory_path() / "chladni_test_XXXXXX").string();
  if (!::mkdtemp(name.data())) throw std::runtime_error("no folder for the test");
  path_ = name;
}

Folder::~Folder()
{
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::size_t Folder::n_files() const
{
  const std::filesystem::directory_iterator files(path_);
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

Ending run(const Folder& folder, const std::string& command)
{
  const Folder streams;
  const auto out = streams.path() / "out";
  const auto err = streams.path() / "err";
  const std::string line = "cd '" + folder.path().string() + "' && " + command + " > '" +
                           out.string() + "' 2> '" + err.string() + "'";
  const int status = std::system(line.c_str());
  return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
          .out = read_text(out),
          .err = read_text(err)};
}

std::string read_text(const std::filesystem::path& file)
{
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

void write_text(const std::filesystem::path& file, const std::string& text)
{
  std::ofstream(file) << text;
}

std::string replaced(const std::string& text, const std::string& old_part,
                     const std::string& new_part)
{
  const std::size_t at = text.find(old_part);
  if (at == std::string::npos || text.find(old_part, at + 1) != std::string::npos)
    throw std::runtime_error("must stand once in the text: " + old_part);
  return text.substr(0, at) + new_part + text.substr(at + old_part.size());
}

double number_at(const std::string& json, const std::string& key)
{
  const std::string quoted_key = "\"" + key + "\": ";
  const std::size_t at = json.find(quoted_key);
  if (at == std::string::npos) throw std::runtime_error("no key " + key + " in " + json);
  return std::stod(json.substr(at + quoted_key.size()));
}

}  // namespace chladni::cli::testing
