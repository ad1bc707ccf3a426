#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "references/squeal/analytic_body.hpp"
#include "squeal/assembly/assembly.hpp"

namespace chladni::squeal::test {

/// Mass and principal moments of inertia of a rigid plate.
struct RigidPlate {
  double mass;              ///< kg
  Eigen::Vector3d inertia;  ///< kg m^2
};

/// A free rigid plate as a body of six modes: a node "centre" in its centre of mass at the origin,
/// and nodes "face" at these places.
inline mbs_export::ModalBody plate_body(const RigidPlate& plate,
                                        const std::vector<Eigen::Vector3d>& face)
{
  mbs_export::ModalBody body{};
  body.omega = Eigen::VectorXd::Zero(6);
  body.kinds.assign(6, mbs_export::ModeKind::rigid);
  std::vector<Eigen::Vector3d> places{Eigen::Vector3d::Zero()};
  places.insert(places.end(), face.begin(), face.end());
  body.attachment_modes = Eigen::MatrixXd::Zero(6 * std::ssize(places), 6);
  mbs_export::AttachmentSet centre{"centre", {0}}, nodes{"face", {}};
  for (int i = 0; i < std::ssize(places); ++i) {
    const Eigen::Vector3d& x = places[static_cast<std::size_t>(i)];
    body.attachment_nodes.push_back({.number = i + 1, .position = x});
    if (i > 0) nodes.nodes.push_back(i);
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d e = Eigen::Vector3d::Unit(j);
      body.attachment_modes.block<3, 1>(6 * i, j) = e / std::sqrt(plate.mass);
      body.attachment_modes.block<3, 1>(6 * i, 3 + j) = e.cross(x) / std::sqrt(plate.inertia[j]);
      body.attachment_modes.block<3, 1>(6 * i + 3, 3 + j) = e / std::sqrt(plate.inertia[j]);
    }
  }
  body.sets = {centre, nodes};
  return body;
}

/// Points in the middle of `n` equal parts of a sector about the x axis, seen from (r, 0, height).
inline std::vector<Eigen::Vector3d> sector_points(double r, double sector, int n, double z = 0.0)
{
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < n; ++k) {
    const double turn = sector * ((k + 0.5) / n - 0.5);
    points.emplace_back(r * std::cos(turn) - ring_radius, r * std::sin(turn), z);
  }
  return points;
}

/// The largest distance of an eigenvalue of `expected` from the nearest one of `values`, 1/s.
inline double largest_distance(const Eigen::VectorXcd& expected, const Eigen::VectorXcd& values)
{
  double largest = 0.0;
  for (const std::complex<double>& lambda : expected)
    largest = std::max(largest, (values.array() - lambda).abs().minCoeff());
  return largest;
}

}  // namespace chladni::squeal::test
