#include "confinement/helper.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <sstream>

#include "common/error.hpp"
#include "confinement/confine.hpp"

namespace chladni::confinement {
namespace {

namespace fs = std::filesystem;

/// "CHLADNI_MESHER" for "chladni-mesher".
std::string variable_of(std::string name)
{
  std::ranges::transform(name, name.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::toupper(c));
  });
  return name;
}

std::vector<fs::path> folders_of_path()
{
  const char* said = std::getenv("PATH");
  std::istringstream all(said == nullptr ? "" : said);
  std::vector<fs::path> folders;
  for (std::string folder; std::getline(all, folder, ':');)
    if (fs::path(folder).is_absolute()) folders.emplace_back(folder);
  return folders;
}

std::vector<char> read_question()
{
  std::vector<char> bytes;
  std::array<char, 4096> piece{};
  while (true) {
    const ssize_t n = ::read(STDIN_FILENO, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return bytes;
    bytes.insert(bytes.end(), piece.data(), piece.data() + n);
  }
}

/// @return whether all was said
bool say(const std::vector<char>& bytes)
{
  std::size_t said = 0;
  while (said < bytes.size()) {
    const ssize_t n = ::write(answer_descriptor, bytes.data() + said, bytes.size() - said);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) said += static_cast<std::size_t>(n);
  }
  return true;
}

const std::string version = CHLADNI_VERSION;

void require_same_version(Unpacker& question)
{
  std::string asking;
  question(asking);
  if (asking != version) {
    throw Error(fmt::format("{} is of Chladni {}, but Chladni {} asks it; install both together",
                            program_invocation_short_name, version, asking));
  }
}

}  // namespace

fs::path helper(const std::string& name)
{
  const std::string variable = variable_of(name);
  std::error_code ignored;
  if (const char* said = std::getenv(variable.c_str())) {
    if (fs::exists(said, ignored)) return said;
    throw Error(fmt::format("{} names {}, which is not there; give the path of {}, or unset it",
                            variable, said, name));
  }
  const fs::path here = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const fs::path beside = (here / "../libexec/chladni").lexically_normal();
  const fs::path installed = CHLADNI_LIBEXEC_FOLDER / fs::path("chladni");
  std::vector<fs::path> folders{beside, installed};
  for (const fs::path& programs : folders_of_path())
    folders.push_back(programs / "../libexec/chladni");
  for (const fs::path& folder : folders)
    if (fs::exists(folder / name, ignored)) return folder / name;
  throw Error(
      fmt::format("the program {} is neither in {} nor in {}, nor does PATH have the folder of the "
                  "chladni that it belongs to; install it, or set {} to its path",
                  name, beside.string(), installed.string(), variable));
}

void ask(const Errand& errand, const std::function<std::string(const Outcome&)>& explain,
         const std::function<void(Unpacker&)>& unpack)
{
  Packer begin;
  begin(version);
  Errand sent = errand;
  sent.question.insert(sent.question.begin(), begin.bytes().begin(), begin.bytes().end());
  const Outcome outcome = run(sent);
  if (outcome.end != End::exited || outcome.code != 0) throw Error(explain(outcome));
  Unpacker answer(outcome.answer);
  bool is_there = false;
  answer(is_there);
  if (is_there) return unpack(answer);
  std::string message;
  answer(message);
  throw Error(message);
}

void serve(const std::function<void(Unpacker& question, Packer& answer)>& work)
{
  end_with_caller();
  Packer answer;
  try {
    const std::vector<char> bytes = read_question();
    Unpacker question(bytes);
    require_same_version(question);
    answer(true);
    work(question, answer);
  } catch (const Error& error) {
    answer = Packer{};
    answer(false);
    answer(std::string(error.what()));
  }
  // Destructors of libraries at exit are not for what a file may have damaged.
  _exit(say(answer.bytes()) ? 0 : 1);
}

}  // namespace chladni::confinement
