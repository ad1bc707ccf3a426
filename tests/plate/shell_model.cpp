#include "shell_model.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <tuple>

#include "common/error.hpp"
#include "tests/plate/elements/sample_elements.hpp"

namespace chladni::plate::testing {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

using Corners = std::vector<Vector2d>;

/// Corners of the elements in the unit square.
std::vector<Corners> elements_of(const Grid& grid)
{
  std::mt19937 random(7);
  const auto between = [&](double a, double b) {
    return a + (b - a) * double(random()) / double(std::mt19937::max());
  };
  MatrixXd u(grid.n_u + 1, grid.n_v + 1), v = u;
  for (int i = 0; i <= grid.n_u; ++i) {
    for (int j = 0; j <= grid.n_v; ++j) {
      const double d_u = between(-grid.distortion, grid.distortion);
      const double d_v = between(-grid.distortion, grid.distortion);
      const bool inside = i % grid.n_u != 0 && j % grid.n_v != 0;
      u(i, j) = (i + (inside ? d_u : 0.0)) / grid.n_u;
      v(i, j) = (j + (inside ? d_v : 0.0)) / grid.n_v;
    }
  }
  std::vector<Corners> elements;
  for (int j = 0; j < grid.n_v; ++j) {
    for (int i = 0; i < grid.n_u; ++i) {
      const auto corner = [&](int a, int b) { return Vector2d(u(i + a, j + b), v(i + a, j + b)); };
      const Vector2d a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
      if (grid.shape == mesh::Shape::quadrilateral) {
        elements.push_back({a, b, c, d});
      } else if (grid.distortion > 0.0 && between(0.0, 1.0) < 0.5) {
        elements.push_back({a, b, d});
        elements.push_back({b, c, d});
      } else {
        elements.push_back({a, b, c});
        elements.push_back({a, c, d});
      }
    }
  }
  return elements;
}

Vector2d bilinear_point(const Corners& x, const Vector2d& P)
{
  if (x.size() == 3) return x[0] + P[0] * (x[1] - x[0]) + P[1] * (x[2] - x[0]);
  const double r = P[0], s = P[1];
  return 0.25 * ((1 - r) * (1 - s) * x[0] + (1 + r) * (1 - s) * x[1] + (1 + r) * (1 + s) * x[2] +
                 (1 - r) * (1 + s) * x[3]);
}

/// Nodes found again by their rounded position.
class NodeStore {
 public:
  NodeStore(ShellModel& model, double resolution) : model_(model), resolution_(resolution) {}

  int node(const Vector2d& uv, const Vector3d& x)
  {
    const auto rounded = [&](double c) { return std::llround(c / resolution_); };
    const auto key = std::tuple(rounded(x[0]), rounded(x[1]), rounded(x[2]));
    const auto [it, is_new] = index_.emplace(key, model_.mesh.n_nodes());
    if (is_new) {
      model_.mesh.positions.push_back({x[0], x[1], x[2]});
      model_.mesh.node_numbers.push_back(model_.mesh.n_nodes());
      model_.uv.push_back(uv);
    }
    return it->second;
  }

