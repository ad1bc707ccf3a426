#include "plate/assembly/inertia_integrals.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/petsc.hpp"
#include "plate/assembly/assemble.hpp"
#include "plate/dofs/point_elements.hpp"
#include "plate/elements/mass_points.hpp"
#include "small_disc.hpp"
#include "square_plate.hpp"

namespace chladni::plate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const std::vector<PointMass> masses{{.at = "hub",
                                     .mass = 0.3,
                                     .inertia = {1e-3, 2e-3, 2.5e-3, 0, 0, 0},
                                     .offset = {0.01, 0.02, 0.03}}};

/// The disc on its hub, 12 mm off its mesh, with a lumped mass.
struct Fixture {
  mesh::Mesh mesh = testing::small_disc();
  std::vector<ShellSection> sections = testing::section;
  Structure structure{.shells = sections, .masses = masses};
  System system = assembled();

  System assembled()
  {
    sections[0].offset = 0.012;
    const int n_ranks = petsc::size(PETSC_COMM_WORLD);
    return assemble(
        mesh, structure,
        make_dof_map(mesh, {.couplings = testing::hub}, mesh::node_owners(mesh, n_ranks), n_ranks),
        PETSC_COMM_WORLD);
  }
  MassModel model() const { return mass_model(mesh, structure, system.dofs, PETSC_COMM_WORLD); }
};

/// Unit translations, then unit rotations about the axes through the origin, [n x 6].
petsc::Matrix rigid_columns(const System& system)
{
  PetscInt n_local = 0;
  petsc::check(MatGetLocalSize(system.M, &n_local, nullptr));
  petsc::Matrix R;
  petsc::check(MatCreateDense(PETSC_COMM_WORLD, n_local, PETSC_DECIDE, PETSC_DETERMINE, 6, nullptr,
                              R.put()));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(R, &first, &last));
  for (int node = 0; node < system.dofs.n_nodes(); ++node) {
    const PetscInt dof = 6 * system.dofs.number(node);
    if (system.dofs.is_dependent(node) || dof < first || dof >= last) continue;
    const Vector3d x = system.dofs.position(node);
    for (int k = 0; k < 3; ++k) {
      petsc::check(MatSetValue(R, dof + k, k, 1.0, INSERT_VALUES));
      petsc::check(MatSetValue(R, dof + 3 + k, 3 + k, 1.0, INSERT_VALUES));
      const Vector3d u = Vector3d::Unit(k).cross(x);
      for (int c = 0; c < 3; ++c) petsc::check(MatSetValue(R, dof + c, 3 + k, u[c], INSERT_VALUES));
    }
  }
  petsc::check(MatAssemblyBegin(R, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(R, MAT_FINAL_ASSEMBLY));
  return R;
}

/// A^T B, on every rank.
Eigen::MatrixXd product(Mat A, Mat B)
{
  petsc::Matrix C;
  petsc::check(MatTransposeMatMult(A, B, MAT_INITIAL_MATRIX, petsc::automatic, C.put()));
  PetscInt rows = 0, columns = 0, first = 0, last = 0;
  petsc::check(MatGetSize(C, &rows, &columns));
  petsc::check(MatGetOwnershipRange(C, &first, &last));
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(rows, columns);
  for (PetscInt i = first; i < last; ++i)
    for (PetscInt j = 0; j < columns; ++j) petsc::check(MatGetValue(C, i, j, &whole(i, j)));
  MPI_Allreduce(MPI_IN_PLACE, whole.data(), int(whole.size()), MPI_DOUBLE, MPI_SUM,
                PETSC_COMM_WORLD);
  return whole;
}

TEST(DisplacementProducts, OfEqualDirectionsSumToTheMassMatrix)
{
  const Fixture disc;
  const MassModel model = disc.model();
  petsc::Matrix difference;
  petsc::check(MatDuplicate(disc.system.M, MAT_COPY_VALUES, difference.put()));
  for (int k = 0; k < 3; ++k) {
    petsc::check(
        MatAXPY(difference, -1.0, displacement_product(model, k, k), DIFFERENT_NONZERO_PATTERN));
  }
  double norm = 0.0, M_norm = 0.0;
  petsc::check(MatNorm(difference, NORM_FROBENIUS, &norm));
  petsc::check(MatNorm(disc.system.M, NORM_FROBENIUS, &M_norm));
  EXPECT_LT(norm, 1e-14 * M_norm);  // round-off
}

TEST(DisplacementProducts, OfRigidMotionsAreTheMomentsOfTheMass)
{
  const Fixture disc;
  const MassModel model = disc.model();
  const MassMoments moments = mass_moments(model);
  const petsc::Matrix R = rigid_columns(disc.system);
  petsc::Matrix S_R;
  petsc::check(MatMatMult(displacement_product(model, 0, 1), R, MAT_INITIAL_MATRIX,
                          petsc::automatic, S_R.put()));
  const Eigen::MatrixXd S = product(R, S_R);
  // int u_x u_y: of a translation along x and a rotation about z, u_y = x; of the rotation about z
  // and itself, u_x u_y = -x y; of those about y and x, u_x = z, u_y = -z.
  const double round_off = 1e-14 * moments.mass;
  EXPECT_NEAR(S(0, 1), moments.mass, round_off);
  EXPECT_NEAR(S(1, 0), 0.0, round_off);
  EXPECT_NEAR(S(0, 5), moments.first.x(), round_off);
  EXPECT_NEAR(S(5, 5), -moments.second(0, 1), round_off);
  EXPECT_NEAR(S(4, 3), -moments.second(2, 2), round_off);
  EXPECT_NEAR(S(3, 4), 0.0, round_off);
}

