#include "plate/dofs/free_motions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mesh/nodal_matrices.hpp"
#include "mesh/sectors.hpp"
#include "plate/dofs/point_elements.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using RowVector6d = Eigen::Matrix<double, 1, 6>;

constexpr double same_motion = 1e-8;  // of unit motions; the mesh's coordinates have 12 digits

/// Disjoint sets of active numbers that elements and couplings connect.
class Connection {
 public:
  explicit Connection(int n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i)
  {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int i, int j) { parent_[root(i)] = root(j); }

 private:
  std::vector<int> parent_;
};

/// The part of each active number, and which parts springs connect.
struct Parts {
  std::vector<int> of_number;
  std::vector<int> body;   ///< [n_parts] parts that springs or equations connect are one body
  std::vector<int> place;  ///< [n_parts] of the part in its body
  int n_bodies = 0;
};

/// Consecutive numbers of the disjoint sets.
std::vector<int> numbered(Connection& connection, int n)
{
  std::vector<int> of(n, -1), of_root(n, -1);
  int count = 0;
  for (int i = 0; i < n; ++i) {
    int& set = of_root[connection.root(i)];
    if (set < 0) set = count++;
    of[i] = set;
  }
  return of;
}

int count_of(const std::vector<int>& numbered)
{
  return numbered.empty() ? 0 : *std::ranges::max_element(numbered) + 1;
}

int number_of(const DofMap& dofs, int node)
{
  return dofs.motion(node).front().number;
}

/// A part of a sector that a part of the next one continues, or that is the same in all sectors.
struct Continuation {
  int part, next;  ///< that of the sector before, and that of the next
};

/// Joins the parts of one sector that are one through other sectors. Parts that reach each other on
/// a way of n sectors are one in each sector if the sums n of all ways there and back have no
/// divisor in common with the number of sectors.
void join_over_sectors(const mesh::Mesh& mesh, const DofMap& dofs, Connection& connection)
{
  if (mesh.sectors.count == 1) return;
  const std::vector<int> part_of = numbered(connection, dofs.n_active());
  std::vector<Continuation> over;
  for (const auto& [low, high] : mesh.sectors.pairs)
    over.push_back({part_of[number_of(dofs, high)], part_of[number_of(dofs, low)]});
  const double length = mesh::outer_radius(mesh);
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    const Vector3d x = dofs.position(node);
    if (dofs.number(node) < 0 || !mesh::is_on_axis({x[0], x[1], x[2]}, length)) continue;
    over.push_back({part_of[dofs.number(node)], part_of[dofs.number(node)]});
  }
  const int n_parts = count_of(part_of);
  std::vector<std::optional<int>> sector(n_parts);
  std::vector<int> first_number(n_parts, -1);
  for (int i = 0; i < dofs.n_active(); ++i)
    if (int& first = first_number[part_of[i]]; first < 0) first = i;
  for (int root = 0; root < n_parts; ++root) {
    if (sector[root]) continue;
    sector[root] = 0;
    std::vector<int> reached{root};
    int common = mesh.sectors.count;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      for (const auto& [part, next] : over) {
        if (part != reached[i] && next != reached[i]) continue;
        for (const auto& [at, to, step] : {std::tuple{part, next, 1}, {next, part, -1}}) {
          if (at != reached[i]) continue;
          if (!sector[to]) {
            sector[to] = *sector[at] + step;
            reached.push_back(to);
          }
          common = std::gcd(common, std::abs(*sector[at] + step - *sector[to]));
        }
      }
    }
    for (const int part : reached)
      if (common == 1) connection.join(first_number[root], first_number[part]);
  }
}

