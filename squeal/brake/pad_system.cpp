#include "squeal/brake/pad_system.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/contact.hpp"
#include "squeal/numerics.hpp"

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
                               .patch = patch_radius(pad) / rings[pair.rings[0]].radius,
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

// Sums over the contact points of each pad: what is reported of a pad with a grid.

std::vector<ContactResult<double>> by_pad(const PadSystem& pads,
                                          const std::vector<ContactResult<double>>& points)
{
  std::vector<ContactResult<double>> sums;
  std::vector<int> counts;
  const auto add = [](PadState<double>& sum, const PadState<double>& x) {
    sum.z += x.z;
    sum.z_dot += x.z_dot;
    sum.N += x.N;
    sum.slip_speed = std::min(sum.slip_speed, x.slip_speed);
    sum.S += x.S;
    sum.f_r += x.f_r;
    sum.f_t += x.f_t;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == 0 || pads.points[i].pad != pads.points[i - 1].pad) {
      sums.push_back(points[i]);
      counts.push_back(1);
      continue;
    }
    ++counts.back();
    add(sums.back().upper, points[i].upper);
    add(sums.back().lower, points[i].lower);
  }
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (PadState<double>* pad : {&sums[i].upper, &sums[i].lower}) {
      pad->z /= counts[i];
      pad->z_dot /= counts[i];
    }
  return sums;
}

namespace {

void add_spring(PadMatrices& system, const Suspension& spring, Eigen::Index i, Eigen::Index j)
{
  for (const auto& [matrix, value] :
       {std::pair{&system.K, spring.stiffness}, std::pair{&system.C, spring.damping}}) {
    (*matrix)(i, i) += value;
    if (j < 0) continue;
    (*matrix)(j, j) += value;
    (*matrix)(i, j) -= value;
    (*matrix)(j, i) -= value;
  }
}

void add_pad(PadMatrices& system, const PadPair& pad, Eigen::Index first)
{
  const std::vector<PlateFreedom> all = freedoms(*pad.body, pad.shim);
  const auto n = static_cast<Eigen::Index>(all.size());
  const Eigen::Index caliper = first + 2 * n;
  for (Eigen::Index i = 0; i < 2 * n; ++i) {
    const PlateFreedom& freedom = all[static_cast<std::size_t>(i % n)];
    system.M(first + i, first + i) = freedom.inertia;
    const bool on_caliper = pad.caliper && freedom.direction == 2;
    add_spring(system, freedom.suspension, first + i, on_caliper ? caliper : -1);
  }
  if (!pad.caliper) return;
  system.M(caliper, caliper) = pad.caliper->mass;
  add_spring(system, pad.caliper->axial, caliper, -1);
}

}  // namespace

std::vector<PlateFreedom> freedoms(const PadBody& body, const std::optional<Shim>& shim)
{
  std::vector<PlateFreedom> all;
  const std::array translations{body.radial, body.tangential, body.axial};
  for (int i = 0; i < 3; ++i)
    if (const auto& suspension = translations[static_cast<std::size_t>(i)])
      all.push_back({i, body.mass, i == 2 && shim ? in_series(*suspension, *shim) : *suspension});
  const std::array rotations{body.about_radial, body.about_tangential, body.about_axial};
  for (int i = 0; i < 3; ++i)
    if (const auto& rotation = rotations[static_cast<std::size_t>(i)])
      all.push_back({3 + i, rotation->inertia, rotation->suspension});
  return all;
}

Eigen::Index n_coordinates(const PadPair& pad)
{
  if (!pad.body) return 0;
  return 2 * static_cast<Eigen::Index>(freedoms(*pad.body).size()) + (pad.caliper ? 1 : 0);
}

PadMatrices pad_matrices(const SquealOptions& options)
{
  Eigen::Index n = 0;
  for (const PadPair& pad : options.pads) n += n_coordinates(pad);
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(n, n);
  PadMatrices system{zero, zero, zero};
  Eigen::Index first = 0;
  for (const PadPair& pad : options.pads) {
    if (pad.body) add_pad(system, pad, first);
    first += n_coordinates(pad);
  }
  return system;
}

Eigen::MatrixXd pad_basis(const SquealOptions& options)
{
  const PadMatrices matrices = pad_matrices(options);
  if (matrices.M.size() == 0) return {};
  // As in pad_system, so that the modes are the same.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(matrices.K, matrices.M);
  return matrices.M.diagonal().cwiseSqrt().asDiagonal() * modes.eigenvectors();
}

std::array<PadFace, 2> faces_of_plate(double thickness, double radius)
{
  const double half = 0.5 * thickness;
  return {PadFace{.radius = radius, .plane = half, .distance = half},
          PadFace{.radius = radius, .plane = -half, .distance = -half}};
}

Suspension in_series(const Suspension& spring, const Shim& shim)
{
  using Complex = std::complex<double>;
  const double omega = 2.0 * std::numbers::pi * shim.frequency_Hz;
  const Complex k(spring.stiffness, omega * spring.damping);
  const Complex k_s = shim.stiffness * Complex(1.0, shim.loss_factor);
  const Complex both = k * k_s / (k + k_s);
  return {.stiffness = both.real(), .damping = both.imag() / omega};
}

double patch_radius(const PadPair& pad)
{
  if (pad.grid) return 0.0;
  if (pad.radius) return *pad.radius;
  return pad.area ? std::sqrt(*pad.area / std::numbers::pi) : 0.0;
}

bool lacks_a_size(const PadPair& pad)
{
  return !pad.grid && !pad.radius && !pad.area;
}

