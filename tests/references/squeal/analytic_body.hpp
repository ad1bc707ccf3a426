#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/transient/integrator_choice.hpp"
#include "squeal/transient/transient_steps.hpp"

namespace chladni::squeal::test {

using std::numbers::pi;

/// A pair of plate modes W = U (cos, sin)(n theta) on the ring, not mass-normalised; n = 0 is a
/// single mode. The pair may be rotated by `turn` (rad) and have its second mode reversed (`sign`),
/// as an eigensolver may return it for a double eigenvalue.
struct PlatePair {
  int n;  ///< nodal diameters
  double f_Hz;
  double mass;         ///< modal mass, kg
  double U;            ///< deflection on the ring
  double U_r;          ///< radial slope, 1/m
  double U_t;          ///< circumferential slope, 1/m; n U / r for a thin plate
  double turn = 0.0;   ///< rad
  double sign = 1.0;   ///< of the second mode, 1 or -1
  double split = 0.0;  ///< relative frequency split: the second mode has f_Hz (1 + split)
};

inline constexpr double ring_radius = 0.13;  ///< m

// SQUEAL reference values: disc 50 / 324 / 20 mm, Kirchhoff plate, closed form in Bessel functions,
// scaled to deflection 1 at the rim. Computed independently of this code.
inline PlatePair kirchhoff_pair(int n, double f_Hz, double mass, double U, double U_r)
{
  return {n, f_Hz, mass, U, U_r, n * U / ring_radius};
}
inline PlatePair kirchhoff_3(double f_Hz = 1749.7487734358904)
{
  return kirchhoff_pair(3, f_Hz, 1.6037467581009566, 0.6167886863496717, 10.927655001436424);
}
inline PlatePair kirchhoff_2()
{
  return kirchhoff_pair(2, 839.1289218193727, 1.8538737429258392, 0.6804592484370092,
                        9.568643508174414);
}
inline PlatePair kirchhoff_4()
{
  return kirchhoff_pair(4, 3056.51937233769, 1.406927567574736, 0.5577639701052876,
                        12.102403030433843);
}
/// The pair of a Mindlin plate, kappa = 5/6. Slopes are those of the director, so
/// U_t is not n U / r.
inline PlatePair mindlin_3()
{
  return {3,
          1672.090697994377,
          1.6337885261857095,
          0.6138865850599486,
          10.79586659952686,
          13.75762276510705};
}

/// A body with the modes of these pairs in the given order and one ring "track" of 60 nodes.
inline mbs_export::ModalBody analytic_body(const std::vector<PlatePair>& pairs)
{
  Eigen::Index n_modes = 0;
  for (const PlatePair& pair : pairs) n_modes += pair.n == 0 ? 1 : 2;
  const Eigen::Index n_nodes = 60;
  mbs_export::ContactRing ring{};
  ring.name = "track";
  ring.radius = ring_radius;
  ring.angles = Eigen::VectorXd::LinSpaced(n_nodes, 0.0, 2.0 * pi * (1.0 - 1.0 / n_nodes));
  ring.W = ring.W_r = ring.W_t = Eigen::MatrixXd::Zero(n_nodes, n_modes);

  mbs_export::ModalBody body{};
  body.omega.resize(n_modes);
  Eigen::Index i = 0;
  for (const PlatePair& p : pairs) {
    const double by_mass = 1.0 / std::sqrt(p.mass);
    const int size = p.n == 0 ? 1 : 2;
    for (int k = 0; k < size; ++k, ++i) {
      // cos(x - k pi / 2) is the cosine mode for k = 0 and the sine mode for k = 1.
      const Eigen::ArrayXd x = double(p.n) * ring.angles.array() - p.turn - k * 0.5 * pi;
      const double scale = by_mass * (k == 1 ? p.sign : 1.0);
      ring.W.col(i) = scale * p.U * x.cos();
      ring.W_r.col(i) = scale * p.U_r * x.cos();
      ring.W_t.col(i) = -scale * p.U_t * x.sin();
      body.omega[i] = 2.0 * pi * p.f_Hz * (1.0 + k * p.split);
      body.kinds.push_back(mbs_export::ModeKind::constrained);
    }
  }
  body.rings.push_back(ring);
  return body;
}

/// The undamped flexible disc of that body.
inline Disc disc_of(const std::vector<PlatePair>& pairs)
{
  return disc_on_ring(analytic_body(pairs), "track", {});
}

/// The state matrix as a function of the speed.
inline StateMatrixAt at_speeds(const InertialDisc& disc, const SquealOptions& options)
{
  return [disc, options](double speed) { return state_matrix(disc, options, speed); };
}

/// Options with one pad pair at angle 0: mu = 0.6, k = 6e6 N/m, N_0 = 2000 N, h = 20 mm, no pad
/// damping.
inline SquealOptions reference_options(ContactLaw law = ContactLaw::bilateral)
{
  SquealOptions options{};
  options.ring = "track";
  options.thickness = 0.02;
  options.study.speeds = {.from = pi, .to = 20.0 * pi, .count = 60};
  options.friction.kinetic = 0.6;
  options.contact = law;
  options.pads = {{.angle = 0.0, .stiffness = 6e6, .damping = 0.0, .preload = 2000.0}};
  return options;
}

/// The first n modal states of `transient`, at the samples of its tail and of a whole history.
/// @param step  Transient::step
inline std::vector<ModalState> states_of(const FlexibleDisc& brake, const TransientCase& run,
                                         double step, std::size_t n)
{
  const Disc& disc = brake.disc();
  const SquealOptions& options = brake.options();
  const std::optional<InertialDisc>& inertial = brake.find_inertial();
  const auto steps =
      transient_steps(disc, options, run, choose_integrator(disc, inertial, options, run), step,
                      transient_start(disc, inertial, run, options.pads.front().angle));
  std::vector<ModalState> states;
  for (std::size_t i = 0; i < n; ++i) {
    steps->next();
    states.push_back(steps->state());
  }
  return states;
}

}  // namespace chladni::squeal::test