Parts connected_parts(const mesh::Mesh& mesh, const DofMap& dofs,
                      std::span<const PlacedSpring> springs)
{
  Connection connection(dofs.n_active());
  mesh::for_connected_nodes(mesh, [&](std::span<const int> nodes) {
    const int first = number_of(dofs, nodes[0]);
    for (const int node : nodes)
      for (const int number : dofs.own_numbers(node)) connection.join(first, number);
  });
  for (const auto& [node, components] : nodes_of_equations_alone(mesh, dofs.coupled()))
    for (const int number : dofs.own_numbers(node)) connection.join(number_of(dofs, node), number);
  join_over_sectors(mesh, dofs, connection);
  Parts parts{.of_number = numbered(connection, dofs.n_active()), .body = {}, .place = {}};
  const int n_parts = count_of(parts.of_number);
  Connection bodies(n_parts);
  for (const PlacedSpring& spring : springs) {
    if (spring.nodes.size() < 2) continue;
    bodies.join(parts.of_number[number_of(dofs, spring.nodes[0])],
                parts.of_number[number_of(dofs, spring.nodes[1])]);
  }
  for (const mesh::Equation& equation : mesh.equations)
    for (const mesh::Equation::Term& term : equation.terms) {
      bodies.join(parts.of_number[number_of(dofs, equation.terms.front().node)],
                  parts.of_number[number_of(dofs, term.node)]);
    }
  parts.body = numbered(bodies, n_parts);
  parts.n_bodies = count_of(parts.body);
  std::vector<int> n_of_body(parts.n_bodies, 0);
  for (const int body : parts.body) parts.place.push_back(n_of_body[body]++);
  return parts;
}

/// Centre and mean radius of each body, the geometry that scales rotations.
struct Extent {
  Vector3d centre = Vector3d::Zero();
  double length = 0.0;
  int n_nodes = 0;
  int n_parts = 0;
};

std::vector<Extent> extents(const DofMap& dofs, const Parts& parts)
{
  std::vector<Extent> extents(parts.n_bodies);
  const auto for_nodes = [&](const auto& visit) {
    for (int node = 0; node < dofs.n_nodes(); ++node) {
      if (dofs.number(node) < 0) continue;
      const int body = parts.body[parts.of_number[dofs.number(node)]];
      visit(extents[body], dofs.position(node));
    }
  };
  for_nodes([](Extent& extent, const Vector3d& x) {
    extent.centre += x;
    ++extent.n_nodes;
  });
  for (Extent& extent : extents) extent.centre /= std::max(extent.n_nodes, 1);
  for_nodes([](Extent& extent, const Vector3d& x) {
    extent.length += (x - extent.centre).norm() / extent.n_nodes;
  });
  for (Extent& extent : extents)
    if (!(extent.length > 0.0)) extent.length = 1.0;  // a single node
  for (const int body : parts.body) ++extents[body].n_parts;
  return extents;
}

/// What one unit of each rigid motion of a part is at this component of one of its points.
RowVector6d rigid_row(const Vector3d& position, const Extent& extent, int component)
{
  const Vector3d r = (position - extent.centre) / extent.length;
  RowVector6d row = RowVector6d::Zero();
  row[component] = 1.0;  // of a rotation times 1 / length
  if (component >= 3) return row;
  for (int axis = 0; axis < 3; ++axis) row[3 + axis] = Vector3d::Unit(axis).cross(r)[component];
  return row;
}

/// For each body R with R x = 0 for the rigid motions x of its parts that nothing resists.
class Resistance {
 public:
  /// @param turns  of the body onto itself
  Resistance(const DofMap& dofs, const Parts& parts, const std::vector<Extent>& extents,
             std::vector<Matrix3d> turns)
      : dofs_(dofs), parts_(parts), extents_(extents), turns_(std::move(turns))
  {
    for (const Extent& extent : extents) rows_.emplace_back(0, 6 * extent.n_parts);
  }

