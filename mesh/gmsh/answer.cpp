#include "mesh/gmsh/answer.hpp"

#include <fmt/format.h>

#include "common/error.hpp"
#include "confinement/confine.hpp"
#include "mesh/decks/read_deck.hpp"
#include "mesh/gmsh/generators.hpp"
#include "mesh/gmsh/read_file.hpp"
#include "mesh/packed_mesh.hpp"
#include "mesh/packed_options.hpp"

namespace chladni::mesh {
namespace {

Mesh made(const MeshOptions& options, const std::function<void()>& before_reading)
{
  if (options.file) return read_file(options, before_reading);
  if (options.annulus) return unstructured_annulus(*options.annulus);
  if (options.hat_disc) return unstructured_hat_disc(*options.hat_disc);
  if (options.pad) return unstructured_patch(edges_of(*options.pad), patch_of(*options.pad));
  const RectangleOptions& rectangle = options.rectangle.value();
  return unstructured_patch(edges_of(rectangle), patch_of(rectangle));
}

}  // namespace

void answer(const std::string& subject, Unpacker& question, Packer& answer)
{
  const std::optional<confinement::Limits> limits = unpack_limits(question);
  MeshOptions options = unpack_options(question);
  options.trust = limits ? Trust::stranger : Trust::owner;
  const auto confine = [&] {
    if (limits) confinement::confine(*limits);
  };
  if (subject == "mesh") return pack(answer, made(options, confine));
  if (subject != "declarations") throw Error(fmt::format("nobody answers for \"{}\"", subject));
  DeckUnits units{};
  question(units.length);
  question(units.force);
  confine();
  pack(answer, declarations_here(options, units));
}

}  // namespace chladni::mesh
