#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "squeal/friction.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// A spring and a damper in parallel.
struct Suspension {
  double stiffness;  ///< N/m, or N m for a rotation; > 0
  double damping;    ///< N s/m, or N m s
};

/// A rotational degree of freedom of a pad on a spring and a damper.
struct RotarySuspension {
  double inertia;  ///< kg m^2
  Suspension suspension;
};

/// The back plate of a pad as a rigid body. Only those of its six degrees of freedom that have a
/// suspension can move. The lining between plate and disc has the stiffness of the pad.
struct PadBody {
  double mass;          ///< kg
  double height = 0.0;  ///< height of its centre of mass above the contact plane, m
  std::optional<Suspension> radial = {}, tangential = {}, axial = {};
  std::optional<RotarySuspension> about_radial = {}, about_tangential = {}, about_axial = {};
};

/// A rigid caliper between the axial suspensions of the two plates of a pair and the ground.
struct Caliper {
  double mass;  ///< kg
  Suspension axial;
};

/// Contact points at the centres of equal parts of a sector. They share stiffness, damping and
/// preload of the pad equally.
struct PadGrid {
  double sector;                        ///< angle of the sector, rad
  int points;                           ///< number of points on each ring
  std::vector<std::string> rings = {};  ///< contact rings of the body; empty: the ring of the study
  /// Rings of the other contact plane, one for each of `rings`; empty: one ring for both pads.
  std::vector<std::string> opposite_rings = {};
};

/// A damping layer behind a pad with the complex stiffness k_s (1 + i eta), in series with the
/// spring of a massless pad or with the axial suspension of the plate. It is replaced by a viscous
/// model that is equivalent at one frequency.
struct Shim {
  double stiffness;     ///< stiffness k_s, N/m
  double loss_factor;   ///< loss factor eta
  double frequency_Hz;  ///< frequency at which the viscous model is equivalent
};

/// The spring and damper that, at the frequency of the shim, have the complex stiffness of `spring`
/// and `shim` in series.
Suspension in_series(const Suspension& spring, const Shim& shim);

/// A pad pair: an upper and a lower pad on one vertical axis, massless unless they have a body.
struct PadPair {
  double angle;                  ///< angle of the axis in the inertial frame, rad
  double stiffness;              ///< stiffness of each pad spring, N/m
  double damping;                ///< damping of each pad, N s/m
  double preload;                ///< preload N_0 of each pad, N
  double cubic_stiffness = 0.0;  ///< k_3 of each pad spring, N/m^3
  std::optional<PadGrid> grid = {};
  std::optional<PadBody> body = {};
  std::optional<Caliper> caliper = {};  ///< needs a body with an axial suspension
  std::optional<Shim> shim = {};
  std::optional<FrictionLaw> friction = {};  ///< absent: the friction of the brake
  /// Area of each pad's face for its pressure, m^2, and of its patch without `radius` and `grid`.
  std::optional<double> area = {};
  /// Radius of the round patch of each pad's face, m; 0: a point, whatever the area. Not with a
  /// grid.
  std::optional<double> radius = {};
};

/// Radius of the round patch that each pad of the pair touches, m: its own, or that of its area;
/// 0 for a point.
double patch_radius(const PadPair& pad);

/// Whether the pads touch a point because nothing says how large they are.
bool lacks_a_size(const PadPair& pad);

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
