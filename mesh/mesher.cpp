#include "mesh/mesher.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>

#include "common/confinement/helper_process.hpp"
#include "common/confinement/sandbox.hpp"
#include "common/error.hpp"
#include "mesh/mesh_archive.hpp"
#include "mesh/own_readers.hpp"

namespace chladni::mesh {
namespace {

namespace fs = std::filesystem;
using confinement::End;
using confinement::Offence;
using confinement::Outcome;

constexpr std::uint64_t MiB = 1 << 20;

std::uint64_t bytes_of_machine()
{
  return std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGESIZE));
}

/// What holds a mesh takes what its size tells; what a .geo or .step makes, nobody knows. None for
/// generators and for files that their owner trusts.
std::optional<confinement::Limits> limits_of(const MeshOptions& options)
{
  if (!options.file || options.trust == Trust::owner) return std::nullopt;
  std::error_code unknown;
  const std::uintmax_t found = fs::file_size(*options.file, unknown);
  const std::uint64_t size = unknown ? 0 : found;  // the mesher says what is wrong with it
  const std::uint64_t machine = bytes_of_machine();
  const bool is_mesh =
      mesh_source(*options.file) == MeshSource::msh || has_own_reader(*options.file);
  const double usual = is_mesh ? 60.0 + 4.0 * double(size) / double(MiB) : 900.0;
  const std::uint64_t most = is_mesh ? std::min(1024 * MiB + 64 * size, machine) : machine / 4 * 3;
  return confinement::Limits{
      .memory = options.most_MiB ? std::uint64_t(*options.most_MiB) * MiB : most,
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

bool is_killed(const Outcome& outcome)
{
  return outcome.end == End::killed_by_signal;
}

/// Of a process that kept within its limits, or had none.
std::string sentence_on_crash(const MeshOptions& options, const Outcome& outcome,
                              const char* reader)
{
  const std::string how =
      is_killed(outcome) ? strsignal(outcome.code) : fmt::format("exit code {}", outcome.code);
  if (!options.file) {
    return fmt::format(
        "Gmsh crashed on the mesh that [mesh] describes ({}): take another element_size or "
        "pattern",
        how);
  }
  return fmt::format(
      "{0} crashed on it ({1}): it is damaged, or meets an error of {0}; open it in "
      "the program that it is of, or make it anew",
      reader, how);
}

/// @param reader  who reads the file: "Gmsh"
std::string sentence_on_end(const Outcome& outcome, const confinement::Limits& limits,
                            const char* reader)
{
  // In the midst of starting a program, signals are held back; then the kernel itself kills.
  const std::optional<Offence> offence =
      is_killed(outcome) && outcome.code == SIGSYS ? std::optional(Offence::program)
      : is_killed(outcome)                         ? std::nullopt
                                                   : confinement::offence_of(outcome.code);
  if (offence) return sentence(*offence);
  if (outcome.end == End::took_too_long || (is_killed(outcome) && outcome.code == SIGXCPU)) {
    return fmt::format("{} did not finish reading it within {:g} s; {}", reader, limits.seconds,
                       remedy);
  }
  if (outcome.end == End::said_too_much || outcome.code == confinement::exit_out_of_memory)
    return fmt::format("{} needs more than {} MiB for it; {}", reader, limits.memory / MiB, remedy);
  return "";
}

/// What is to be said of a mesher that gave no answer.
std::string explain(const MeshOptions& options, const std::optional<confinement::Limits>& limits,
                    const Outcome& outcome)
{
  const bool is_file = options.file.has_value();
  const char* reader = is_file && is_deck(*options.file)       ? "the reader of decks"
                       : is_file && is_exchange(*options.file) ? "its reader"
                                                               : "Gmsh";
  std::string text = limits ? sentence_on_end(outcome, *limits, reader)
                     : outcome.code == confinement::exit_out_of_memory
                         ? fmt::format("{} ran out of memory", reader)
                         : "";
  if (text.empty()) text = sentence_on_crash(options, outcome, reader);
  return is_file ? fmt::format("mesh file {}: {}", *options.file, text) : text;
}

/// @param subject  of the question, and `details` packs what stands behind the options
void ask_mesher(const MeshOptions& options, const std::string& subject,
                const std::function<void(Packer&)>& details,
                const std::function<void(Unpacker&)>& unpack)
{
  constexpr double unlimited = 1e8;  // s
  const std::optional<confinement::Limits> limits = limits_of(options);
  Packer question;
  question(subject);
  pack(question, limits);
  pack(question, options);
  details(question);
  confinement::ask(
      {.program = confinement::helper(confinement::mesher),
       .question = question.bytes(),
       .most_seconds = limits ? limits->seconds : unlimited,
       .most_bytes = limits ? limits->memory : bytes_of_machine()},
      [&](const Outcome& outcome) { return explain(options, limits, outcome); }, unpack);
}

}  // namespace

Mesh made_by_mesher(const MeshOptions& options)
{
  std::error_code unknown;
  const bool is_ours = options.file && options.trust == Trust::owner &&
                       has_own_reader(*options.file) && fs::is_regular_file(*options.file, unknown);
  if (is_ours) return read_here(options);
  Mesh mesh;
  ask_mesher(
      options, "mesh", [](Packer&) {}, [&](Unpacker& answer) { mesh = unpack_mesh(answer); });
  return mesh;
}

Declarations declarations(const MeshOptions& options, const DeckUnits& units)
{
  if (options.trust == Trust::owner) return declarations_here(options, units);
  Declarations declared;
  const auto details = [&](Packer& question) {
    question(units.length);
    question(units.force);
  };
  ask_mesher(options, "declarations", details,
             [&](Unpacker& answer) { declared = unpack_declarations(answer); });
  return declared;
}

}  // namespace chladni::mesh
