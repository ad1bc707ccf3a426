#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "mbs_export/modal_body.hpp"
#include "squeal/assembly/assembly.hpp"
#include "tests/references/squeal/analytic_body.hpp"

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

/// A plate whose face nodes move along z alone in modes of their own as well, as many as there are.
inline mbs_export::ModalBody bending_plate(const RigidPlate& plate,
                                           const std::vector<Eigen::Vector3d>& face)
{
  mbs_export::ModalBody body = plate_body(plate, face);
  const Eigen::Index n = std::ssize(face), rows = body.attachment_modes.rows();
  body.attachment_modes.conservativeResize(rows, 6 + n);
  body.attachment_modes.rightCols(n).setZero();
  for (Eigen::Index i = 0; i < n; ++i) body.attachment_modes(6 * (i + 1) + 2, 6 + i) = 1.0;
  body.omega.conservativeResize(6 + n);
  for (Eigen::Index i = 0; i < n; ++i)
    body.omega[6 + i] = 2.0 * pi * (2000.0 + 10.0 * static_cast<double>(i));
  body.kinds.resize(static_cast<std::size_t>(6 + n), mbs_export::ModeKind::constrained);
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

inline constexpr double speed = 18.0, sector = 0.5, height = 0.01, half_disc = 0.01;
inline constexpr int n_points = 5;

inline const RigidPlate plate{.mass = 0.3, .inertia = {1.5e-4, 1e-4, 2e-4}};

/// What holds the plate of today's pads and, as a joint, those of an assembly.
inline const std::array<double, 6> stiffness{3e7, 2e7, 5e6, 3e3, 2e3, 2e4};
inline const std::array<double, 6> damping{20.0, 20.0, 30.0, 0.05, 0.05, 0.05};

inline PartOptions part_at(const std::string& name, double z, double rotation_x = 0.0)
{
  return {.name = name,
          .body = name + ".body.h5",
          .position = {ring_radius, 0.0, z},
          .rotation = {rotation_x, 0.0, 0.0}};
}

inline JointOptions suspension_of(const std::string& part)
{
  return {.ends = {PartNodes{part, "centre"}, PartNodes{}},
          .rigid = {},
          .stiffness = stiffness,
          .damping = damping};
}

inline FaceContact lining_of(const std::string& part)
{
  return {.face = {part, "face"},
          .height = height,
          .stiffness = {6e6},
          .damping = {4.0},
          .preload = {2000.0},
          .shares = NodeShares::equal};
}

/// A disc between two rigid plates, the second one turned over.
inline AssemblyOptions two_plates()
{
  const double z = half_disc + height;
  return {.parts = {{.name = "disc", .body = "disc.body.h5"},
                    part_at("upper", z),
                    part_at("lower", -z, pi)},
          .joints = {suspension_of("upper"), suspension_of("lower")},
          .contacts = {lining_of("upper"), lining_of("lower")},
          .disc = "disc",
          .rings = {"track"},
          .thickness = 2.0 * half_disc,
          .friction = {.kinetic = 0.6}};
}

inline std::vector<mbs_export::ModalBody> bodies_of_two_plates()
{
  const auto face = plate_body(plate, sector_points(ring_radius, sector, n_points));
  return {analytic_body({kirchhoff_3(), kirchhoff_2()}), face, face};
}

inline mbs_export::ModalBody disc_with_two_rings()
{
  auto body = analytic_body({kirchhoff_3()});
  for (const double radius : {0.12, 0.14}) {
    body.rings.push_back(body.rings.front());
    body.rings.back().name = radius < 0.13 ? "inner" : "outer";
    body.rings.back().radius = radius;
  }
  return body;
}

inline std::string error_of(
    const AssemblyOptions& options,
    const std::vector<mbs_export::ModalBody>& bodies = bodies_of_two_plates())
{
  try {
    assembly(options, bodies);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
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
