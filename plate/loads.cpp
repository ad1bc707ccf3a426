#include "plate/loads.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "plate/interpolation.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Adds forces on nodes to the rows of f that this rank owns; every rank adds all forces.
class Forces {
 public:
  explicit Forces(const System& system) : dofs_(system.dofs)
  {
    petsc::check(MatCreateVecs(system.K, nullptr, f_.put()));
    petsc::check(VecGetOwnershipRange(f_, &first_, &last_));
  }

  void add(int node, const Vector6d& force)
  {
    for (const MotionTerm& term : dofs_.motion(node)) {
      if (6 * term.number < first_ || 6 * term.number >= last_) continue;
      const Vector6d share = term.T.transpose() * force;
      for (int c = 0; c < 6; ++c) {
        petsc::check(VecSetValue(f_, 6 * term.number + c, share[c], ADD_VALUES));
      }
    }
  }
  void add_force(int node, const Vector3d& force)
  {
    Vector6d all = Vector6d::Zero();
    all.head<3>() = force;
    add(node, all);
  }

  petsc::Vector assembled()
  {
    petsc::check(VecAssemblyBegin(f_));
    petsc::check(VecAssemblyEnd(f_));
    return std::move(f_);
  }

 private:
  const DofMap& dofs_;
  petsc::Vector f_;
  PetscInt first_ = 0, last_ = 0;
};

Vector3d vector_of(const std::array<double, 3>& x)
{
  return {x[0], x[1], x[2]};
}

/// Positions of nodes, [n x 3].
Eigen::MatrixX3d positions_of(const mesh::Mesh& mesh, std::span<const int> nodes)
{
  Eigen::MatrixX3d x(std::ssize(nodes), 3);
  for (Index i = 0; i < x.rows(); ++i) x.row(i) = vector_of(mesh.positions[nodes[i]]).transpose();
  return x;
}

void add_load(const mesh::Mesh& mesh, const System& system, const NodalLoad& load, Forces& forces)
{
  const std::vector<int> nodes = named_nodes(mesh, system.dofs, load.group);
  if (nodes.empty()) throw Error(fmt::format("load on \"{}\": it has no nodes", load.group));
  Vector6d force;
  force << vector_of(load.force), vector_of(load.moment);
  for (const int node : nodes) forces.add(node, force / static_cast<double>(nodes.size()));
}

/// The nodes of the element's edges from end to end, in lattice order.
std::vector<std::vector<int>> edges_of(const mesh::ElementBlock& block, int element)
{
  const int p = block.order;
  const std::span<const int> nodes = block.element_nodes(element);
  const bool triangle = block.shape == mesh::Shape::triangle;
  const auto place = [&](int i, int j) {
    return triangle ? j * (p + 1) - j * (j - 1) / 2 + i : j * (p + 1) + i;
  };
  std::vector<std::vector<int>> edges(triangle ? 3 : 4);
  for (int i = 0; i <= p; ++i) {
    edges[0].push_back(nodes[place(i, 0)]);
    edges[1].push_back(nodes[place(0, i)]);
    edges[2].push_back(nodes[triangle ? place(p - i, i) : place(p, i)]);
    if (!triangle) edges[3].push_back(nodes[place(i, p)]);
  }
  return edges;
}

/// Element edges with all their nodes in the group; an edge between two elements counts once.
std::vector<std::vector<int>> edges_in(const mesh::Mesh& mesh, const mesh::Group& group)
{
  const std::set<int> members(group.nodes.begin(), group.nodes.end());
  std::set<std::vector<int>> seen;
  std::vector<std::vector<int>> edges;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (block.shape == mesh::Shape::line) continue;
    for (int e = 0; e < block.n_elements(); ++e) {
      for (std::vector<int>& edge : edges_of(block, e)) {
        if (!std::ranges::all_of(edge, [&](int n) { return members.contains(n); })) continue;
        std::vector<int> key = edge;
        std::ranges::sort(key);
        if (seen.insert(key).second) edges.push_back(std::move(edge));
      }
    }
  }
  return edges;
}

