#pragma once

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

/// The scene's [squeal] with a flexible disc: the brake around a modal body, and its study.
struct SquealOptions {
  std::string ring;
  double thickness;  ///< distance h of the two contact planes, m
  ModeChoice modes;
  FrictionLaw friction;
  ContactLaw contact = ContactLaw::unilateral;
  std::vector<PadPair> pads;
  StudyOptions study;
};

}  // namespace chladni::squeal
