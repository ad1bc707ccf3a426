#pragma once

#include <optional>
#include <string>
#include <vector>

namespace chladni::squeal {

/// What happens when the disc pulls away from a pad.
enum class ContactLaw {
  bilateral,    ///< the pad also pulls; |N| in the friction law (the thesis)
  unilateral,   ///< contact is lost
  signed_force  ///< the pad also pulls; friction changes sign with N
};

/// A spring and a damper side by side.
struct Suspension {
  double stiffness;  ///< N/m, or N m for a rotation; > 0
  double damping;    ///< N s/m, or N m s
};

/// A rotation of a pad on a spring and a damper.
struct RotarySuspension {
  double inertia;  ///< kg m^2
  Suspension suspension;
};

/// The plate of a pad as a rigid body with those of its six degrees of freedom that have a
/// suspension. Its lining, between plate and disc, has the stiffness of the pad.
struct PadBody {
  double mass;          ///< kg
  double height = 0.0;  ///< of its centre of mass above the contact plane, m
  std::optional<Suspension> radial = {}, tangential = {}, axial = {};
  std::optional<RotarySuspension> about_radial = {}, about_tangential = {}, about_axial = {};
};

/// A rigid body between the axial suspensions of the two plates of a pair and the ground.
struct Caliper {
  double mass;  ///< kg
  Suspension axial;
};

/// Point contacts in the middle of equal parts of a sector, which share stiffness, damping and
/// preload of the pad.
struct PadGrid {
  double sector;  ///< rad
  int points;
};

/// One pad pair: an upper and a lower pad on one vertical axis; massless unless it has a body.
struct PadPair {
  double angle;                  ///< inertial angle of the axis, rad
  double stiffness;              ///< of each pad spring, N/m
  double damping;                ///< N s/m
  double preload;                ///< N_0 of each pad, N
  double cubic_stiffness = 0.0;  ///< k_3 of each pad spring, N/m^3
  std::optional<PadGrid> grid = {};
  std::optional<PadBody> body = {};
  std::optional<Caliper> caliper = {};  ///< needs a body with an axial suspension
};

/// Rotation speeds, rad/s, equally spaced.
struct SpeedRange {
  double from;
  double to;
  int count;
};

/// Which modes of the body take part: exactly one member is set; none means all.
struct ModeChoice {
  std::optional<int> nodal_diameters;    ///< the lowest pair with so many nodal diameters
  std::optional<std::vector<int>> list;  ///< 1-based mode numbers of the body
};

/// A transient from a small initial displacement of the pads at rest in the inertial frame.
struct TransientCase {
  double speed;                     ///< rad/s
  double duration;                  ///< s
  double initial_pad_displacement;  ///< m
  int steps_per_period = 40;        ///< of the highest frequency among the modes used
};

/// Growth of the pad velocity over a short transient at each of several speeds.
struct GrowthCase {
  std::vector<double> speeds;  ///< rad/s
  double duration;             ///< s
};

/// A limit cycle that is found without a transient.
struct DirectCase {
  double speed;  ///< rad/s
};

/// The second parameter of a stability map; the first is the speed.
enum class MapParameter {
  friction,  ///< mu
  preload,   ///< N_0 of every pad, N
  stiffness  ///< k of every pad, N/m
};

/// Growth rates over the speeds of the study and over one more parameter, equally spaced.
struct MapCase {
  MapParameter parameter;
  double from;
  double to;
  int count;
};

/// The scene's [squeal].
struct SquealOptions {
  std::string ring;
  double thickness;  ///< distance h of the two contact planes, m
  ModeChoice modes;
  SpeedRange speeds;
  double friction;  ///< Coulomb coefficient mu; beside the next three that of fast sliding
  double friction_rise = 0.0;         ///< static minus kinetic coefficient
  double friction_decay_speed = 1.0;  ///< of the rise, m/s; see FrictionLaw
  double slip_regularisation = 0.0;   ///< m/s
  ContactLaw contact = ContactLaw::unilateral;
  std::vector<PadPair> pads;
  std::vector<std::string> analyses;  ///< "eigenvalues", "critical-speed", "growth", "transient",
                                      ///< "limit-cycle", "limit-cycle-direct",
                                      ///< "limit-cycle-branch", "stability-map"
  std::optional<TransientCase> transient;
  std::optional<GrowthCase> growth;
  std::optional<DirectCase> limit_cycle_direct;
  std::optional<MapCase> map;
};

}  // namespace chladni::squeal
