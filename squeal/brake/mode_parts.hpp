#pragma once

#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Which modes of a body take part in what, 0-based.
struct ModeParts {
  std::vector<int> dynamic;       ///< with stiffness and inertia
  std::vector<int> quasi_static;  ///< with their compliance alone
  std::vector<int> still;         ///< in nothing, since no pad sees them; 1-based
};

/// The end of the range for which a body with interface modes was made, rad/s: that of a tolerance,
/// or of the modes that were kept. Others say nothing of one: infinite.
double range_of(const mbs_export::ModalBody& body);

/// The choice among all modes of `body`, whose disc with all of them is `disc`.
/// @throws chladni::Error as `make_disc` does.
ModeParts mode_parts(const Disc& disc, const mbs_export::ModalBody& body, const ModeChoice& choice);

}  // namespace chladni::squeal
