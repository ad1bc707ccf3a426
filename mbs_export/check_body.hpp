#pragma once

#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

enum class Verdict { pass, warn, fail };

/// A property that a sound body has, and how well a given body has it.
struct Check {
  std::string name;  ///< "symmetry of K", "rigid-body energy", ...
  Verdict verdict;
  double value;         ///< a relative error, or a count
  double limit;         ///< a check warns or fails above it; NaN if every value is allowed
  std::string meaning;  ///< what was compared, or what is probably wrong
};

/// Checks a reduced system: symmetry, definiteness, rigid-body energy and grounding, mechanisms,
/// mass and inertia, the block of the fixed-interface modes, orthogonality of the free modes,
/// condition numbers. Relative errors fail above their limit and warn within a factor of 100 below
/// it.
std::vector<Check> check_reduced(const ReducedSystem& reduced);

/// Checks a modal body: the number of rigid modes, rigid modes against geometry and inertia, held
/// displacements, frequencies against those of the free body, damping, mass and inertia,
/// conditioning, contact rings against the attachment nodes.
std::vector<Check> check_body(const ModalBody& body);

/// The worst verdict of all checks; `pass` if there are none.
Verdict worst(const std::vector<Check>& checks);

}  // namespace chladni::mbs_export
