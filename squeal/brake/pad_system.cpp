#include "squeal/brake/pad_system.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/friction_range.hpp"
#include "squeal/brake/pad_matrices.hpp"
#include "squeal/brake/pads.hpp"
#include "squeal/brake/ring_pairs.hpp"
#include "squeal/derivative.hpp"

namespace chladni::squeal {
namespace {

/// A point of the face of a pad, in the axes of the pad: (radial, tangential, axial).
struct FacePoint {
  double turn;                ///< of its own radial axis against that of the pad, rad
  Eigen::Vector3d of_centre;  ///< position from the centre of mass, m
};

/// Columns (r, t, z) of the motion of a plate at a point, in the axes of the point, one row for
/// each freedom: u + theta x position.
Eigen::MatrixX3d plate_motion(const std::vector<PlateFreedom>& all, const FacePoint& point)
{
  Eigen::MatrixX3d J(static_cast<Eigen::Index>(all.size()), 3);
  const Eigen::Matrix3d to_point =
      Eigen::AngleAxisd(-point.turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (Eigen::Index i = 0; i < J.rows(); ++i) {
    const int direction = all[static_cast<std::size_t>(i)].direction;
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(direction % 3);
    const Eigen::Vector3d motion = direction < 3 ? axis : axis.cross(point.of_centre);
    J.row(i) = (to_point * motion).transpose();
  }
  return J;
}

/// The contact of one of `n` equal parts of a pad.
PadContact part_of(PadContact contact, int n)
{
  contact.spring.linear /= n;
  contact.spring.cubic /= n;
  contact.damping /= n;
  contact.preload /= n;
  contact.area /= n;
  return contact;
}

void check(const SquealOptions& options, std::size_t i)
{
  const PadPair& pad = options.pads[i];
  if (pad.body && freedoms(*pad.body).empty())
    throw Error(fmt::format("[squeal] pads[{}].body: it has no suspension and so cannot move", i));
  if (pad.caliper && !(pad.body && pad.body->axial)) {
    throw Error(fmt::format(
        "[squeal] pads[{}].caliper: it carries pads by their axial suspension; give body.axial",
        i));
  }
  if (pad.shim && pad.body && !pad.body->axial) {
    throw Error(fmt::format(
        "[squeal] pads[{}].shim: it lies behind the axial suspension of the plate; give body.axial",
        i));
  }
  const FrictionLaw law = pad.friction.value_or(options.friction);
  if (law.table && law.table->pressures.size() > 1 && !pad.area) {
    throw Error(fmt::format(
        "[squeal] pads[{}].area: its friction depends on the pressure; give the area of its face",
        i));
  }
}

/// The points of pad `i` of the scene, on one ring after the other.
void add_points(PadSystem& system, const SquealOptions& options, std::size_t i,
                const std::vector<RingPlace>& rings)
{
  const PadPair& pad = options.pads[i];
  const PadGrid grid = pad.grid.value_or(PadGrid{.sector = 0.0, .points = 1});
  const std::vector<RingPair> on = ring_pairs(options, grid, rings, i);
  const int n = grid.points * static_cast<int>(on.size());
  for (const RingPair& pair : on)
    for (int k = 0; k < grid.points; ++k) {
      const double turn = grid.sector * ((k + 0.5) / grid.points - 0.5);
      system.points.push_back({.pad = i,
                               .angle = pad.angle + turn,
                               .patch = pad.radius.value_or(0.0) / rings[pair.rings[0]].radius,
                               .rings = pair.rings,
                               .contact = part_of(pad_contact(options, pad, pair.faces), n),
                               .upper = {},
                               .lower = {}});
    }
}

/// Motion of the plates at each point, in all coordinates of the pads; the centre of a plate is
/// above (below) the ring of the study.
void add_plate_motion(PadSystem& system, const SquealOptions& options,
                      const std::array<PadFace, 2>& study, Eigen::Index n)
{
  for (PointPair& point : system.points) {
    const PadPair& pad = options.pads[point.pad];
    point.upper = point.lower = Eigen::MatrixX3d::Zero(n, 3);
    if (!pad.body) continue;
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < point.pad; ++i) first += n_coordinates(options.pads[i]);
    const std::vector<PlateFreedom> all = freedoms(*pad.body);
    const auto n_plate = static_cast<Eigen::Index>(all.size());
    const double turn = point.angle - pad.angle;
    const auto at = [&](std::size_t side, double height) -> FacePoint {
      const double radius = point.contact.faces[side].radius;
      return {turn,
              {radius * std::cos(turn) - study[side].radius, radius * std::sin(turn), height}};
    };
    point.upper.middleRows(first, n_plate) = plate_motion(all, at(0, -pad.body->height));
    point.lower.middleRows(first + n_plate, n_plate) = plate_motion(all, at(1, pad.body->height));
  }
}

}  // namespace

PadSystem pad_system(const SquealOptions& options, double radius)
{
  return pad_system(options, std::vector<RingPlace>{{options.ring, radius}});
}

PadSystem pad_system(const SquealOptions& options, const std::vector<RingPlace>& rings)
{
  PadSystem system;
  system.disc_rows = options.planes ? 2 * face_rows : middle_rows;
  for (std::size_t i = 0; i < options.pads.size(); ++i) {
    check(options, i);
    add_points(system, options, i, rings);
  }
  const PadMatrices matrices = pad_matrices(options);
  if (matrices.M.size() == 0) return system;
  add_plate_motion(system, options, study_pair(options, rings).faces, matrices.M.rows());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(matrices.K, matrices.M);
  const Eigen::MatrixXd& Phi = modes.eigenvectors();  // Phi^T M Phi = I
  system.omega = modes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  system.C = Phi.transpose() * matrices.C * Phi;
  for (PointPair& point : system.points) {
    point.upper = Phi.transpose() * point.upper;
    point.lower = Phi.transpose() * point.lower;
  }
  return system;
}

InertialDisc with_pads(InertialDisc disc, const PadSystem& pads)
{
  const Eigen::Index n = disc.n_modes(), m = pads.n_modes();
  if (m == 0) return disc;
  const auto extended = [&](const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n + m, n + m);
    sum.topLeftCorner(n, n) = A;
    sum.bottomRightCorner(m, m) = B;
    return sum;
  };
  disc.C = extended(disc.C, pads.C);
  disc.G = extended(disc.G, Eigen::MatrixXd::Zero(m, m));
  disc.D = extended(disc.D, Eigen::MatrixXd::Zero(m, m));
  disc.R = extended(disc.R, Eigen::MatrixXd::Identity(m, m));
  for (InertialRing& ring : disc.rings)
    for (Eigen::VectorXd* amplitude : amplitudes_of(ring))
      amplitude->conservativeResizeLike(Eigen::VectorXd::Zero(n + m));
  disc.omega.conservativeResize(n + m);
  disc.omega.tail(m) = pads.omega;
  disc.nodal_diameters.resize(static_cast<std::size_t>(n + m), 0);
  return disc;
}

