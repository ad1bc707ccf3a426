#include "plate/dofs/point_elements.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "common/error.hpp"
#include "mesh/generators.hpp"
#include "mesh/partition.hpp"
#include "plate/assembly/assemble.hpp"

namespace chladni::plate {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

const std::array<double, 6> uneven{1, 2, 3, 4, 5, 6};

/// Rigid motion of points about the origin, [6 n x 6].
MatrixXd rigid_motions(const std::vector<Vector3d>& points)
{
  MatrixXd R = MatrixXd::Zero(6 * std::ssize(points), 6);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(6 * i);
    R.block<6, 6>(row, 0).setIdentity();
    for (int k = 0; k < 3; ++k) R.block<3, 1>(row, 3 + k) = Vector3d::Unit(k).cross(points[i]);
  }
  return R;
}

TEST(PointMass, WithAnOffsetIsTheRigidBodyAtItsCentre)
{
  const PointMass mass{
      .at = "tip", .mass = 2.0, .inertia = {3, 4, 5, 0.1, 0.2, -0.3}, .offset = {0.4, -0.5, 0.6}};
  const Eigen::Matrix<double, 6, 6> M = point_mass_matrix(mass);
  // The motion of the centre for unit motions of the node.
  Eigen::Matrix<double, 6, 6> T = Eigen::Matrix<double, 6, 6>::Identity();
  for (int k = 0; k < 3; ++k)
    T.block<3, 1>(0, 3 + k) = Vector3d::Unit(k).cross(Vector3d(0.4, -0.5, 0.6));
  Eigen::Matrix<double, 6, 6> at_centre = Eigen::Matrix<double, 6, 6>::Zero();
  at_centre.topLeftCorner<3, 3>().diagonal().setConstant(2.0);
  at_centre.bottomRightCorner<3, 3>() << 3, 0.1, 0.2, 0.1, 4, -0.3, 0.2, -0.3, 5;
  EXPECT_LT((M - T.transpose() * at_centre * T).norm(), 1e-14);
}

TEST(SpringMatrix, FeelsNoForceInRigidMotionAndStretchesAtTheMiddle)
{
  const Vector3d a(0.3, 0.2, 0.1), b(1.0, -2.0, 0.5);
  const MatrixXd K = spring_matrix(uneven, b - a);
  EXPECT_LT((K * rigid_motions({a, b})).norm(), 1e-13);
  EXPECT_LT((K - K.transpose()).norm(), 1e-14);
  Eigen::Vector<double, 12> u = Eigen::Vector<double, 12>::Zero();
  u[7] = 1.0;  // u_y of the second node alone
  EXPECT_NEAR(u.dot(K * u), 2.0, 1e-14);
}

mesh::Mesh two_node_beam()
{
  return mesh::beam({.start = {0, 0, 0},
                     .end = {2, 0, 0},
                     .elements = 4,
                     .element_size = {},
                     .points = {{.name = "middle", .distance = 1.0}}});
}

const std::vector<BeamSection> beam_sections{
    {.group = "beam",
     .material = {.young = 2e5, .poisson = 0.25, .density = 7.0},
     .area = 0.01,
     .I_y = 1e-4,
     .I_z = 1e-4,
     .J = 2e-4}};

System assemble_with(const std::vector<PointMass>& masses, const std::vector<Spring>& springs)
{
  const mesh::Mesh mesh = two_node_beam();
  const int n_ranks = petsc::size(PETSC_COMM_WORLD);
  return assemble(mesh, {.beams = beam_sections, .masses = masses, .springs = springs},
                  make_dof_map(mesh, {}, mesh::node_owners(mesh, n_ranks), n_ranks),
                  PETSC_COMM_WORLD);
}

/// A(row, column), on every rank.
double entry(const System& system, Mat A, std::pair<int, int> row, std::pair<int, int> column)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  const PetscInt i = *system.dofs.dof(row.first, row.second);
  const PetscInt j = *system.dofs.dof(column.first, column.second);
  double value = 0.0;
  if (i >= first && i < last) petsc::check(MatGetValue(A, i, j, &value));
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return value;
}

TEST(PointElements, AreAddedToTheMatricesOnAnyNumberOfRanks)
{
  const System plain = assemble_with({}, {});
  EXPECT_EQ(Mat(plain.C), nullptr);
  const System system =
      assemble_with({{.at = "middle", .mass = 3.0, .inertia = {1, 1, 1}, .offset = {0, 0, 0.5}}},
                    {{.at = "start", .stiffness = uneven, .damping = {0, 0, 7, 0, 0, 0}},
                     {.at = "start", .to = "end", .stiffness = {}, .damping = {9, 0, 0, 0, 0, 0}}});
  ASSERT_NE(Mat(system.C), nullptr);
  const auto added = [&](Mat A, Mat B, std::pair<int, int> row, std::pair<int, int> column) {
    return entry(system, A, row, column) - entry(plain, B, row, column);
  };
  constexpr double round_off = 1e-9;  // of the beam's own entries, 1e5
  EXPECT_NEAR(added(system.M, plain.M, {2, 2}, {2, 2}), 3.0, round_off);
  EXPECT_NEAR(added(system.M, plain.M, {2, 0}, {2, 4}), 1.5, round_off);
  EXPECT_NEAR(added(system.M, plain.M, {2, 3}, {2, 3}), 1.0 + 3.0 * 0.25, round_off);
  EXPECT_NEAR(added(system.K, plain.K, {0, 1}, {0, 1}), 2.0, round_off);
  EXPECT_NEAR(added(system.K, plain.K, {0, 5}, {0, 5}), 6.0, round_off);
  EXPECT_NEAR(entry(system, system.C, {0, 2}, {0, 2}), 7.0, 0.0);
  EXPECT_NEAR(entry(system, system.C, {0, 0}, {0, 0}), 9.0, 0.0);
  EXPECT_NEAR(entry(system, system.C, {0, 0}, {4, 0}), -9.0, 0.0);
}

std::string assembly_complaint(const std::vector<PointMass>& masses,
                               const std::vector<Spring>& springs)
{
  try {
    assemble_with(masses, springs);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PointElements, NamePlacesThatDoNotFit)
{
  EXPECT_NE(assembly_complaint({{.at = "tip", .mass = 1.0}}, {})
                .find("\"tip\" is neither a group or ring of the mesh nor a coupling; there "
                      "are: beam, start, end, middle"),
            std::string::npos);
  EXPECT_NE(assembly_complaint({}, {{.at = "start", .to = "beam", .stiffness = uneven}})
                .find("spring at \"beam\": between two places each must be one node, and this "
                      "group has 5"),
            std::string::npos);
  EXPECT_NE(
      assembly_complaint({}, {{.at = "end", .to = "end", .stiffness = uneven}}).find("begins"),
      std::string::npos);
}

}  // namespace
}  // namespace chladni::plate
