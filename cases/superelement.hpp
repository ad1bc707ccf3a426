#pragma once

#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "mesh/decks/declarations.hpp"

namespace chladni::cases {

/// Whether a file is a superelement of Nastran by its name: .pch, .dmig, .op4.
bool is_superelement(const std::string& file);

/// A reduced system that another program has made.
struct ImportedSystem {
  mbs_export::ReducedSystem system;
  std::vector<std::string> notes;  ///< what was left out, mass, motions that it resists
};

/// Reads a superelement of Nastran, in SI units. Of bulk data (.pch, .dmig) come the matrices as
/// DMIG, the grids, and the scalar points, which are amplitudes of modes; of an .op4 the matrices
/// alone, and the rest of the .pch or .asm of the same name beside it. Modes with held masters get
/// a unit mass and no coupling in K among each other. The grids of a SET1 are a set of attachment
/// nodes, all grids are the set "attachment", and each grid N is the set "grid_N".
/// @throws chladni::Error naming file, line and card, or matrix, grid and component of what is
///         wrong.
ImportedSystem imported_system(const std::string& file, const mesh::DeckUnits& units);

/// A scene, as TOML, for `chladni body` of that system.
std::string imported_scene(const ImportedSystem& imported, const std::string& name);

}  // namespace chladni::cases