 private:
  ShellModel& model_;
  double resolution_;
  std::map<std::tuple<long long, long long, long long>, int> index_;
};

void add_elements(ShellModel& model, const std::vector<Surface>& surfaces, const Grid& grid)
{
  const Eigen::MatrixX2d lattice_points = lattice(grid.shape, grid.order);
  mesh::ElementBlock block{.shape = grid.shape,
                           .order = grid.order,
                           .nodes_per_element = static_cast<int>(lattice_points.rows()),
                           .numbers = {},
                           .nodes = {},
                           .group = {}};
  const double size = (surfaces[0](1.0, 1.0) - surfaces[0](0.0, 0.0)).norm();
  NodeStore store(model, 1e-7 * size);
  for (const Surface& surface : surfaces) {
    for (const Corners& corners : elements_of(grid)) {
      for (Index k = 0; k < lattice_points.rows(); ++k) {
        const Vector2d uv = bilinear_point(corners, lattice_points.row(k).transpose());
        block.nodes.push_back(store.node(uv, surface(uv[0], uv[1])));
      }
      block.numbers.push_back(block.n_elements() + 1);
      block.group.push_back(0);
    }
  }
  model.mesh.blocks = {block};
}

void assemble(ShellModel& model, const Material& material, double thickness)
{
  const mesh::ElementBlock& block = model.mesh.blocks[0];
  const Directors directors = shell_directors(model.mesh);
  const ShellSection section{.group = {}, .material = material, .thickness = thickness};
  std::vector<Eigen::Triplet<double>> K, M;
  for (int e = 0; e < block.n_elements(); ++e) {
    const ElementMatrices matrices = shell_matrices(
        block.shape, block.order, shell_nodes(model.mesh, block, e, directors, section), material);
    const auto nodes = block.element_nodes(e);
    const auto dof = [&](Index i) { return 6 * nodes[i / 6] + static_cast<int>(i % 6); };
    for (Index j = 0; j < matrices.K.cols(); ++j) {
      for (Index i = 0; i < matrices.K.rows(); ++i) {
        K.emplace_back(dof(i), dof(j), matrices.K(i, j));
        if (matrices.M(i, j) != 0.0) M.emplace_back(dof(i), dof(j), matrices.M(i, j));
      }
    }
  }
  const Index n = 6 * model.mesh.n_nodes();
  model.K.resize(n, n);
  model.M.resize(n, n);
  model.K.setFromTriplets(K.begin(), K.end());
  model.M.setFromTriplets(M.begin(), M.end());
}

Sparse restricted(const Sparse& A, const std::vector<Index>& free)
{
  std::vector<Index> place(A.rows(), -1);
  for (std::size_t i = 0; i < free.size(); ++i) place[free[i]] = static_cast<Index>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index j = 0; j < A.outerSize(); ++j) {
    for (Sparse::InnerIterator it(A, j); it; ++it) {
      if (place[it.row()] < 0 || place[j] < 0) continue;
      entries.emplace_back(place[it.row()], place[j], it.value());
    }
  }
  const auto n = static_cast<Index>(free.size());
  Sparse B(n, n);
  B.setFromTriplets(entries.begin(), entries.end());
  return B;
}

}  // namespace

ShellModel shell_model(const std::vector<Surface>& surfaces, const Grid& grid,
                       const Material& material, double thickness)
{
  ShellModel model;
  add_elements(model, surfaces, grid);
  assemble(model, material, thickness);
  return model;
}

std::vector<Index> free_dofs(const ShellModel& model, const std::vector<Support>& supports)
{
  std::vector<Index> free;
  for (int node = 0; node < model.mesh.n_nodes(); ++node) {
    for (int c = 0; c < 6; ++c) {
      const bool held = std::ranges::any_of(supports, [&](const Support& s) {
        return s.where(model.uv[node]) && std::ranges::count(s.components, c) > 0;
      });
      if (!held) free.push_back(6 * node + c);
    }
  }
  return free;
}

VectorXd area_load(const ShellModel& model, const Vector3d& q)
{
  const mesh::ElementBlock& block = model.mesh.blocks[0];
  const Points points = gauss_points(block.shape, block.order + 1);
  const Basis basis = lagrange_basis(block.shape, block.order, points);
  VectorXd load = VectorXd::Zero(model.n_dofs());
  for (int e = 0; e < block.n_elements(); ++e) {
    const auto nodes = block.element_nodes(e);
    NodeVectors x(block.nodes_per_element, 3);
    for (Index i = 0; i < x.rows(); ++i) x.row(i) = model.position(nodes[i]).transpose();
    const NodeVectors a_1 = basis.N_xi * x, a_2 = basis.N_eta * x;
    for (Index k = 0; k < points.size(); ++k) {
      const double dA = a_1.row(k).cross(a_2.row(k)).norm() * points.weight[k];
      for (Index i = 0; i < x.rows(); ++i) load.segment<3>(6 * nodes[i]) += basis.N(k, i) * dA * q;
    }
  }
  return load;
}