TEST(MassMoments, AreThoseOfADiscAndALumpedMass)
{
  const Fixture disc;
  const MassMoments moments = mass_moments(disc.model());
  const double a = 0.025, b = 0.162, h = 0.02, z = 0.012;
  const double mass = 6300.0 * h * std::numbers::pi * (b * b - a * a);
  const Vector3d offset(0.01, 0.02, 0.03);
  Matrix3d second = Matrix3d::Zero();
  second.diagonal() << 0.25 * (a * a + b * b), 0.25 * (a * a + b * b), z * z + h * h / 12.0;
  second *= mass;
  second += 0.3 * offset * offset.transpose();
  second.diagonal() += Vector3d(1.75e-3, 0.75e-3, 0.25e-3);  // tr(J) / 2 - J
  // Cubic arcs of 30 mm miss the circle by (h / r)^4 / 1000.
  EXPECT_NEAR(moments.mass, mass + 0.3, 1e-5 * mass);
  EXPECT_LT((moments.first - 0.3 * offset - Vector3d(0, 0, mass * z)).norm(), 1e-5 * mass * z);
  EXPECT_LT((moments.second - second).norm(), 1e-5 * second.norm());
}

TEST(MassMoments, OfRigidDisplacementsAreThoseOfThePositions)
{
  const Fixture disc;
  const MassMoments moments = mass_moments(disc.model());
  const Eigen::MatrixXd V = product(moments.displacement, rigid_columns(disc.system));  // [12 x 6]
  const double round_off = 1e-14 * moments.mass;
  for (int l = 0; l < 3; ++l) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(V(l, j), l == j ? moments.mass : 0.0, round_off);
      // int e_l . (e_j x x) dm
      EXPECT_NEAR(V(l, 3 + j), Vector3d::Unit(j).cross(moments.first)[l], round_off);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(V(3 + 3 * k + l, j), l == j ? moments.first[k] : 0.0, round_off);
        const Vector3d x_x_k = moments.second.col(k);
        EXPECT_NEAR(V(3 + 3 * k + l, 3 + j), Vector3d::Unit(j).cross(x_x_k)[l], round_off);
      }
    }
  }
}

TEST(MassPoints, OfARigidBodyMakeItsMassMatrix)
{
  // The second inertia is of no real body; some of its points weigh less than nothing.
  for (const std::array<double, 6>& inertia :
       {std::array{3.0, 4.0, 5.0, 0.1, 0.2, -0.3}, std::array{1.0, 0.1, 0.1, 0.0, 0.0, 0.0}}) {
    const PointMass mass{.at = "tip", .mass = 2.0, .inertia = inertia, .offset = {0.4, -0.5, 0.6}};
    const MassPoints points = rigid_mass_points(mass, {1.0, 2.0, 3.0});
    Matrix6d M = Matrix6d::Zero();
    for (const StrainRows& N : points.N) M += N.transpose() * points.dm.asDiagonal() * N;
    EXPECT_LT((M - point_mass_matrix(mass)).norm(), 1e-14);
    EXPECT_LT((points.x.transpose() * points.dm - 2.0 * Vector3d(1.4, 1.5, 3.6)).norm(), 1e-14);
  }
}

TEST(MassMoments, OfTwoPlatesInAFoldAreThoseOfBothPlates)
{
  // Two squares of 0.1 m, 10 mm thick, with a common edge at x = 0.1 m.
  for (const double fold : {0.1, 30.0 * std::numbers::pi / 180.0, 0.69, 1.2}) {
    for (const int order : {1, 3}) {
      mesh::Mesh mesh =
          testing::rectangle({.a = 0.2, .b = 0.1, .n_x = 4, .n_y = 3, .order = order});
      for (std::array<double, 3>& x : mesh.positions) {
        const double beyond = std::max(0.0, x[0] - 0.1);
        x = {x[0] - beyond + beyond * std::cos(fold), x[1], beyond * std::sin(fold)};
      }
      const std::vector<ShellSection> sections{
          {.group = "plate",
           .material = {.young = 1.85e11, .poisson = 0.3, .density = 7800.0},
           .thickness = 0.01}};
      const Structure structure{.shells = sections};
      const int n_ranks = petsc::size(PETSC_COMM_WORLD);
      const DofMap dofs = make_dof_map(mesh, {}, mesh::node_owners(mesh, n_ranks), n_ranks);
      const System system = assemble(mesh, structure, dofs, PETSC_COMM_WORLD);
      const MassMoments moments =
          mass_moments(mass_model(mesh, structure, system.dofs, PETSC_COMM_WORLD));
      const petsc::Matrix R = rigid_columns(system);
      petsc::Matrix M_R;
      petsc::check(MatMatMult(system.M, R, MAT_INITIAL_MATRIX, petsc::automatic, M_R.put()));
      EXPECT_NEAR(moments.mass, 1.56, 1e-12) << fold << ", " << order;
      // Faces of leaning directors move mass by t^2 / 12 over the length of an element.
      EXPECT_NEAR(moments.first.x(), 0.78 * (0.15 + 0.05 * std::cos(fold)), 1e-4) << fold;
      EXPECT_NEAR(product(R, M_R)(0, 0), 1.56, 1e-12) << fold << ", " << order;
    }
  }
}

}  // namespace
}  // namespace chladni::plate