/// f_i = int N_i q ds along one edge.
void add_edge(const mesh::Mesh& mesh, const std::vector<int>& edge, const Vector3d& q,
              Forces& forces)
{
  const auto p = static_cast<int>(edge.size()) - 1;
  const GaussRule gauss = gauss_legendre(p + 2);
  const Eigen::VectorXd ends = Eigen::VectorXd::LinSpaced(2, -1.0, 1.0);
  const Points points =
      tensor_points(gauss.x, ends.head(1));  // the lower edge of the parent square
  const Basis basis = lagrange_basis(mesh::Shape::quadrilateral, p, points);
  const Eigen::MatrixX3d tangents = basis.N_xi.leftCols(p + 1) * positions_of(mesh, edge);
  const Eigen::VectorXd lengths = gauss.w.cwiseProduct(tangents.rowwise().norm());
  const Eigen::VectorXd shares = basis.N.leftCols(p + 1).transpose() * lengths;
  for (Index i = 0; i < shares.size(); ++i) forces.add_force(edge[i], shares[i] * q);
}

void add_load(const mesh::Mesh& mesh, const System&, const EdgeLoad& load, Forces& forces)
{
  const auto edges = edges_in(mesh, mesh::find_group(mesh, load.group));
  if (edges.empty()) {
    throw Error(fmt::format(
        "line load on \"{}\": no edge of an element has all its nodes in this group", load.group));
  }
  for (const auto& edge : edges) add_edge(mesh, edge, vector_of(load.line_force), forces);
}

/// f_i = int N_i p (a_1 x a_2) d xi d eta over one element.
void add_pressure(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element, double p,
                  Forces& forces)
{
  const Points points = gauss_points(block.shape, block.order + 2);
  const Basis basis = lagrange_basis(block.shape, block.order, points);
  const std::span<const int> nodes = block.element_nodes(element);
  const Eigen::MatrixX3d x = positions_of(mesh, nodes);
  const Eigen::MatrixX3d a_1 = basis.N_xi * x;
  const Eigen::MatrixX3d a_2 = basis.N_eta * x;
  Eigen::MatrixX3d f = Eigen::MatrixX3d::Zero(x.rows(), 3);
  for (Index q = 0; q < points.size(); ++q) {
    const Eigen::RowVector3d area = a_1.row(q).cross(a_2.row(q));
    f += p * points.weight[q] * basis.N.row(q).transpose() * area;
  }
  for (Index i = 0; i < f.rows(); ++i) forces.add_force(nodes[i], f.row(i));
}

void add_load(const mesh::Mesh& mesh, const System&, const PressureLoad& load, Forces& forces)
{
  const mesh::Group& group = mesh::find_group(mesh, load.group);
  const auto index = static_cast<int>(&group - mesh.groups.data());
  int n_elements = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (block.shape == mesh::Shape::line) continue;
    for (int e = 0; e < block.n_elements(); ++e) {
      if (block.group[e] != index) continue;
      add_pressure(mesh, block, e, load.pressure, forces);
      ++n_elements;
    }
  }
  if (n_elements == 0) {
    throw Error(fmt::format("pressure on \"{}\": the group has no shell elements", load.group));
  }
}

/// The acceleration as the motion of every node.
petsc::Vector translation(const System& system, const std::array<double, 3>& a)
{
  petsc::Vector motion;
  petsc::check(MatCreateVecs(system.M, motion.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(motion, &first, &last));
  for (int node = 0; node < system.dofs.n_nodes(); ++node) {
    for (int c = 0; c < 3; ++c) {
      const auto dof = system.dofs.dof(node, c);
      if (!dof || *dof < first || *dof >= last) continue;
      petsc::check(VecSetValue(motion, *dof, a[c], INSERT_VALUES));
    }
  }
  petsc::check(VecAssemblyBegin(motion));
  petsc::check(VecAssemblyEnd(motion));
  return motion;
}

}  // namespace

petsc::Vector load_vector(const mesh::Mesh& mesh, const System& system, std::span<const Load> loads)
{
  Forces forces(system);
  for (const Load& load : loads) {
    if (std::holds_alternative<GravityLoad>(load)) continue;
    if (const auto* nodal = std::get_if<NodalLoad>(&load)) add_load(mesh, system, *nodal, forces);
    if (const auto* edge = std::get_if<EdgeLoad>(&load)) add_load(mesh, system, *edge, forces);
    if (const auto* p = std::get_if<PressureLoad>(&load)) add_load(mesh, system, *p, forces);
  }
  petsc::Vector f = forces.assembled();
  for (const Load& load : loads) {
    const auto* gravity = std::get_if<GravityLoad>(&load);
    if (!gravity) continue;
    const petsc::Vector a = translation(system, gravity->acceleration);
    petsc::check(MatMultAdd(system.M, a, f, f));
  }
  return f;
}

}  // namespace chladni::plate