VectorXd edge_load(const ShellModel& model, const Grid& grid, const Where& where,
                   const Vector3d& force)
{
  std::vector<int> line;
  for (int node = 0; node < model.mesh.n_nodes(); ++node)
    if (where(model.uv[node])) line.push_back(node);
  std::ranges::sort(line, {}, [&](int node) { return model.uv[node].sum(); });
  // Newton-Cotes weights of orders 1 to 4: the integrals of the equidistant shape functions.
  const std::array<std::vector<double>, 4> weights{
      {{1.0 / 2, 1.0 / 2},
       {1.0 / 6, 4.0 / 6, 1.0 / 6},
       {1.0 / 8, 3.0 / 8, 3.0 / 8, 1.0 / 8},
       {7.0 / 90, 32.0 / 90, 12.0 / 90, 32.0 / 90, 7.0 / 90}}};
  const std::vector<double>& w = weights[grid.order - 1];
  const Index n_edges = (std::ssize(line) - 1) / grid.order;
  VectorXd load = VectorXd::Zero(model.n_dofs());
  for (Index e = 0; e < n_edges; ++e)
    for (int k = 0; k <= grid.order; ++k)
      load.segment<3>(6 * line[e * grid.order + k]) += w[k] / double(n_edges) * force;
  return load;
}

int node_at(const ShellModel& model, const Vector2d& uv)
{
  const auto nearest = std::ranges::min_element(
      model.uv, {}, [&](const Vector2d& place) { return (place - uv).norm(); });
  return static_cast<int>(nearest - model.uv.begin());
}

VectorXd solve(const ShellModel& model, const std::vector<Index>& free, const VectorXd& load)
{
  const Eigen::SimplicialLDLT<Sparse> factor(restricted(model.K, free));
  const VectorXd force = load(free);
  const VectorXd displacement = factor.solve(force);  // Eigen 3.4 cannot solve into u(free)
  VectorXd u = VectorXd::Zero(model.n_dofs());
  u(free) = displacement;
  return u;
}

VectorXd frequencies(const ShellModel& model, const std::vector<Index>& free, int n_wanted,
                     double shift)
{
  const Sparse M = restricted(model.M, free);
  const Eigen::SimplicialLDLT<Sparse> factor(restricted(model.K, free) + shift * M);
  const Index n = 2 * n_wanted + 8;
  std::mt19937 random(3);
  MatrixXd X = MatrixXd::NullaryExpr(M.rows(), n, [&] { return double(random() % 1000) - 500.0; });
  VectorXd lambda = VectorXd::Zero(n_wanted);
  for (int iteration = 0; iteration < 60; ++iteration) {
    const MatrixXd M_X = M * X;
    const MatrixXd Y = factor.solve(M_X);
    const MatrixXd M_Y = M * Y;
    // (K + shift M)^-1 in the span of Y: largest theta = 1 / (lambda + shift) first.
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> ritz(Y.transpose() * M_Y,
                                                                  Y.transpose() * M_X);
    const VectorXd next =
        ritz.eigenvalues().tail(n_wanted).reverse().cwiseInverse().array() - shift;
    X = Y * ritz.eigenvectors();
    X.array().rowwise() /= (X.array() * (M * X).array()).colwise().sum().sqrt();
    const double change = (next - lambda).cwiseAbs().maxCoeff();
    lambda = next;
    if (change < 1e-11 * (lambda.cwiseAbs().maxCoeff() + shift))
      return lambda.cwiseMax(0.0).cwiseSqrt() / (2.0 * std::numbers::pi);
  }
  throw Error("the subspace iteration of the test did not converge");
}

Where on(int coordinate, double value)
{
  return [=](const Vector2d& uv) { return std::abs(uv[coordinate] - value) < 1e-9; };
}

bool on_boundary(const Vector2d& uv)
{
  return uv.minCoeff() < 1e-9 || uv.maxCoeff() > 1.0 - 1e-9;
}

}  // namespace chladni::plate::testing
