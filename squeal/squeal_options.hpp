#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "squeal/friction.hpp"
#include "squeal/pad_options.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// What happens when the disc pulls away from a pad.
enum class ContactLaw {
  bilateral,    ///< the pad also pulls; |N| in the friction law (the thesis)
  unilateral,   ///< contact is lost
  signed_force  ///< the pad also pulls; friction changes sign with N
};

/// Which modes of the body take part: at most one of the first two is set; none means all.
struct ModeChoice {
  std::optional<int> nodal_diameters = {};    ///< the lowest pair with so many nodal diameters
  std::optional<std::vector<int>> list = {};  ///< 1-based mode numbers of the body
  /// Modes of higher frequency follow the pads without inertia, rad/s; absent: with interface modes
  /// the end of the range for which the body was made, else none.
  std::optional<double> quasi_static_above = {};
};

/// Two contact planes that move by themselves, with the displacements of their rings in all three
/// directions: those of a ring each, or both of one ring that need not lie in the middle.
struct ContactPlanes {
  std::string opposite_ring = {};  ///< of the other plane; empty: one ring for both
  /// z of the lower and of the upper plane, m; absent: half the thickness on both sides of the
  /// middle of the rings.
  std::optional<std::array<double, 2>> heights = {};
};

/// The scene's [squeal] with a flexible disc: the brake around a modal body, and its study.
struct SquealOptions {
  std::string ring;
  double thickness;  ///< distance h of the two contact planes, m
  /// Absent: `ring` lies in the middle surface of a plate, whose displacements along the plane no
  /// pad feels.
  std::optional<ContactPlanes> planes = {};
  /// Rings beside those of the contact, from whose displacements along the axis radial slopes are
  /// taken; empty: from the rotations of the nodes.
  std::vector<std::string> slopes_from = {};
  ModeChoice modes;
  FrictionLaw friction;
  ContactLaw contact = ContactLaw::unilateral;
  std::vector<PadPair> pads;
  /// Small differences within pairs of modes, of frequency or damping, are not averaged: the disc
  /// has no inertial frame, however small they are.
  bool keeps_asymmetry = false;
  StudyOptions study;
};

}  // namespace chladni::squeal
