#include "plate/elements/solid_element.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "common/error.hpp"
#include "mesh/element_types.hpp"

namespace chladni::plate {
namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::RowVector3d, Eigen::VectorXd;
using mesh::Shape;

constexpr Material iron{.young = 110e9, .poisson = 0.27, .density = 7150.0};

struct Type {
  Shape shape;
  int order;
};

std::vector<Type> all_types()
{
  return {{Shape::hexahedron, 1},
          {Shape::hexahedron, 2},
          {Shape::hexahedron, 3},
          {Shape::tetrahedron, 2},
          {Shape::wedge, 2}};
}

/// The corners of the elements that fill a cube [0, 1]^3, in their order.
std::vector<std::vector<RowVector3d>> pieces_of_cube(Shape shape)
{
  const auto x = [](int i) { return RowVector3d(i & 1, (i >> 1) & 1, (i >> 2) & 1); };
  if (shape == Shape::hexahedron) return {{x(0), x(1), x(3), x(2), x(4), x(5), x(7), x(6)}};
  if (shape == Shape::wedge)
    return {{x(0), x(1), x(2), x(4), x(5), x(6)}, {x(1), x(3), x(2), x(5), x(7), x(6)}};
  // Six about the diagonal from 0 to 7.
  return {{x(0), x(1), x(3), x(7)}, {x(0), x(3), x(2), x(7)}, {x(0), x(2), x(6), x(7)},
          {x(0), x(6), x(4), x(7)}, {x(0), x(4), x(5), x(7)}, {x(0), x(5), x(1), x(7)}};
}

/// The nodes of an element with straight edges between its corners.
NodeVectors straight(const Type& type, const std::vector<RowVector3d>& corners)
{
  const auto parent = mesh::solid_nodes(type.shape, type.order);
  NodeVectors x(std::ssize(parent), 3);
  for (Index i = 0; i < x.rows(); ++i) {
    const auto [r, s, t] = parent[std::size_t(i)];
    VectorXd N;
    if (type.shape == Shape::tetrahedron) {
      N = Eigen::Vector4d(1.0 - r - s - t, r, s, t);
    } else if (type.shape == Shape::wedge) {
      const Eigen::Vector3d L(1.0 - r - s, r, s);
      N = VectorXd(6);
      N << 0.5 * (1.0 - t) * L, 0.5 * (1.0 + t) * L;
    } else {
      N = VectorXd(8);
      const auto at = mesh::solid_nodes(Shape::hexahedron, 1);
      for (Index k = 0; k < 8; ++k) {
        const auto& c = at[std::size_t(k)];
        N[k] = 0.125 * (1.0 + r * c[0]) * (1.0 + s * c[1]) * (1.0 + t * c[2]);
      }
    }
    x.row(i).setZero();
    for (Index k = 0; k < N.size(); ++k) x.row(i) += N[k] * corners[std::size_t(k)];
  }
  return x;
}

/// Curved where the element has nodes on its edges.
RowVector3d distorted(const RowVector3d& x)
{
  return x + 0.09 * RowVector3d(std::sin(2.0 * x.y() + x.z()), std::sin(3.0 * x.z() - x.x()),
                                std::sin(2.5 * x.x() + 1.5 * x.y()));
}

struct Patch {
  NodeVectors x;
  std::vector<std::vector<Index>> elements;
  std::vector<char> is_inside;
};

enum class Edges { straight, curved };

/// 2 x 2 x 2 cubes, distorted.
Patch patch_of(const Type& type, Edges edges = Edges::curved)
{
  Patch patch;
  std::map<std::array<long, 3>, Index> index;
  std::vector<RowVector3d> places;
  for (int cube = 0; cube < 8; ++cube) {
    const RowVector3d origin(cube & 1, (cube >> 1) & 1, (cube >> 2) & 1);
    for (std::vector<RowVector3d> corners : pieces_of_cube(type.shape)) {
      for (RowVector3d& corner : corners) corner += origin;
      const NodeVectors x = straight(type, corners);
      std::vector<Index>& element = patch.elements.emplace_back();
      for (Index i = 0; i < x.rows(); ++i) {
        const std::array key{std::lround(1e6 * x(i, 0)), std::lround(1e6 * x(i, 1)),
                             std::lround(1e6 * x(i, 2))};
        const auto [it, is_new] = index.emplace(key, std::ssize(places));
        if (is_new) places.emplace_back(x.row(i));
        element.push_back(it->second);
      }
    }
  }
  patch.x.resize(std::ssize(places), 3);
  for (Index i = 0; i < patch.x.rows(); ++i) {
    const RowVector3d& at = places[std::size_t(i)];
    patch.x.row(i) = distorted(at);
    patch.is_inside.push_back(at.minCoeff() > 1e-6 && at.maxCoeff() < 2.0 - 1e-6 ? 1 : 0);
  }
  if (edges == Edges::curved) return patch;
  for (const std::vector<Index>& element : patch.elements) {
    std::vector<RowVector3d> corners;
    for (int k = 0; k < mesh::n_corners(type.shape); ++k)
      corners.emplace_back(patch.x.row(element[std::size_t(k)]));
    patch.x(element, Eigen::all) = straight(type, corners);
  }
  return patch;
}

NodeVectors nodes_of(const Patch& patch, const std::vector<Index>& element)
{
  return patch.x(element, Eigen::all);
}

/// DOFs x, y, z of nodes, as u_e with the rows of rotations.
VectorXd motion(const NodeVectors& x, const Matrix3d& slopes, const RowVector3d& shift)
{
  VectorXd u = VectorXd::Zero(6 * x.rows());
  for (Index i = 0; i < x.rows(); ++i)
    u.segment<3>(6 * i) = slopes * x.row(i).transpose() + shift.transpose();
  return u;
}

Matrix3d some_slopes()
{
  Matrix3d A;
  A << 1.0, 0.3, -0.2, 0.5, -0.7, 0.1, 0.4, 0.6, 0.8;
  return A;
}

/// The largest force on a node inside, over the largest on any.
double force_inside(const Type& type, Edges edges)
{
  const Patch patch = patch_of(type, edges);
  VectorXd force = VectorXd::Zero(6 * patch.x.rows());
  for (const std::vector<Index>& element : patch.elements) {
    const NodeVectors x = nodes_of(patch, element);
    const VectorXd f = solid_matrices(solid_frame(type.shape, type.order, x), iron).K *
                       motion(x, some_slopes(), RowVector3d::Zero());
    for (std::size_t i = 0; i < element.size(); ++i)
      force.segment<6>(6 * element[i]) += f.segment<6>(6 * Index(i));
  }
  double inside = 0.0;
  for (Index i = 0; i < patch.x.rows(); ++i)
    if (patch.is_inside[std::size_t(i)] != 0)
      inside = std::max(inside, force.segment<6>(6 * i).cwiseAbs().maxCoeff());
  return inside / force.cwiseAbs().maxCoeff();
}

TEST(SolidElement, ConstantStrainLeavesInnerNodesOfADistortedPatchWithoutForce)
{
  for (const Type& type : all_types()) {
    EXPECT_LT(force_inside(type, Edges::straight), 1e-13) << "order " << type.order;
    // 4 points are exact to degree 7; curved edges of order 3 have terms of degree 9.
    EXPECT_LT(force_inside(type, Edges::curved), type.order == 3 ? 1e-5 : 1e-13);
  }
}

TEST(SolidElement, StoresTheEnergyOfConstantStrainAndNoneOfRigidMotions)
{
  const double mu = iron.young / (2.0 * (1.0 + iron.poisson)),
               lambda = 2.0 * mu * iron.poisson / (1.0 - 2.0 * iron.poisson);
  const Matrix3d A = some_slopes(), e = 0.5 * (A + A.transpose());
  const double density = lambda * e.trace() * e.trace() + 2.0 * mu * e.squaredNorm();
  for (const Type& type : all_types()) {
    const Patch patch = patch_of(type);
    for (const std::vector<Index>& element : patch.elements) {
      const NodeVectors x = nodes_of(patch, element);
      const SolidFrame frame = solid_frame(type.shape, type.order, x);
      ASSERT_GT(frame.dV.minCoeff(), 0.0);
      const MatrixXd K = solid_matrices(frame, iron).K;
      const VectorXd u = motion(x, A, {1.0, 2.0, 3.0});
      EXPECT_NEAR(u.dot(K * u), density * frame.dV.sum(), 1e-12 * density * frame.dV.sum());
      const VectorXd turn = motion(x, A - A.transpose(), {0.1, 0.2, 0.3});
      EXPECT_LT((K * turn).norm(), 1e-12 * (K * u).norm());
    }
  }
}

/// No zero-energy motion but the rigid ones; 6 of 3 n eigenvalues vanish.
TEST(SolidElement, HasSixMotionsWithoutEnergy)
{
  for (const Type& type : all_types()) {
    const Patch patch = patch_of(type);
    const NodeVectors x = nodes_of(patch, patch.elements.front());
    const MatrixXd K = solid_matrices(solid_frame(type.shape, type.order, x), iron).K;
    const VectorXd lambda = Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues();
    const double largest = lambda.maxCoeff();
    EXPECT_EQ((lambda.array() < 1e-10 * largest).count(), 6 + 3 * x.rows());
    EXPECT_GT(lambda.minCoeff(), -1e-12 * largest);
  }
}

/// int dm, int x dm and int x x^T dm of a distorted patch agree between types whose edges are
/// curved alike, and M gives those of the mass points.
TEST(SolidElement, MassMatrixAndMassPointsAreOne)
{
  for (const Type& type : all_types()) {
    const Patch patch = patch_of(type);
    for (const std::vector<Index>& element : patch.elements) {
      const NodeVectors x = nodes_of(patch, element);
      const SolidFrame frame = solid_frame(type.shape, type.order, x);
      const MatrixXd M = solid_matrices(frame, iron).M;
      const MassPoints points = solid_mass_points(frame, iron);
      MatrixXd sum = MatrixXd::Zero(M.rows(), M.cols());
      for (const StrainRows& N : points.N) sum += N.transpose() * points.dm.asDiagonal() * N;
      EXPECT_LT((M - sum).norm(), 1e-13 * M.norm());
      const VectorXd u = motion(x, some_slopes(), {1.0, 2.0, 3.0});
      double kinetic = 0.0;
      for (Index q = 0; q < points.dm.size(); ++q) {
        const Eigen::Vector3d v =
            some_slopes() * points.x.row(q).transpose() + Eigen::Vector3d(1.0, 2.0, 3.0);
        kinetic += points.dm[q] * v.squaredNorm();
      }
      EXPECT_NEAR(u.dot(M * u), kinetic, 1e-12 * kinetic);
    }
  }
}

/// The six stresses of a linear motion, by Hooke's law, of distorted elements; and those of a
/// quadratic one at each point of elements with straight edges, by which the points are guarded.
TEST(SolidElement, StressesFollowHookesLaw)
{
  const double mu = iron.young / (2.0 * (1.0 + iron.poisson));
  const double lambda = 2.0 * mu * iron.poisson / (1.0 - 2.0 * iron.poisson);
  const auto hooke = [&](const Matrix3d& slopes) {
    const Matrix3d sigma =
        mu * (slopes + slopes.transpose()) + lambda * slopes.trace() * Matrix3d::Identity();
    return Eigen::Vector<double, 6>{sigma(0, 0), sigma(1, 1), sigma(2, 2),
                                    sigma(0, 1), sigma(1, 2), sigma(0, 2)};
  };
  for (const Type& type : all_types()) {
    const Patch patch = patch_of(type);
    for (const std::vector<Index>& element : patch.elements) {
      const NodeVectors x = nodes_of(patch, element);
      const auto [at, S] = solid_stresses(type.shape, type.order, x, iron);
      ASSERT_EQ(at.rows(), stress_points_of(type.shape, type.order));
      const VectorXd sigma = S * motion(x, some_slopes(), {1.0, 2.0, 3.0});
      const auto exact = hooke(some_slopes());
      for (Index q = 0; q < at.rows(); ++q)
        EXPECT_LT((sigma.segment<6>(6 * q) - exact).norm(), 1e-11 * exact.norm());
    }
    if (type.order == 1) continue;
    const NodeVectors x = straight(type, pieces_of_cube(type.shape).front());
    const auto [at, S] = solid_stresses(type.shape, type.order, x, iron);
    VectorXd u = VectorXd::Zero(6 * x.rows());  // x y, y z, z x
    for (Index i = 0; i < x.rows(); ++i)
      u.segment<3>(6 * i) << x(i, 0) * x(i, 1), x(i, 1) * x(i, 2), x(i, 2) * x(i, 0);
    for (Index q = 0; q < at.rows(); ++q) {
      const double X = at(q, 0), Y = at(q, 1), Z = at(q, 2);
      const auto exact = hooke(Matrix3d{{Y, X, 0.0}, {0.0, Z, Y}, {Z, 0.0, X}});
      EXPECT_LT(((S * u).segment<6>(6 * q) - exact).norm(), 1e-12 * iron.young);
    }
  }
}

/// The rule of a wedge and a tetrahedron with straight edges integrates x^4: no weight is wrong.
TEST(SolidElement, IntegratesPolynomialsOnAStraightElement)
{
  const std::map<Shape, double> exact{{Shape::tetrahedron, 24.0 / 5040.0},  // int r^4 = 4! / 7!
                                      {Shape::wedge, 2.0 * 24.0 / 720.0}};  // 2 int r^4 = 2 4! / 6!
  for (const auto& [shape, integral] : exact) {
    NodeVectors x(mesh::solid_nodes(shape, 2).size(), 3);
    for (Index i = 0; i < x.rows(); ++i)
      x.row(i) = RowVector3d(mesh::solid_nodes(shape, 2)[std::size_t(i)].data());
    const SolidFrame frame = solid_frame(shape, 2, x);
    for (int c = 0; c < 2; ++c)
      EXPECT_NEAR(frame.dV.dot(frame.x.col(c).array().pow(4).matrix()), integral, 1e-15);
  }
}

/// Where stresses are most accurate, the points of rules of degree 2 whose weights are equal.
TEST(SolidElement, HasItsStressPointsWhereTheirMeanIsThatOfQuadratics)
{
  struct Moments {
    Type type;
    double r, r_r, r_s, t, t_t, r_t;
  };
  for (const auto& [type, r, r_r, r_s, t, t_t, r_t] :
       {Moments{{Shape::tetrahedron, 2}, 0.25, 0.1, 0.05, 0.25, 0.1, 0.05},
        {{Shape::wedge, 2}, 1.0 / 3.0, 1.0 / 6.0, 1.0 / 12.0, 0.0, 1.0 / 3.0, 0.0},
        {{Shape::hexahedron, 2}, 0.0, 1.0 / 3.0, 0.0, 0.0, 1.0 / 3.0, 0.0}}) {
    NodeVectors x(mesh::solid_nodes(type.shape, type.order).size(), 3);
    for (Index i = 0; i < x.rows(); ++i)
      x.row(i) = RowVector3d(mesh::solid_nodes(type.shape, type.order)[std::size_t(i)].data());
    const NodeVectors at = solid_stresses(type.shape, type.order, x, iron).x;
    const RowVector3d mean = at.colwise().mean();
    const Matrix3d second = at.transpose() * at / double(at.rows());
    EXPECT_LT((mean - RowVector3d(r, r, t)).norm(), 1e-14);
    const Matrix3d exact{{r_r, r_s, r_t}, {r_s, r_r, r_t}, {r_t, r_t, t_t}};
    EXPECT_LT((second - exact).norm(), 1e-14) << second;
  }
}

TEST(SolidElement, TellsWhatIsThere)
{
  EXPECT_THROW(check_solid_exists(Shape::tetrahedron, 1), Error);
  EXPECT_THROW(check_solid_exists(Shape::hexahedron, 4), Error);
  EXPECT_NO_THROW(check_solid_exists(Shape::wedge, 2));
}

/// Bending of a slender beam of one layer: incompatible modes make a hexahedron of order 1 bend,
/// which locks by (L / h)^2 without them, and their mass moves with it.
TEST(SolidElement, OfOrderOneBendsWithoutLocking)
{
  constexpr double length = 1.0, height = 0.05;
  const Type type{Shape::hexahedron, 1};
  const std::vector<RowVector3d> corners{{0, 0, 0},           {length, 0, 0}, {length, 1, 0},
                                         {0, 1, 0},           {0, 0, height}, {length, 0, height},
                                         {length, 1, height}, {0, 1, height}};
  constexpr Material soft{.young = 1.0, .poisson = 0.0, .density = 1.0};
  const NodeVectors x = straight(type, corners);
  const auto [K, M] = solid_matrices(solid_frame(type.shape, type.order, x), soft);
  VectorXd u = VectorXd::Zero(48);  // u_x = z' x', the corners of pure bending
  for (Index i = 0; i < 8; ++i) u[6 * i] = (x(i, 2) - 0.5 * height) * (x(i, 0) - 0.5 * length);
  const double exact = length * height * height * height / 12.0;  // E I kappa^2 L
  EXPECT_NEAR(u.dot(K * u), exact, 1e-12 * exact);
  // Its middle stands off by kappa L^2 / 8 (1 - r^2), which is 2/3 of that at the points.
  const double mass = length * height;
  const double kinetic = mass * length * length * (length * length + height * height) / 144.0;
  EXPECT_NEAR(u.dot(M * u), kinetic, 1e-12 * kinetic);
}

}  // namespace
}  // namespace chladni::plate
