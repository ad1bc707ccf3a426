#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "tests/linear/chain.hpp"

/// Pencils (K, M) of bodies that need no mesh: solid blocks and straight beams.
namespace chladni::reduce::testing {

/// An elastic body; DOF `n_components * node + component`.
struct Body {
  linear::testing::Chain pencil;
  std::vector<std::array<double, 3>> positions;
};

/// What one element adds to the rows of its DOFs.
struct ElementPencil {
  std::vector<PetscInt> dofs;
  Eigen::MatrixXd K, M;
};

/// The sum of all elements; each rank adds the rows that it owns.
inline linear::testing::Chain assemble(PetscInt n, const std::vector<ElementPencil>& elements)
{
  const auto sum = [&](Eigen::MatrixXd ElementPencil::*matrix) {
    petsc::Matrix A;
    petsc::check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n, n, 81, nullptr, 81,
                              nullptr, A.put()));
    petsc::check(MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
    PetscInt first = 0, last = 0;
    petsc::check(MatGetOwnershipRange(A, &first, &last));
    for (const ElementPencil& element : elements) {
      const auto size = static_cast<PetscInt>(element.dofs.size());
      for (PetscInt i = 0; i < size; ++i) {
        const PetscInt row = element.dofs[i];
        if (row < first || row >= last) continue;
        const Eigen::VectorXd values = (element.*matrix).row(i);
        petsc::check(
            MatSetValues(A, 1, &row, size, element.dofs.data(), values.data(), ADD_VALUES));
      }
    }
    linear::testing::finish(A);
    return A;
  };
  return {.K = sum(&ElementPencil::K), .M = sum(&ElementPencil::M)};
}

struct Solid {
  double young = 210e9;
  double poisson = 0.3;
  double density = 7850.0;
};

/// K and M of a rectangular brick with 8 nodes, 3 displacements each, by 2 x 2 x 2 Gauss points.
/// Nodes in the order of x, then y, then z.
inline ElementPencil brick(const std::array<double, 3>& size, const Solid& solid)
{
  using Eigen::MatrixXd, Eigen::Vector3d;
  const double lambda = solid.young * solid.poisson / (1 + solid.poisson) / (1 - 2 * solid.poisson);
  const double mu = 0.5 * solid.young / (1 + solid.poisson);
  Eigen::Matrix<double, 6, 6> C = Eigen::Matrix<double, 6, 6>::Zero();
  C.topLeftCorner<3, 3>().setConstant(lambda);
  C.topLeftCorner<3, 3>().diagonal().array() += 2 * mu;
  C.bottomRightCorner<3, 3>().diagonal().setConstant(mu);
  ElementPencil element{.dofs = {}, .K = MatrixXd::Zero(24, 24), .M = MatrixXd::Zero(24, 24)};
  const double dV = size[0] * size[1] * size[2] / 8.0;
  for (int q = 0; q < 8; ++q) {
    const Vector3d xi = Vector3d(q & 1 ? 1 : -1, q & 2 ? 1 : -1, q & 4 ? 1 : -1) / std::sqrt(3.0);
    MatrixXd B = MatrixXd::Zero(6, 24), N = MatrixXd::Zero(3, 24);
    for (int a = 0; a < 8; ++a) {
      const Vector3d corner(a & 1 ? 1 : -1, a & 2 ? 1 : -1, a & 4 ? 1 : -1);
      const Vector3d f = (Vector3d::Ones() + corner.cwiseProduct(xi)) / 2.0;
      const Vector3d d(corner[0] * f[1] * f[2] / size[0], f[0] * corner[1] * f[2] / size[1],
                       f[0] * f[1] * corner[2] / size[2]);
      for (int c = 0; c < 3; ++c) {
        N(c, 3 * a + c) = f.prod();
        B(c, 3 * a + c) = d[c];
        B(3 + c, 3 * a + (c + 1) % 3) = d[(c + 2) % 3];
        B(3 + c, 3 * a + (c + 2) % 3) = d[(c + 1) % 3];
      }
    }
    element.K += B.transpose() * C * B * dV;
    element.M += solid.density * N.transpose() * N * dV;
  }
  return element;
}

