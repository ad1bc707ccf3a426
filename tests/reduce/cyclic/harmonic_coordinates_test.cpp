#include "reduce/cyclic/harmonic_coordinates.hpp"
#include "linear/dense/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <vector>

namespace chladni::cyclic {
namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::VectorXd;

constexpr int sector_count = 6;

Matrix3d turn(double angle)
{
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

SparseRows sparse(const MatrixXd& A)
{
  SparseRows rows = A.sparseView(0.0, 0.0);
  rows.makeCompressed();
  return rows;
}

/// A sector of six nodes: two of a ring and two others at the cut edges, one in the middle, which
/// may be of the ring too, and one on the axis. Its stiffness is any definite matrix.
struct AnySector {
  SectorDofs dofs{.count = sector_count,
                  .n_blocks = 6,
                  .components = {0, 1, 2, 3, 4, 5},
                  .edges = {{{0, 1}}, {{2, 3}}},
                  .axis = {5},
                  .rings = {}};
  MatrixXd K;

  explicit AnySector(unsigned seed, int ring_nodes_of_sector = 1)
  {
    std::srand(seed);
    const MatrixXd A = MatrixXd::Random(36, 36);
    K = A * A.transpose() + MatrixXd::Identity(36, 36);
    const double step = 2.0 * std::numbers::pi / sector_count;
    dofs.rings.push_back({.blocks = {0, 1},
                          .angles = {0.2, 0.2 + step},
                          .n_nodes = ring_nodes_of_sector * sector_count,
                          .first_angle = 0.2,
                          .up_to = ring_nodes_of_sector * sector_count / 2});
    if (ring_nodes_of_sector == 1) return;
    dofs.rings.back().blocks.push_back(4);
    dofs.rings.back().angles.push_back(0.2 + 0.5 * step);
  }

  /// The whole body: blocks 0, 2, 4 of each sector in turn, in axes that turn with it, then the
  /// node on the axis.
  MatrixXd whole() const
  {
    const Index n = 18 * sector_count + 6;
    MatrixXd sum = MatrixXd::Zero(n, n);
    for (int j = 0; j < sector_count; ++j) {
      MatrixXd L = MatrixXd::Zero(36, n);
      const auto place = [&](int block, int sector, int of_three) {
        L.block<6, 6>(6 * block, 18 * (sector % sector_count) + 6 * of_three) =
            block_turn(2.0 * std::numbers::pi / sector_count * (sector - j));
      };
      place(0, j, 0);
      place(1, j + 1, 0);
      place(2, j, 1);
      place(3, j + 1, 1);
      place(4, j, 2);
      L.block<6, 6>(30, 18 * sector_count) = block_turn(-2.0 * std::numbers::pi * j / sector_count);
      sum += L.transpose() * K * L;
    }
    return sum;
  }

  static Eigen::Matrix<double, 6, 6> block_turn(double angle)
  {
    Eigen::Matrix<double, 6, 6> T = Eigen::Matrix<double, 6, 6>::Zero();
    T.topLeftCorner<3, 3>() = T.bottomRightCorner<3, 3>() = turn(angle);
    return T;
  }
};

VectorXd eigenvalues_of_pencil(const MatrixXd& A)
{
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

/// Of the pencil (A, G), with G the form of the unit matrix of the whole body.
VectorXd eigenvalues_of_pencil(const MatrixXd& A, const MatrixXd& G)
{
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(A, G, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

/// Each node of the whole body counts once: those that sectors share by their share.
MatrixXd unit_of_sector()
{
  VectorXd share = VectorXd::Ones(36);
  share.head<24>().setConstant(0.5);
  share.tail<6>().setConstant(1.0 / sector_count);
  return share.asDiagonal();
}

TEST(HarmonicCoordinates, GiveAllEigenvaluesOfTheWholeBodyAndNoOthers)
{
  for (const int ring_nodes_of_sector : {1, 2}) {
    const AnySector sector(3, ring_nodes_of_sector);
    VectorXd expected = eigenvalues_of_pencil(sector.whole());
    std::vector<double> found;
    for (int n = 0; n < n_harmonics(sector_count); ++n) {
      const HarmonicCoordinates c = harmonic_coordinates(sector.dofs, n);
      const VectorXd lambda =
          eigenvalues_of_pencil(MatrixXd(harmonic_form(sparse(sector.K), c)),
                                MatrixXd(harmonic_form(sparse(unit_of_sector()), c)));
      found.insert(found.end(), lambda.begin(), lambda.end());
    }
    std::ranges::sort(found);
    ASSERT_EQ(std::ssize(found), expected.size());
    for (Index i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(found[static_cast<std::size_t>(i)] / expected[i], 1.0, 1e-11) << i;
  }
}

/// The highest harmonic of an even ring, which changes its sign from node to node, has no other one
/// beside it: it is a cosine from the first node on, wherever that is.
TEST(HarmonicCoordinates, HaveOrthonormalHarmonicsOfTheirRings)
{
  for (const int ring_nodes_of_sector : {1, 2}) {
    const AnySector sector(3, ring_nodes_of_sector);
    int n_found = 0;
    for (int n = 0; n < n_harmonics(sector_count); ++n) {
      const HarmonicCoordinates c = harmonic_coordinates(sector.dofs, n);
      std::vector<int> of_ring;
      for (const Master& master : c.masters)
        if (master.ring == 0) of_ring.push_back(master.coordinate);
      const MatrixXd I = MatrixXd(harmonic_form(sparse(unit_of_sector()), c))(of_ring, of_ring);
      const Index size = std::ssize(of_ring);
      EXPECT_LT((I - MatrixXd::Identity(size, size)).norm(), 1e-14) << n;
      n_found += static_cast<int>(size);
    }
    EXPECT_EQ(n_found, 6 * ring_nodes_of_sector * sector_count);
  }
}

TEST(HarmonicCoordinates, AreTurnedByAQuarterWithoutAChangeOfEnergy)
{
  const AnySector sector(5);
  for (const int n : {1, 2}) {
    const HarmonicCoordinates c = harmonic_coordinates(sector.dofs, n);
    const SparseRows K = harmonic_form(sparse(sector.K), c);
    SparseRows unit(c.n(), c.n());
    unit.setIdentity();
    const MatrixXd J(times_quarter_turn(unit, c)), A(K);
    EXPECT_LT((J * J + MatrixXd::Identity(c.n(), c.n())).norm(), 1e-15) << n;
    EXPECT_LT((J.transpose() * A * J - A).norm(), 1e-13 * A.norm()) << n;
    EXPECT_LT((MatrixXd(times_quarter_turn(K, c)) - A * J).norm(), 1e-15 * A.norm()) << n;
  }
}

TEST(HarmonicCoordinates, HaveTheHarmonicsOfTheirRingsAndTheNodeOnTheAxisAsMasters)
{
  const AnySector sector(5);
  const auto masters = [&](int n) { return harmonic_coordinates(sector.dofs, n).masters; };
  EXPECT_EQ(masters(0).size(), 2u + 6u);   // z and rz of the axis, the mean of the ring
  EXPECT_EQ(masters(1).size(), 4u + 12u);  // x, y, rx, ry; cosine and sine
  EXPECT_EQ(masters(2).size(), 12u);
  EXPECT_EQ(masters(3).size(), 6u);  // of the highest harmonic the cosine
}

TEST(HarmonicCoordinates, AreSymmetricToTheLastBit)
{
  const AnySector sector(8);
  const HarmonicCoordinates c = harmonic_coordinates(sector.dofs, 2);
  const MatrixXd K(harmonic_form(sparse(sector.K), c));
  EXPECT_EQ((K - K.transpose()).cwiseAbs().maxCoeff(), 0.0);
}

}  // namespace
}  // namespace chladni::cyclic
