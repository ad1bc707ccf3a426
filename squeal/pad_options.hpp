#pragma once

#include <optional>
#include <string>
#include <vector>

#include "squeal/friction.hpp"

namespace chladni::squeal {

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
  double sector;                        ///< rad
  int points;                           ///< on each ring
  std::vector<std::string> rings = {};  ///< of the body; empty: that of the study
  /// [rings] the rings of the other contact plane; empty where one ring serves both pads.
  std::vector<std::string> opposite_rings = {};
};

/// A layer with loss behind a pad, in series with the spring of a pad without mass, or with the
/// axial suspension of the plate: k_s (1 + i eta). Its viscous equivalent is that at one frequency.
struct Shim {
  double stiffness;     ///< k_s, N/m
  double loss_factor;   ///< eta
  double frequency_Hz;  ///< at which spring and damper together are those of the layers
};

/// Spring and damper that at the frequency of the shim have the stiffness of both in series.
Suspension in_series(const Suspension& spring, const Shim& shim);

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
  std::optional<Shim> shim = {};
  std::optional<FrictionLaw> friction = {};  ///< of this pair; absent: that of the brake
  std::optional<double> area = {};           ///< of the face of each pad, m^2; for its pressure
};

}  // namespace chladni::squeal
