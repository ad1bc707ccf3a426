#include "squeal/assembly/assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/assembly/face.hpp"
#include "squeal/assembly/joints.hpp"
#include "squeal/brake/disc.hpp"

namespace chladni::squeal {
namespace {

using mbs_export::ModalBody;

/// The disc with all its modes: interface modes have their inertia here.
Disc turning_disc(const AssemblyOptions& options, const ModalBody& body)
{
  const RingChoice rings{.names = options.rings,
                         .in_plane = options.planes.has_value(),
                         .slopes_from = options.slopes_from};
  try {
    Disc disc =
        make_disc(body, rings, {.quasi_static_above = std::numeric_limits<double>::infinity()});
    refuse_aliases(disc, body);
    return disc;
  } catch (const Error& error) {
    const auto part = std::ranges::find(options.parts, options.disc, &PartOptions::name);
    throw Error(
        fmt::format("squeal.disc: part \"{}\" ({}): {}", part->name, part->body, error.what()));
  }
}

/// The parts that do not turn, and the body of the one that does.
struct Placed {
  std::vector<Part> parts;
  const ModalBody* disc;
};

Placed placed_parts(const AssemblyOptions& options, std::span<const ModalBody> bodies)
{
  Placed all{.parts = {}, .disc = nullptr};
  for (std::size_t i = 0; i < options.parts.size(); ++i)
    if (options.parts[i].name == options.disc)
      all.disc = &bodies[i];
    else
      all.parts.push_back(placed(options.parts[i], bodies[i]));
  if (!all.disc) throw Error(fmt::format("squeal.disc: there is no part \"{}\"", options.disc));
  return all;
}

double total(const FaceQuantity& quantity, double area, const std::string& key)
{
  if (!quantity.per_area) return quantity.value;
  if (area > 0.0) return quantity.value * area;
  throw Error(fmt::format(
      "{}: the area of its nodes is not known (they lie on one line or circle, or reach "
      "more than a quarter of a turn to a side of their middle); give stiffness, "
      "damping and preload of the whole face",
      key));
}

Lining lining_of(const AssemblyOptions& options, const FaceContact& contact, double area,
                 const std::string& key)
{
  const FrictionLaw law = contact.friction.value_or(options.friction);
  if (law.table && law.table->pressures.size() > 1 && !(area > 0.0)) {
    throw Error(
        fmt::format("{}: its friction depends on the pressure, but the area of its nodes is not "
                    "known (they lie on one line or circle, or reach more than a quarter of a turn "
                    "to a side of their middle); give the nodes of a face, or a friction table "
                    "without pressures",
                    key));
  }
  return {.area = area,
          .stiffness = total(contact.stiffness, area, key),
          .damping = total(contact.damping, area, key),
          .preload = total(contact.preload, area, key),
          .friction = law,
          .has_own_friction = contact.friction.has_value()};
}

/// The modes of the parts on their joints: columns are motions of the parts' own coordinates.
struct PartModes {
  Eigen::VectorXd omega;
  Eigen::MatrixXd X;  ///< [n x n_b]
  Eigen::MatrixXd K, C;
};

PartModes part_modes(const JoinedParts& joined)
{
  const Eigen::MatrixXd T = null_space(joined.B);
  if (T.cols() == 0) return {Eigen::VectorXd(0), T, Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 0)};
  const Eigen::MatrixXd K = T.transpose() * joined.K * T;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(K);
  const Eigen::MatrixXd X = T * modes.eigenvectors();
  const Eigen::VectorXd omega = modes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return {omega, X, omega.cwiseAbs2().asDiagonal(), X.transpose() * joined.C * X};
}

/// The same motions of parts on other joints, as far as these allow them.
PartModes modes_about(const Assembly& about, const JoinedParts& joined)
{
  const Eigen::MatrixXd T = null_space(joined.B);
  if (T.cols() != about.X.cols()) {
    throw Error(
        "rigid joints hold more motions of the parts after the change than before it: what several "
        "of them hold together does not move by itself");
  }
  const Eigen::MatrixXd X = T * (T.transpose() * about.X);
  return {about.omega, X, X.transpose() * joined.K * X, X.transpose() * joined.C * X};
}

/// Adds the nodes of one lining.
void add_points(Assembly& all, const std::vector<FaceNode>& nodes, std::size_t contact,
                const std::pair<const Part&, Eigen::MatrixXd>& part)
{
  const Eigen::Index n_disc = all.disc.n_modes(), n = all.n_coordinates();
  for (const FaceNode& node : nodes) {
    const Eigen::MatrixXd on_disc = disc_shapes(all.disc, node);
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n, on_disc.cols() + 3);
    S.topLeftCorner(n_disc, on_disc.cols()) = on_disc;
    S.bottomRightCorner(n - n_disc, 3) = part.second.transpose() * face_motion(part.first, node);
    all.points.push_back({contact, node.sigma, node.place, node.share, node.area, std::move(S)});
  }
}