  /// This component of the node does not move, but for a rotation about the axis.
  void hold(int node, int component, const Vector3d& axis)
  {
    const Extent& extent = extents_[body_of(node)];
    for (const Matrix3d& turn : turns_) {
      const Vector3d x = turn * dofs_.position(node), about = turn * axis;
      RowVector6d motion = rigid_row(x, extent, component);
      for (int k = 0; component >= 3 && k < 3; ++k)
        motion -= about[component - 3] * about[k] * rigid_row(x, extent, 3 + k);
      resist({&node, 1}, motion);
    }
  }
  /// A spring resists the motion against the ground or of both nodes, seen at the middle.
  void add(const PlacedSpring& spring)
  {
    const int a = spring.nodes.front(), b = spring.nodes.back();
    const Vector3d middle = 0.5 * (dofs_.position(a) + dofs_.position(b));
    for (const int component : spring.components)
      for (const Matrix3d& turn : turns_)
        resist(spring.nodes, rigid_row(turn * middle, extents_[body_of(a)], component));
  }
  /// Equations allow the motions alone that satisfy them.
  void add(const mesh::Equation& equation)
  {
    const int body = body_of(equation.terms.front().node);
    double largest = 0.0;
    for (const mesh::Equation::Term& term : equation.terms)
      largest = std::max(largest, std::abs(term.factor));
    if (largest == 0.0) return;
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(rows_[std::size_t(body)].cols());
    for (const auto& [node, component, factor] : equation.terms) {
      const double unit = component < 3 ? 1.0 : 1.0 / extents_[std::size_t(body)].length;
      row.segment<6>(6 * parts_.place[part_of(node)]) +=
          factor / largest * unit * rigid_row(dofs_.position(node), extents_[body], component);
    }
    resist(body, row);
  }
  /// The motions of a body that nothing resists, orthonormal.
  MatrixXd unresisted(int body) const
  {
    const MatrixXd& R = rows_[std::size_t(body)];
    if (R.rows() == 0) return MatrixXd::Identity(R.cols(), R.cols());
    const Eigen::BDCSVD<MatrixXd> svd(R, Eigen::ComputeFullV);
    const double least = same_motion * std::max(1.0, R.norm());
    return svd.matrixV().rightCols(R.cols() - (svd.singularValues().array() >= least).count());
  }

 private:
  int part_of(int node) const { return parts_.of_number[number_of(dofs_, node)]; }
  int body_of(int node) const { return parts_.body[part_of(node)]; }

  /// @param nodes  one against the ground, or two against each other
  void resist(std::span<const int> nodes, const RowVector6d& motion)
  {
    const int body = body_of(nodes.front());
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(rows_[std::size_t(body)].cols());
    row.segment<6>(6 * parts_.place[part_of(nodes.front())]) += motion;
    if (nodes.size() > 1) row.segment<6>(6 * parts_.place[part_of(nodes.back())]) -= motion;
    resist(body, row);
  }

  void resist(int body, const Eigen::RowVectorXd& row)
  {
    MatrixXd& R = rows_[std::size_t(body)];
    R.conservativeResize(R.rows() + 1, Eigen::NoChange);
    R.row(R.rows() - 1) = row;
    if (R.rows() < 4 * R.cols()) return;
    // R^T R would have the squares of the small motions, beneath its round-off.
    const Eigen::HouseholderQR<MatrixXd> qr(R);
    R = MatrixXd(qr.matrixQR().topRows(R.cols()).triangularView<Eigen::Upper>());
  }

  const DofMap& dofs_;
  const Parts& parts_;
  const std::vector<Extent>& extents_;
  std::vector<Matrix3d> turns_;
  std::vector<MatrixXd> rows_;
};

/// Turns of a body of sectors that take its supports to other sectors: what is held in three of
/// them is held in all.
std::vector<Matrix3d> turns_of(const mesh::Sectors& sectors)
{
  std::vector<Matrix3d> turns;
  for (int i = 0; i < std::min(sectors.count, 3); ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sectors.count;
    turns.push_back(Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix());
  }
  return turns;
}

/// What supports and the model hold. Nodes of solids have no rotations to be held.
void hold_supports(const DofMap& dofs, const Restraints& restraints, Resistance& resistance)
{
  const std::vector<int>& held = restraints.held;
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    const Vector3d axis =
        node < restraints.axes.rows() ? Vector3d(restraints.axes.row(node)) : Vector3d::Zero();
    for (int component = 0; component < 6; ++component) {
      const auto dof = dofs.dof(node, component);
      if (dof ? std::ranges::binary_search(held, *dof)
              : dofs.is_independent(node) && dofs.holds(component))
        resistance.hold(node, component, dof ? axis : Vector3d::Zero());
    }
  }
}

}  // namespace

