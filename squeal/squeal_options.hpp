#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "squeal/friction.hpp"
#include "squeal/pad_options.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// Behaviour of a pad when the disc moves away from it.
enum class ContactLaw {
  bilateral,    ///< the pad also pulls, with |N| in the friction law (the thesis)
  unilateral,   ///< contact is lost
  signed_force  ///< the pad also pulls; friction changes sign with N
};

/// The modes of the body that take part. At most one of the first two is set; none means all modes.
struct ModeChoice {
  std::optional<int> nodal_diameters = {};  ///< the lowest pair with this number of nodal diameters
  std::optional<std::vector<int>> list = {};  ///< 1-based mode numbers of the body
  /// Modes above this angular frequency (rad/s) contribute their compliance only, without inertia.
  /// Absent: this holds for the interface modes beyond the range for which the body was made.
  std::optional<double> quasi_static_above = {};
};

/// Contact planes with the displacements of their rings in all three directions: each plane with
/// its own ring, or both with one ring that need not lie in the middle.
struct ContactPlanes {
  std::string opposite_ring = {};  ///< ring of the other plane; empty: one ring for both
  /// z of the lower and the upper plane, m; absent: half the thickness below and above the middle
  /// of the rings.
  std::optional<std::array<double, 2>> heights = {};
};

/// The options of [squeal] for a flexible disc: the brake around a modal body, and the study.
struct SquealOptions {
  std::string ring;
  double thickness;  ///< distance h of the two contact planes, m
  /// Absent: `ring` lies in the middle surface of a plate, whose in-plane displacements do not act
  /// on the pads.
  std::optional<ContactPlanes> planes = {};
  /// Rings beside those of the contact, from whose axial displacements radial slopes are computed;
  /// empty: from the rotations of the nodes.
  std::vector<std::string> slopes_from = {};
  ModeChoice modes;
  FrictionLaw friction;
  ContactLaw contact = ContactLaw::unilateral;
  std::vector<PadPair> pads;
  /// If true, small differences of frequency or damping within pairs of modes are not averaged, and
  /// the disc has no inertial frame, however small they are.
  bool keeps_asymmetry = false;
  StudyOptions study;
};

}  // namespace chladni::squeal
