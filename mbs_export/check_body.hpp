#pragma once

#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

enum class Verdict { pass, warn, fail };

/// One property that a sound body has, and how well a given one has it.
struct Check {
  std::string name;  ///< "symmetry of K", "rigid-body energy", ...
  Verdict verdict;
  double value;         ///< an error relative to what it is compared with, or a count
  double limit;         ///< beyond it a check fails or warns; NaN when every value will do
  std::string meaning;  ///< what was compared, or what is probably wrong
};

/// Symmetry, definiteness, rigid-body energy and grounding, mechanisms, mass and inertia, the block
/// of the fixed-interface modes, orthogonality of the free modes, condition numbers. Relative
/// errors fail beyond their limit and warn within a factor of 100 of it.
std::vector<Check> check_reduced(const ReducedSystem& reduced);

/// Counts of rigid modes, rigid modes against geometry and inertia, held displacements, frequencies
/// against those of the free body, damping, mass and inertia, conditioning, contact rings against
/// the attachment nodes.
std::vector<Check> check_body(const ModalBody& body);

/// The worst verdict of all; `pass` of none.
Verdict worst(const std::vector<Check>& checks);

}  // namespace chladni::mbs_export
