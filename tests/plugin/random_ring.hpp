#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <numbers>
#include <random>
#include <vector>

#include "tests/linear/chain.hpp"

namespace chladni::reduce::testing {

/// A ring of equal sectors about an axis through the hub, of three components, every two nodes of a
/// sector joined by a stiffness of any direction. Node 0 is a hub that all sectors share, then come
/// three nodes of the low edge, three in the middle and three of the high edge.
class RandomRing {
 public:
  static constexpr int n_sector_nodes = 10, n_own = 6;

  explicit RandomRing(int count, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ(),
                      unsigned seed = 7)
      : count_(count), axis_(axis.normalized())
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> between(-1.0, 1.0);
    for (int a = 0; a < n_sector_nodes; ++a) {
      for (int b = 0; b <= a; ++b) {
        const Eigen::Matrix3d G = Eigen::Matrix3d::NullaryExpr([&] { return between(random); });
        pairs_.push_back({.a = a, .b = b, .A = G * G.transpose() + Eigen::Matrix3d::Identity()});
      }
    }
  }

  Eigen::Matrix3d turn(int sector) const
  {
    const double angle = 2.0 * std::numbers::pi * sector / count_;
    return Eigen::AngleAxisd(angle, axis_).toRotationMatrix();
  }

  /// Of sector j in the whole ring.
  int node(int sector, int a) const
  {
    if (a == 0) return 0;
    const int place = (sector * n_own + a - 1) % (count_ * n_own);
    return 1 + place;
  }

  struct Matrices {
    Eigen::MatrixXd K, M;
  };

  Matrices sector() const
  {
    return assembled(3 * n_sector_nodes, 1, [](int, int a) { return a; });
  }
  Matrices whole() const
  {
    return assembled(3 * (1 + count_ * n_own), count_, [&](int j, int a) { return node(j, a); });
  }

  /// Row by row.
  std::vector<double> rotation() const
  {
    const Eigen::Matrix3d R = turn(1);
    std::vector<double> rows;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) rows.push_back(R(i, j));
    return rows;
  }

  /// Rows of the hub and of an edge that begins with this node.
  static std::vector<PetscInt> edge(int first_node)
  {
    std::vector<PetscInt> rows{0, 1, 2};
    for (PetscInt i = 0; i < 9; ++i) rows.push_back(3 * first_node + i);
    return rows;
  }
  static std::vector<PetscInt> low() { return edge(1); }
  static std::vector<PetscInt> high() { return edge(7); }

 private:
  struct Pair {
    int a, b;
    Eigen::Matrix3d A;
  };

  template <class NodeOf>
  Matrices assembled(int n, int n_sectors, const NodeOf& node_of) const
  {
    Matrices sum{.K = Eigen::MatrixXd::Zero(n, n), .M = Eigen::MatrixXd::Zero(n, n)};
    for (int j = 0; j < n_sectors; ++j) {
      for (const auto& [a, b, A] : pairs_) {
        const Eigen::Matrix3d turned = turn(j) * A * turn(j).transpose();
        const int p = 3 * node_of(j, a), q = 3 * node_of(j, b);
        if (a == b) {
          sum.M.block<3, 3>(p, p) += turned;
          continue;
        }
        sum.K.block<3, 3>(p, p) += turned;
        sum.K.block<3, 3>(q, q) += turned;
        sum.K.block<3, 3>(p, q) -= turned;
        sum.K.block<3, 3>(q, p) -= turned;
      }
    }
    return sum;
  }

  int count_;
  Eigen::Vector3d axis_;
  std::vector<Pair> pairs_;
};

/// A distributed AIJ matrix of what every rank has.
inline petsc::Matrix distributed(const Eigen::MatrixXd& A)
{
  petsc::Matrix B;
  const auto n = static_cast<PetscInt>(A.rows());
  petsc::check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n, n, n, nullptr, n,
                            nullptr, B.put()));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(B, &first, &last));
  for (PetscInt i = first; i < last; ++i)
    for (PetscInt j = 0; j < n; ++j)
      if (A(i, j) != 0.0) petsc::check(MatSetValue(B, i, j, A(i, j), INSERT_VALUES));
  linear::testing::finish(B);
  return B;
}

/// Rows in this order, of which each rank gives a part.
inline petsc::IndexSet shared_out(const std::vector<PetscInt>& rows)
{
  const auto n = static_cast<PetscInt>(rows.size());
  const PetscInt rank = petsc::rank(PETSC_COMM_WORLD), size = petsc::size(PETSC_COMM_WORLD);
  const PetscInt first = rank * n / size, last = (rank + 1) * n / size;
  petsc::IndexSet set;
  petsc::check(ISCreateGeneral(PETSC_COMM_WORLD, last - first, rows.data() + first,
                               PETSC_COPY_VALUES, set.put()));
  return set;
}

}  // namespace chladni::reduce::testing