PairShapes pair_shapes(const Eigen::MatrixXd& S, const PadSystem& pads, const PointPair& point)
{
  const Eigen::Index m = pads.n_modes();
  PairShapes shapes = PairShapes::Zero(S.rows() + m, pads.rows());
  shapes.topLeftCorner(S.rows(), S.cols()) = S;
  if (m > 0) shapes.bottomRightCorner(m, 6) << point.upper, point.lower;
  return shapes;
}

BrakePoint brake_point(const Eigen::MatrixXd& S, const PadSystem& pads, const PointPair& point,
                       double speed)
{
  require_in_table(point.contact, speed);
  return {.contact = point.contact,
          .S = pair_shapes(S, pads, point),
          .at_rest = states_at_rest(point.contact, speed)};
}

PairContact contact_at(const BrakePoint& point, const PointMotion& motion, double speed)
{
  const PairMotion<double> m = pair_motion(motion.g, motion.g_dot);
  const ContactResult<double> states = contact(point.contact, m, speed);
  return {states,
          pair_forces(point.contact, m, states, point.at_rest, static_cast<int>(motion.g.size()))};
}

FreeBrake free_brake(const Disc& disc, const PadSystem& pads, double speed)
{
  const Eigen::Index n = disc.n_modes(), m = pads.n_modes();
  FreeBrake brake{Eigen::VectorXd(n + m), Eigen::MatrixXd::Zero(n + m, n + m)};
  brake.omega.head(n) = disc.omega;
  brake.C.topLeftCorner(n, n) = disc.C + 2.0 * speed * disc.G;
  if (m == 0) return brake;
  brake.omega.tail(m) = pads.omega;
  brake.C.bottomRightCorner(m, m) = pads.C;
  return brake;
}

PairDerivatives pair_derivatives(const PadContact& pad, double speed, int rows)
{
  using Complex = std::complex<double>;
  require_in_table(pad, speed);
  const RestStates at_rest = states_at_rest(pad, speed);
  const Eigen::MatrixXd D = derivative_at_rest(
      [&](const Eigen::VectorXcd& y) -> Eigen::VectorXcd {
        const auto m = pair_motion<Complex>(y.head(rows), y.tail(rows));
        return pair_forces(pad, m, contact(pad, m, speed), at_rest, rows);
      },
      Eigen::Index{2} * rows);
  return {D.leftCols(rows), D.rightCols(rows)};
}

}  // namespace chladni::squeal
