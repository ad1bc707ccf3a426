#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>

#include "common/error.hpp"
#include "confinement/confine.hpp"
#include "confinement/errand.hpp"
#include "mesh/decks/read_deck.hpp"
#include "mesh/mesh_reader.hpp"
#include "mesh/packed_mesh.hpp"

namespace chladni::mesh {
namespace {

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
bool answer(const std::vector<char>& bytes)
{
  std::size_t said = 0;
  while (said < bytes.size()) {
    const ssize_t n =
        ::write(confinement::answer_descriptor, bytes.data() + said, bytes.size() - said);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) said += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

int answer_with_mesh()
{
  Packer packer;
  try {
    const std::vector<char> question = read_question();
    Unpacker unpacker(question);
    confinement::Limits limits{};
    unpacker(limits.memory);
    unpacker(limits.seconds);
    Wanted wanted{};
    unpacker(wanted);
    const MeshOptions options = unpack_options(unpacker);
    const auto confine = [&] { confinement::confine(limits); };
    packer(true);
    if (wanted == Wanted::mesh) {
      pack(packer, read_here(options, confine));
    } else {
      DeckUnits units{};
      unpacker(units.length);
      unpacker(units.force);
      confine();
      pack(packer, declarations_here(options, units));
    }
  } catch (const Error& error) {
    packer = Packer{};
    packer(false);
    packer(std::string(error.what()));
  }
  // Destructors of libraries at exit are not for what a file may have damaged.
  _exit(answer(packer.bytes()) ? 0 : 1);
}

}  // namespace chladni::mesh