PadContact pad_at_point(const AssemblyPoint& point, const Lining& lining)
{
  return {.faces = {point.place, point.place},
          .friction = lining.friction,
          .law = ContactLaw::signed_force,
          .spring = {.linear = point.share * lining.stiffness},
          .damping = point.share * lining.damping,
          .preload = point.share * lining.preload,
          .area = point.area};
}

/// No node carries two linings.
void check_apart(const AssemblyOptions& options, std::span<const Part> parts)
{
  std::map<std::pair<std::size_t, int>, std::size_t> taken;
  for (std::size_t i = 0; i < options.contacts.size(); ++i) {
    const PartNodes& face = options.contacts[i].face;
    const std::size_t at = part_index(parts, face.part);
    const std::string key = fmt::format("contact[{}].face", i + 1);
    for (const int node : nodes_of(parts[at], face.set, key)) {
      const auto [first, is_new] = taken.try_emplace({at, node}, i);
      if (is_new || first->second == i) continue;
      throw Error(fmt::format(
          "{}: \"{}.{}\" ({}) has nodes of contact[{}].face = \"{}.{}\" too, which would carry two "
          "linings; give each face once, and sets without common nodes",
          key, face.part, face.set, parts[at].file, first->second + 1,
          options.contacts[first->second].face.part, options.contacts[first->second].face.set));
    }
  }
}

/// Joints and linings hold every part where the disc stands still.
void check_held(const Assembly& all, std::span<const Part> parts)
{
  const Eigen::Index n = all.omega.size();
  Eigen::MatrixXd K = all.K;
  for (const AssemblyPoint& point : all.points) {
    const Eigen::VectorXd z = point.S.rightCols<1>().tail(n);
    K += point.share * all.linings[point.contact].stiffness * z * z.transpose();
  }
  if (n == 0) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> held(K);
  constexpr double slowest = 1e-4;  // of the disc
  if (held.eigenvalues()[0] > std::pow(slowest * all.disc.omega.minCoeff(), 2)) return;
  const Eigen::VectorXd motion = all.X * held.eigenvectors().col(0);
  const std::vector<Eigen::Index> first = first_coordinates(parts);
  std::size_t loose = 0;
  double most = 0.0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double energy = motion.segment(first[i], parts[i].n_modes()).squaredNorm();
    if (energy > most) loose = i;
    most = std::max(most, energy);
  }
  throw Error(fmt::format(
      "part \"{}\" ({}) is not held: it can move at {:.3g} Hz against joints and linings; add a "
      "[[joint]] in the direction in which friction drags it, or hold its body (body.fixed)",
      parts[loose].name, parts[loose].file,
      std::sqrt(std::max(0.0, held.eigenvalues()[0])) / (2.0 * std::numbers::pi)));
}

/// Disc and joined parts, before they touch.
Assembly apart(InertialDisc disc, PartModes modes, bool convection)
{
  return {.disc = std::move(disc),
          .omega = std::move(modes.omega),
          .K = std::move(modes.K),
          .C = std::move(modes.C),
          .X = std::move(modes.X),
          .disc_modes = {},
          .points = {},
          .linings = {},
          .convection = convection,
          .notes = {}};
}

