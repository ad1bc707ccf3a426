#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>

#include "common/error.hpp"
#include "confinement/confine.hpp"
#include "confinement/errand.hpp"
#include "confinement/system_calls.hpp"
#include "mesh/decks/is_deck.hpp"
#include "mesh/decks/read_deck.hpp"
#include "mesh/exchange/is_exchange.hpp"
#include "mesh/mesh_reader.hpp"
#include "mesh/packed_mesh.hpp"

namespace chladni::mesh {
namespace {

namespace fs = std::filesystem;
using confinement::End;
using confinement::Offence;
using confinement::Outcome;

constexpr std::uint64_t MiB = 1 << 20;

/// What holds a mesh takes what its size tells; what a .geo or .step makes, nobody knows.
confinement::Limits limits_of(const MeshOptions& options)
{
  std::error_code unknown;
  const std::uintmax_t found = fs::file_size(*options.file, unknown);
  const std::uint64_t size = unknown ? 0 : found;  // the reader says what is wrong with it
  const std::uint64_t machine =
      std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGESIZE));
  const bool is_mesh = fs::path(*options.file).extension() == ".msh" || is_deck(*options.file) ||
                       is_exchange(*options.file);
  const double usual = is_mesh ? 60.0 + 4.0 * double(size) / double(MiB) : 900.0;
  const std::uint64_t most = is_mesh ? std::min(1024 * MiB + 64 * size, machine) : machine / 4 * 3;
  return {.memory = options.most_MiB ? std::uint64_t(*options.most_MiB) * MiB : most,
          .seconds = options.most_seconds.value_or(usual)};
}

constexpr const char* remedy =
    "if it is your own, say --trust-mesh to read it without these limits";

std::string sentence(Offence offence)
{
  const char* what = offence == Offence::program   ? "start a program"
                     : offence == Offence::writing ? "write a file"
                                                   : "use the network";
  return fmt::format("it tried to {}, which a mesh file must not do; {}", what, remedy);
}

/// @param reader  who reads the file: "Gmsh"
std::string sentence_on_end(const Outcome& outcome, const confinement::Limits& limits,
                            const char* reader)
{
  const bool is_killed = outcome.end == End::killed_by_signal;
  // In the midst of starting a program, signals are held back; then the kernel itself kills.
  const std::optional<Offence> offence = is_killed && outcome.code == SIGSYS
                                             ? std::optional(Offence::program)
                                         : is_killed ? std::nullopt
                                                     : confinement::offence_of(outcome.code);
  if (offence) return sentence(*offence);
  if (outcome.end == End::took_too_long || (is_killed && outcome.code == SIGXCPU)) {
    return fmt::format("{} did not finish reading it within {:g} s; {}", reader, limits.seconds,
                       remedy);
  }
  if (outcome.end == End::said_too_much || outcome.code == confinement::exit_out_of_memory)
    return fmt::format("{} needs more than {} MiB for it; {}", reader, limits.memory / MiB, remedy);
  return fmt::format(
      "{0} crashed on it ({1}): it is damaged, or meets an error of {0}; open it in "
      "the program that it is of, or make it anew",
      reader, is_killed ? strsignal(outcome.code) : fmt::format("exit code {}", outcome.code));
}

/// What `unpack` makes of the answer of the process that reads the file.
/// @param ask  packs what is asked for behind the options
auto answer_of(const MeshOptions& options, Wanted wanted, auto&& ask, auto&& unpack)
{
  const confinement::Limits limits = limits_of(options);
  Packer question;
  question(limits.memory);
  question(limits.seconds);
  question(wanted);
  pack(question, options);
  ask(question);
  const Outcome outcome = confinement::run({.program = reader_program(),
                                            .question = question.bytes(),
                                            .most_seconds = limits.seconds,
                                            .most_bytes = limits.memory});
  if (outcome.end != End::exited || outcome.code != 0) {
    const char* reader = is_deck(*options.file)       ? "the reader of decks"
                         : is_exchange(*options.file) ? "its reader"
                                                      : "Gmsh";
    throw Error(
        fmt::format("mesh file {}: {}", *options.file, sentence_on_end(outcome, limits, reader)));
  }
  Unpacker answer(outcome.answer);
  bool is_there = false;
  answer(is_there);
  if (is_there) return unpack(answer);
  std::string message;
  answer(message);
  throw Error(message);
}

}  // namespace

std::string reader_program()
{
  if (const char* said = std::getenv("CHLADNI_MESH_READER")) return said;
  const fs::path below = fs::path("chladni") / "chladni-mesh-reader";
  std::error_code ignored;
  const fs::path here = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const fs::path& folder : {here / "../libexec", fs::path(CHLADNI_LIBEXEC_FOLDER)})
    if (fs::exists(folder / below, ignored)) return (folder / below).string();
  throw Error(fmt::format(
      "the program chladni-mesh-reader, in which Gmsh reads mesh files, is neither in {} "
      "nor in {}; install it, or set CHLADNI_MESH_READER to its path",
      (here / "../libexec/chladni").lexically_normal().string(),
      (CHLADNI_LIBEXEC_FOLDER / fs::path("chladni")).string()));
}

Mesh read_confined(const MeshOptions& options)
{
  return answer_of(
      options, Wanted::mesh, [](Packer&) {}, unpack_mesh);
}

Declarations declarations(const MeshOptions& options, const DeckUnits& units)
{
  if (options.trust == Trust::owner) return declarations_here(options, units);
  const auto ask = [&](Packer& question) {
    question(units.length);
    question(units.force);
  };
  return answer_of(options, Wanted::declarations, ask, unpack_declarations);
}

}  // namespace chladni::mesh