PadContact pad_contact(const SquealOptions& options, const PadPair& pad,
                       const std::array<PadFace, 2>& faces)
{
  Suspension lining{.stiffness = pad.stiffness, .damping = pad.damping};
  if (pad.shim && !pad.body) lining = in_series(lining, *pad.shim);
  return {.faces = faces,
          .friction = pad.friction.value_or(options.friction),
          .law = options.contact,
          .spring = {.linear = lining.stiffness, .cubic = pad.cubic_stiffness},
          .damping = lining.damping,
          .preload = pad.preload,
          .area = pad.area.value_or(0.0)};
}

namespace {

/// Heights of rings are known to this part of their radius.
constexpr double placement = 1e-6;

/// Heights of the lower and of the upper contact plane, m.
std::array<double, 2> plane_heights(const SquealOptions& options, double lower, double upper)
{
  if (options.planes->heights) return *options.planes->heights;
  const double middle = 0.5 * (lower + upper), half = 0.5 * options.thickness;
  return {middle - half, middle + half};
}

/// @param a, b  indices of the two rings, in any order, or twice the same one
RingPair pair_of(const SquealOptions& options, const std::vector<RingPlace>& rings, std::size_t a,
                 std::size_t b)
{
  if (!options.planes)
    return {.rings = {a, b}, .faces = faces_of_plate(options.thickness, rings[a].radius)};
  if (rings[a].height < rings[b].height) std::swap(a, b);
  const RingPlace &upper = rings[a], &lower = rings[b];
  if (a != b && upper.height - lower.height <= placement * upper.radius) {
    throw Error(
        fmt::format("[squeal] ring: \"{}\" and \"{}\" both lie at z = {:.6g} m; inboard and "
                    "outboard need rings "
                    "at two heights, or one ring for both: ring = \"{}\"",
                    upper.name, lower.name, upper.height, upper.name));
  }
  const auto [bottom, top] = plane_heights(options, lower.height, upper.height);
  const double half = 0.5 * (top - bottom);
  return {.rings = {a, b},
          .faces = {PadFace{upper.radius, half, top - upper.height},
                    PadFace{lower.radius, -half, bottom - lower.height}}};
}

std::size_t index_of(const std::vector<RingPlace>& rings, const std::string& name, std::size_t pad)
{
  const auto at = std::ranges::find(rings, name, &RingPlace::name);
  if (at == rings.end()) {
    throw Error(
        fmt::format("[squeal] pads[{}].grid.rings: the disc has no ring \"{}\"", pad, name));
  }
  return static_cast<std::size_t>(at - rings.begin());
}

}  // namespace

RingPair study_pair(const SquealOptions& options, const std::vector<RingPlace>& rings)
{
  const bool two = options.planes && !options.planes->opposite_ring.empty();
  return pair_of(options, rings, 0, two ? 1 : 0);
}

std::vector<RingPair> ring_pairs(const SquealOptions& options, const PadGrid& grid,
                                 const std::vector<RingPlace>& rings, std::size_t pad)
{
  if (grid.rings.empty()) return {study_pair(options, rings)};
  std::vector<RingPair> pairs;
  for (std::size_t i = 0; i < grid.rings.size(); ++i) {
    const std::size_t one = index_of(rings, grid.rings[i], pad);
    const std::size_t other =
        grid.opposite_rings.empty() ? one : index_of(rings, grid.opposite_rings[i], pad);
    pairs.push_back(pair_of(options, rings, one, other));
  }
  return pairs;
}

PointShapes::PointShapes(const Disc& disc) : disc_rings_(disc.rings) {}

std::vector<RingShapes>& PointShapes::with_patch(double patch)
{
  const auto known = rings_.find(patch);
  if (known != rings_.end()) return known->second;
  std::vector<RingShapes>& shapes = rings_[patch];
  for (DiscRing ring : disc_rings_) {
    for (Harmonics* f : {&ring.W, &ring.W_r, &ring.W_t, &ring.V_r, &ring.V_t})
      for (Eigen::Index d = 0; d < f->cosine.rows(); ++d) {
        const double mean = mean_over_patch(static_cast<int>(d), patch);
        f->cosine.row(d) *= mean;
        f->sine.row(d) *= mean;
      }
    shapes.emplace_back(ring);
  }
  return shapes;
}

const Eigen::MatrixXd& PointShapes::at(const PointPair& point, double angle)
{
  std::vector<RingShapes>& rings = with_patch(point.patch);
  const Eigen::MatrixXd& upper = rings[point.rings[0]].at(point.angle - angle);
  if (upper.cols() == middle_rows) return upper;
  both_.resize(upper.rows(), 2 * face_rows);
  both_.leftCols<face_rows>() = upper;
  both_.rightCols<face_rows>() = rings[point.rings[1]].at(point.angle - angle);
  return both_;
}

Eigen::MatrixXd shapes_at(const InertialDisc& disc, const PointPair& point)
{
  const auto of_ring = [&](std::size_t ring) {
    Eigen::MatrixXd shapes = matrix_of(shapes_at(disc, disc.rings[ring], point.angle));
    for (Eigen::Index i = 0; i < shapes.rows(); ++i) {
      shapes.row(i) *=
          mean_over_patch(disc.nodal_diameters[static_cast<std::size_t>(i)], point.patch);
    }
    return shapes;
  };
  const Eigen::MatrixXd upper = of_ring(point.rings[0]);
  if (upper.cols() == middle_rows) return upper;
  Eigen::MatrixXd both(upper.rows(), 2 * face_rows);
  both << upper, of_ring(point.rings[1]);
  return both;
}

}  // namespace chladni::squeal