std::vector<FreePart> free_parts(const mesh::Mesh& mesh, const DofMap& dofs,
                                 const std::vector<int>& held, std::span<const Spring> springs)
{
  const Eigen::MatrixX3d no_axes;
  return free_parts_under(mesh, dofs, {.held = held, .springs = springs, .axes = no_axes});
}

std::vector<FreePart> free_parts_under(const mesh::Mesh& mesh, const DofMap& dofs,
                                       const Restraints& restraints)
{
  const std::vector<PlacedSpring> placed = place_springs(mesh, dofs, restraints.springs);
  const Parts parts = connected_parts(mesh, dofs, placed);
  const std::vector<Extent> extent = extents(dofs, parts);
  Resistance resistance(dofs, parts, extent, turns_of(mesh.sectors));
  hold_supports(dofs, restraints, resistance);
  for (const PlacedSpring& spring : placed) resistance.add(spring);
  for (const mesh::Equation& equation : mesh.equations) resistance.add(equation);
  for (const auto& [node, components] : nodes_of_equations_alone(mesh, dofs.coupled()))
    for (int c = 0; c < 6; ++c)
      if (!components.contains(c)) resistance.hold(node, c, Vector3d::Zero());
  std::vector<FreePart> free;
  for (int body = 0; body < parts.n_bodies; ++body) {
    MatrixXd motions = resistance.unresisted(body);
    if (motions.cols() == 0) continue;
    free.push_back({.n_nodes = extent[body].n_nodes,
                    .centre = extent[body].centre,
                    .motions = std::move(motions)});
  }
  return free;
}

int n_free_motions(const std::vector<FreePart>& parts)
{
  int n = 0;
  for (const FreePart& part : parts) n += static_cast<int>(part.motions.cols());
  return n;
}

std::string describe_motions(const FreePart& part)
{
  constexpr std::array names{"translation along x", "translation along y", "translation along z",
                             "rotation about x",    "rotation about y",    "rotation about z"};
  std::vector<std::string> pure;
  for (Index c = 0; c < 6; ++c) {
    // A motion of all pieces alike, if all of it lies in the space of the free ones.
    Eigen::VectorXd alike = Eigen::VectorXd::Zero(part.motions.rows());
    alike(Eigen::seq(c, last, 6)).setConstant(std::sqrt(6.0 / double(alike.size())));
    if ((alike.transpose() * part.motions).norm() > 1.0 - same_motion)
      pure.emplace_back(names[static_cast<std::size_t>(c)]);
  }
  const auto n = part.motions.cols();
  return fmt::format("{} way{}{}", n, n == 1 ? "" : "s",
                     pure.empty() ? "" : fmt::format(" ({})", fmt::join(pure, ", ")));
}

void check_stiffness_of_all_nodes(const mesh::Mesh& mesh, const DofMap& dofs)
{
  std::vector<bool> touched(dofs.n_active(), false);
  mesh::for_connected_nodes(mesh, [&](std::span<const int> nodes) {
    for (const int node : nodes)
      for (const MotionTerm& term : dofs.motion(node)) touched[term.number] = true;
  });
  for (const auto& [node, components] : nodes_of_equations_alone(mesh, dofs.coupled()))
    touched[dofs.number(node)] = true;
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    if (dofs.number(node) < 0 || touched[dofs.number(node)]) continue;
    if (node >= dofs.n_mesh_nodes()) {
      throw Error(fmt::format("coupling \"{}\": none of its nodes belongs to an element",
                              dofs.reference_name(node)));
    }
    throw Error(
        fmt::format("node {} belongs to no element, so nothing gives it stiffness; take it out of "
                    "the mesh or let it follow a coupling",
                    mesh.node_numbers[node]));
  }
}

}  // namespace chladni::plate