/// Adds all linings.
void add_linings(Assembly& all, const AssemblyOptions& options, std::span<const Part> parts,
                 const DiscFaces& faces)
{
  const std::vector<Eigen::Index> first = first_coordinates(parts);
  for (std::size_t i = 0; i < options.contacts.size(); ++i) {
    const FaceContact& contact = options.contacts[i];
    const std::string key = fmt::format("contact[{}]", i + 1);
    const std::size_t at = part_index(parts, contact.face.part);
    const Part& part = parts[at];
    const std::vector<FaceNode> nodes = face_nodes(contact, part, faces, key);
    add_points(all, nodes, i, {part, all.X.middleRows(first[at], part.n_modes())});
    double area = 0.0;
    for (const FaceNode& node : nodes) area += node.area;
    all.linings.push_back(lining_of(options, contact, area, key));
    all.notes.push_back(fmt::format("the face \"{}.{}\" has {} points and {:.5g} m^2",
                                    contact.face.part, contact.face.set, nodes.size(), area));
  }
}

}  // namespace

Assembly assembly(const AssemblyOptions& options, std::span<const ModalBody> bodies)
{
  const Placed placed = placed_parts(options, bodies);
  const Disc disc = turning_disc(options, *placed.disc);
  check_apart(options, placed.parts);
  const JoinedParts joints = joined(placed.parts, options.joints);
  Assembly all = apart(inertial_disc(disc), part_modes(joints), options.convection);
  all.disc_modes = disc.mode_numbers;
  all.notes = notes_of(disc);
  all.notes.insert(all.notes.end(), joints.notes.begin(), joints.notes.end());
  add_linings(all, options, placed.parts, disc_faces(options, all.disc));
  check_held(all, placed.parts);
  return all;
}

Assembly neighbour(const Assembly& about, const AssemblyOptions& options,
                   std::span<const ModalBody> bodies)
{
  const Placed placed = placed_parts(options, bodies);
  // Where parts met once, they have moved apart by less than any check of a scene should allow.
  std::vector<JointOptions> meeting = options.joints;
  for (JointOptions& joint : meeting) joint.span = std::numeric_limits<double>::infinity();
  const JoinedParts joints = joined(placed.parts, meeting);
  Assembly all = apart(about.disc, modes_about(about, joints), options.convection);
  all.disc_modes = about.disc_modes;
  DiscFaces faces = disc_faces(options, all.disc);
  faces.are_checked = false;
  add_linings(all, options, placed.parts, faces);
  return all;
}

Eigen::VectorXd state_scales(const Assembly& all)
{
  const double lowest = all.disc.omega.minCoeff();
  Eigen::VectorXd scales(all.n_coordinates());
  scales << all.disc.omega, all.omega.cwiseMax(lowest);
  return scales;
}

Eigen::MatrixXd state_matrix(const Assembly& all, std::span<const Lining> linings, double speed)
{
  const Eigen::Index n = all.n_coordinates(), n_disc = all.disc.n_modes(), n_b = n - n_disc;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n), C = K, D = K;
  K.diagonal().head(n_disc) = all.disc.omega.cwiseAbs2();
  K.bottomRightCorner(n_b, n_b) = all.K;
  C.topLeftCorner(n_disc, n_disc) = all.disc.C;
  C.bottomRightCorner(n_b, n_b) = all.C;
  if (all.convection) {
    C.topLeftCorner(n_disc, n_disc) += 2.0 * speed * all.disc.G;
    D.topLeftCorner(n_disc, n_disc) = all.disc.D;
  }
  for (const AssemblyPoint& point : all.points) {
    const FaceDerivatives F =
        face_derivatives(pad_at_point(point, linings[point.contact]), point.sigma,
                         static_cast<int>(point.S.cols()), speed);
    const Eigen::MatrixXd stiff = point.S * F.by_motion, damping = point.S * F.by_rate;
    K.noalias() -= stiff * point.S.transpose();
    C.noalias() -= damping * point.S.transpose();
  }
  const Eigen::VectorXd s = state_scales(all);
  Eigen::MatrixXd A(2 * n, 2 * n);
  A.topLeftCorner(n, n) = -speed * D;
  A.topRightCorner(n, n) = s.asDiagonal();
  A.bottomLeftCorner(n, n) = -K * s.cwiseInverse().asDiagonal();
  A.bottomRightCorner(n, n) = -speed * D - C;
  return A;
}

}  // namespace chladni::squeal