/// A free block of bricks; n elements along x, y, z. Node i + (n_x + 1) (j + (n_y + 1) k).
inline Body solid_block(const std::array<int, 3>& n, const std::array<double, 3>& size,
                        const Solid& solid = {})
{
  const ElementPencil one = brick({size[0] / n[0], size[1] / n[1], size[2] / n[2]}, solid);
  const auto node = [&](int i, int j, int k) { return i + (n[0] + 1) * (j + (n[1] + 1) * k); };
  Body block;
  for (int k = 0; k <= n[2]; ++k) {
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i)
        block.positions.push_back({i * size[0] / n[0], j * size[1] / n[1], k * size[2] / n[2]});
  }
  std::vector<ElementPencil> elements;
  for (int e = 0; e < n[0] * n[1] * n[2]; ++e) {
    const int i = e % n[0], j = e / n[0] % n[1], k = e / n[0] / n[1];
    elements.push_back(one);
    for (int a = 0; a < 8; ++a)
      for (int c = 0; c < 3; ++c)
        elements.back().dofs.push_back(3 * node(i + (a & 1), j + (a >> 1 & 1), k + (a >> 2)) + c);
  }
  block.pencil = assemble(static_cast<PetscInt>(3 * block.positions.size()), elements);
  return block;
}

/// A beam of n equal Bernoulli-Euler elements with EI = rho A = length = 1; DOF 2 i is the
/// deflection, 2 i + 1 the rotation of node i. The first `n_held` DOFs are left out.
inline linear::testing::Chain euler_beam(int n, PetscInt n_held)
{
  const double h = 1.0 / n;
  ElementPencil one{.dofs = {}, .K = Eigen::MatrixXd(4, 4), .M = Eigen::MatrixXd(4, 4)};
  one.K << 12, 6 * h, -12, 6 * h, 6 * h, 4 * h * h, -6 * h, 2 * h * h,  //
      -12, -6 * h, 12, -6 * h, 6 * h, 2 * h * h, -6 * h, 4 * h * h;
  one.K /= h * h * h;
  one.M << 156, 22 * h, 54, -13 * h, 22 * h, 4 * h * h, 13 * h, -3 * h * h,  //
      54, 13 * h, 156, -22 * h, -13 * h, -3 * h * h, -22 * h, 4 * h * h;
  one.M *= h / 420.0;
  std::vector<ElementPencil> elements;
  for (int e = 0; e < n; ++e) {
    elements.push_back(one);
    for (PetscInt i = 0; i < 4; ++i) elements.back().dofs.push_back(2 * e + i - n_held);
  }
  const auto n_dofs = static_cast<PetscInt>(2 * (n + 1)) - n_held;
  if (n_held > 0) {  // rows and columns of held DOFs are those with negative numbers
    for (ElementPencil& element : elements) {
      if (element.dofs.front() >= 0) continue;
      ElementPencil kept{.dofs = {}, .K = {}, .M = {}};
      std::vector<int> places;
      for (int i = 0; i < 4; ++i) {
        if (element.dofs[i] < 0) continue;
        kept.dofs.push_back(element.dofs[i]);
        places.push_back(i);
      }
      kept.K = element.K(places, places);
      kept.M = element.M(places, places);
      element = std::move(kept);
    }
  }
  return assemble(n_dofs, elements);
}

/// All entries, on every rank.
inline Eigen::MatrixXd whole(Mat A)
{
  return linear::replicate(A);
}

/// Eigenvalues of K x = lambda M x with M positive definite, ascending, by LAPACK's way.
inline Eigen::VectorXd exact_eigenvalues(const linear::testing::Chain& pencil)
{
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(whole(pencil.K), whole(pencil.M),
                                                                   Eigen::EigenvaluesOnly)
      .eigenvalues();
}

/// The numbers with a point or an exponent in the error of a statement, as they are printed: none
/// where it is accepted.
template <class Statement>
std::vector<std::string> refused_numbers(Statement statement)
{
  try {
    statement();
  } catch (const Error& error) {
    static const std::regex number(R"([0-9]+(\.[0-9]+)?e[-+][0-9]+|[0-9]+\.[0-9]+)");
    const std::string said = error.what();
    const std::sregex_iterator begin(said.begin(), said.end(), number), end;
    std::vector<std::string> numbers;
    for (auto at = begin; at != end; ++at) numbers.push_back(at->str());
    return numbers;
  }
  return {};
}

}  // namespace chladni::reduce::testing
