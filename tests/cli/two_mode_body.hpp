#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "mbs_export/modal_body.hpp"
#include "tests/cli/programs.hpp"

namespace chladni::cli::testing {

inline std::string example_scene()
{
  return read_text(CHLADNI_SOURCE_DIR "/examples/thesis_disc/scene.toml");
}

/// The contact ring of a pair of modes with three nodal diameters, mass-normalised, shape U at the
/// ring and radial slope dU.
inline mbs_export::ContactRing ring_of_the_pair(double U, double dU)
{
  constexpr int n = 60;
  constexpr double radius = 0.13;
  mbs_export::ContactRing ring{.name = "track",
                               .radius = radius,
                               .height = 0.0,
                               .nodes = {},
                               .angles = Eigen::VectorXd(n),
                               .W = Eigen::MatrixXd(n, 2),
                               .W_r = Eigen::MatrixXd(n, 2),
                               .W_t = Eigen::MatrixXd(n, 2)};
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n;
    const Eigen::RowVector2d shape(std::cos(3.0 * angle), std::sin(3.0 * angle));
    const Eigen::RowVector2d derivative(-3.0 * shape[1], 3.0 * shape[0]);
    ring.nodes.push_back(i);
    ring.angles[i] = angle;
    ring.W.row(i) = U * shape;
    ring.W_r.row(i) = dU * shape;
    ring.W_t.row(i) = U / radius * derivative;
  }
  return ring;
}

/// The disc as two modes of a Kirchhoff plate (Vogel and Skinner) at 1672.13 Hz.
inline mbs_export::ModalBody kirchhoff_body()
{
  const double root_of_mass = std::sqrt(1.60374675810);
  mbs_export::ModalBody body{};
  body.title = "two modes";
  body.kinds.assign(2, mbs_export::ModeKind::constrained);
  body.omega = Eigen::Vector2d::Constant(2.0 * std::numbers::pi * 1672.13);
  const mbs_export::ContactRing ring =
      ring_of_the_pair(0.616788686350 / root_of_mass, 10.9276550014 / root_of_mass);
  for (int i = 0; i < ring.angles.size(); ++i) {
    const double angle = ring.angles[i];
    body.attachment_nodes.push_back(
        {.number = i + 1,
         .position = {ring.radius * std::cos(angle), ring.radius * std::sin(angle), 0.0}});
  }
  body.sets = {{.name = "track", .nodes = ring.nodes}};
  body.fixed = {"hub"};
  body.attachment_modes = Eigen::MatrixXd::Zero(6 * ring.angles.size(), 2);
  body.rings = {ring};
  body.mass = 10.1;
  body.centre_of_mass.setZero();
  body.inertia.setIdentity();
  body.free_frequencies = Eigen::VectorXd::Zero(6);
  body.n_rigid = 6;
  body.condition_Q_dd = 1.0;
  return body;
}

}  // namespace chladni::cli::testing
