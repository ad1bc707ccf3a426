#include "plate/assembly/assemble.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "small_disc.hpp"
#include "square_plate.hpp"

namespace chladni::plate {
namespace {

System assemble_disc(MPI_Comm comm)
{
  const mesh::Mesh mesh = testing::small_disc();
  const int n_ranks = petsc::size(comm);
  return assemble(
      mesh, testing::section,
      make_dof_map(mesh, {.couplings = testing::hub}, mesh::node_owners(mesh, n_ranks), n_ranks),
      comm);
}

/// Translation along (component < 3) or rotation about an axis, at every DOF of the system.
petsc::Vector rigid_motion(const System& system, int component)
{
  petsc::Vector R;
  petsc::check(MatCreateVecs(system.K, R.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(R, &first, &last));
  for (int node = 0; node < system.dofs.n_nodes(); ++node) {
    const PetscInt dof = 6 * system.dofs.number(node);
    if (system.dofs.is_dependent(node) || dof < first || dof >= last) continue;
    const Eigen::Vector3d x = system.dofs.position(node);
    std::array<double, 6> u{};
    u[component] = 1.0;
    const int a = (component + 1) % 3, b = (component + 2) % 3;
    if (component >= 3) {  // e_axis x r
      u[b] = x[a];
      u[a] = -x[b];
    }
    for (int c = 0; c < 6; ++c) petsc::check(VecSetValue(R, dof + c, u[c], INSERT_VALUES));
  }
  petsc::check(VecAssemblyBegin(R));
  petsc::check(VecAssemblyEnd(R));
  return R;
}

void expect_no_force_in_rigid_motion(const System& system)
{
  double K_norm = 0.0;
  petsc::check(MatNorm(system.K, NORM_FROBENIUS, &K_norm));
  for (int component = 0; component < 6; ++component) {
    const petsc::Vector R = rigid_motion(system, component);
    petsc::Vector force;
    petsc::check(VecDuplicate(R, force.put()));
    petsc::check(MatMult(system.K, R, force));
    double norm = 0.0;
    petsc::check(VecNorm(force, NORM_2, &norm));
    EXPECT_LT(norm, 1e-14 * K_norm);  // round-off of the sums
  }
}

double quadratic_form(Mat A, Vec x)
{
  petsc::Vector A_x;
  petsc::check(VecDuplicate(x, A_x.put()));
  petsc::check(MatMult(A, x, A_x));
  double value = 0.0;
  petsc::check(VecDot(x, A_x, &value));
  return value;
}

/// Entries of the rows of this rank that are zero and not on the diagonal.
int zeros(Mat A)
{
  PetscInt begin = 0, end = 0;
  petsc::check(MatGetOwnershipRange(A, &begin, &end));
  int count = 0;
  for (PetscInt row = begin; row < end; ++row) {
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    petsc::check(MatGetRow(A, row, &n, &columns, &values));
    for (PetscInt k = 0; k < n; ++k) count += values[k] == 0.0 && columns[k] != row;
    EXPECT_TRUE(std::binary_search(columns, columns + n, row)) << row;
    petsc::check(MatRestoreRow(A, row, &n, &columns, &values));
  }
  return count;
}

TEST(Assemble, HoldsTheDiagonalAndFewZerosElsewhere)
{
  const System system = assemble_disc(PETSC_COMM_WORLD);
  for (const Mat A : {Mat(system.K), Mat(system.M)}) {
    MatInfo info{};
    petsc::check(MatGetInfo(A, MAT_GLOBAL_SUM, &info));
    EXPECT_GT(info.nz_used, 0.0);
    EXPECT_LE(zeros(A), A == system.K ? 0.02 * info.nz_used : 0.0);  // so that rows are alike
    PetscBool set = PETSC_FALSE, symmetric = PETSC_FALSE;
    petsc::check(MatIsSymmetricKnown(A, &set, &symmetric));
    EXPECT_TRUE(set && symmetric);  // Cholesky asks for it
  }
}

TEST(Assemble, LeavesTheFreeBodyWithoutForceInRigidMotion)
{
  const System system = assemble_disc(PETSC_COMM_WORLD);
  expect_no_force_in_rigid_motion(system);
}

TEST(Assemble, HasTheMassAndInertiaOfTheDisc)
{
  const System system = assemble_disc(PETSC_COMM_WORLD);
  const double area = std::numbers::pi * (0.162 * 0.162 - 0.025 * 0.025);
  const double mass = 6300.0 * 0.02 * area;
  const double polar = 0.5 * mass * (0.162 * 0.162 + 0.025 * 0.025);
  // Cubic arcs of 30 mm miss the circle by (h / r)^4 / 1000.
  EXPECT_NEAR(quadratic_form(system.M, rigid_motion(system, 2)), mass, 1e-5 * mass);
  EXPECT_NEAR(quadratic_form(system.M, rigid_motion(system, 5)), polar, 1e-5 * polar);
  const double diametral = 0.5 * polar + mass * 0.02 * 0.02 / 12.0;
  EXPECT_NEAR(quadratic_form(system.M, rigid_motion(system, 3)), diametral, 1e-5 * diametral);
}

TEST(Assemble, IsTheSameOnEachNumberOfRanks)
{
  // A node-wise invariant that does not depend on the numbering: x^T K x for a smooth field.
  const auto energy = [](const System& system) {
    petsc::Vector u = rigid_motion(system, 2);
    petsc::Vector v = rigid_motion(system, 4);
    petsc::check(VecPointwiseMult(u, v, v));  // w = -x, rotations zero: shear and bending energy
    return quadratic_form(system.K, u);
  };
  const double here = energy(assemble_disc(PETSC_COMM_WORLD));
  const double alone = energy(assemble_disc(PETSC_COMM_SELF));
  EXPECT_GT(here, 1.0);
  EXPECT_NEAR(here, alone, 1e-12 * alone);  // order of the sums of the products only
}

System assemble_beam(int n_elements)
{
  const mesh::Mesh mesh = mesh::beam({.start = {0, 0, 0},
                                      .end = {2, 0, 0},
                                      .elements = n_elements,
                                      .element_size = {},
                                      .points = {}});
  const BeamSection section{.group = "beam",
                            .material = {.young = 2e11, .poisson = 0.3, .density = 7800.0},
                            .area = 1e-4,
                            .I_y = 1e-9,
                            .I_z = 2e-9,
                            .J = 1.5e-9,
                            .orientation = std::array{0.0, 0.0, 1.0}};
  const int n_ranks = petsc::size(PETSC_COMM_WORLD);
  return assemble(mesh, {.beams = std::span(&section, 1)},
                  make_dof_map(mesh, {}, mesh::node_owners(mesh, n_ranks), n_ranks),
                  PETSC_COMM_WORLD);
}

TEST(Assemble, IsSymmetricToTheLastBitInPatternAndValues)
{
  for (const System& system :
       {assemble_disc(PETSC_COMM_WORLD), assemble_beam(160), assemble_beam(200)}) {
    for (const Mat A : {Mat(system.K), Mat(system.M)}) {
      petsc::Matrix transposed;
      PetscBool equal = PETSC_FALSE;
      petsc::check(MatTranspose(A, MAT_INITIAL_MATRIX, transposed.put()));
      petsc::check(MatEqual(A, transposed, &equal));  // patterns too
      EXPECT_TRUE(equal);
    }
  }
}

/// The disc turned about an axis through its centre, so that its plane is (almost) that of others.
mesh::Mesh turned_disc(const Eigen::Matrix3d& Q)
{
  mesh::Mesh mesh = testing::small_disc();
  for (std::array<double, 3>& x : mesh.positions) {
    const Eigen::Vector3d turned = Q * Eigen::Vector3d(x.data());
    x = {turned[0], turned[1], turned[2]};
  }
  return mesh;
}

/// Off-diagonal entries of the rows of all ranks below 1e-14 sqrt |A_ii A_jj| that are not zero.
int round_off_entries(Mat A)
{
  petsc::Vector diagonal;
  VecScatter scatter = nullptr;
  Vec all = nullptr;
  petsc::check(MatCreateVecs(A, diagonal.put(), nullptr));
  petsc::check(MatGetDiagonal(A, diagonal));
  petsc::check(VecScatterCreateToAll(diagonal, &scatter, &all));
  petsc::check(VecScatterBegin(scatter, diagonal, all, INSERT_VALUES, SCATTER_FORWARD));
  petsc::check(VecScatterEnd(scatter, diagonal, all, INSERT_VALUES, SCATTER_FORWARD));
  const PetscScalar* d = nullptr;
  petsc::check(VecGetArrayRead(all, &d));
  PetscInt begin = 0, end = 0;
  petsc::check(MatGetOwnershipRange(A, &begin, &end));
  int count = 0;
  for (PetscInt row = begin; row < end; ++row) {
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    petsc::check(MatGetRow(A, row, &n, &columns, &values));
    for (PetscInt k = 0; k < n; ++k) {
      const double scale = std::sqrt(std::abs(d[row])) * std::sqrt(std::abs(d[columns[k]]));
      count += columns[k] != row && values[k] != 0.0 && std::abs(values[k]) <= 0.999e-14 * scale;
    }
    petsc::check(MatRestoreRow(A, row, &n, &columns, &values));
  }
  petsc::check(VecRestoreArrayRead(all, &d));
  petsc::check(VecScatterDestroy(&scatter));
  petsc::check(VecDestroy(&all));
  MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT, MPI_SUM, PETSC_COMM_WORLD);
  return count;
}

double n_entries(Mat A)
{
  MatInfo info{};
  petsc::check(MatGetInfo(A, MAT_GLOBAL_SUM, &info));
  return info.nz_used;
}

TEST(Assemble, HasNoEntriesOfRoundOffAtAnyAngle)
{
  constexpr double right_angle = 0.5 * std::numbers::pi;  // with a cosine of 6e-17
  const int n_ranks = petsc::size(PETSC_COMM_WORLD);
  const double flat = n_entries(assemble_disc(PETSC_COMM_WORLD).K);
  for (const double angle : {right_angle, 2.0 * right_angle, 0.3}) {
    const Eigen::Matrix3d Q = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix();
    const mesh::Mesh mesh = turned_disc(Q);
    const System system = assemble(
        mesh, testing::section,
        make_dof_map(mesh, {.couplings = testing::hub}, mesh::node_owners(mesh, n_ranks), n_ranks),
        PETSC_COMM_WORLD);
    EXPECT_EQ(round_off_entries(system.K), 0) << angle;
    EXPECT_EQ(round_off_entries(system.M), 0) << angle;
    expect_no_force_in_rigid_motion(system);
    if (angle > 1.0) {
      EXPECT_NEAR(n_entries(system.K), flat, 0.02 * flat) << angle;  // what cancels by chance
    }
  }
}

struct RowOfNumbers {
  std::vector<PetscInt> columns;
  std::vector<double> values;
};

RowOfNumbers row_of(Mat A, PetscInt row)
{
  PetscInt n = 0;
  const PetscInt* columns = nullptr;
  const PetscScalar* values = nullptr;
  petsc::check(MatGetRow(A, row, &n, &columns, &values));
  RowOfNumbers copy{{columns, columns + n}, {values, values + n}};
  petsc::check(MatRestoreRow(A, row, &n, &columns, &values));
  return copy;
}

/// Whether more than half of the numbers of the shorter list are in both.
bool are_much_the_same(const std::vector<PetscInt>& a, const std::vector<PetscInt>& b)
{
  const auto n =
      std::ranges::count_if(a, [&](PetscInt i) { return std::ranges::binary_search(b, i); });
  return 2 * n > std::min(std::ssize(a), std::ssize(b));
}

TEST(Assemble, GivesRowsOfANodeWithMuchTheSameColumnsTheSame)
{
  const System system = assemble_disc(PETSC_COMM_WORLD);
  PetscInt begin = 0, end = 0;
  petsc::check(MatGetOwnershipRange(system.K, &begin, &end));
  double n_zeros = 0.0, n_pairs = 0.0;
  for (PetscInt node = begin / 6; node < end / 6; ++node) {
    std::vector<RowOfNumbers> rows;
    for (PetscInt i = 0; i < 6; ++i) rows.push_back(row_of(system.K, 6 * node + i));
    for (const RowOfNumbers& row : rows) {
      n_zeros += double(std::ranges::count(row.values, 0.0));
      for (const RowOfNumbers& other : rows) {
        if (!are_much_the_same(row.columns, other.columns)) continue;
        EXPECT_EQ(row.columns, other.columns) << "node " << node;
        n_pairs += &row == &other ? 0.0 : 1.0;
      }
    }
  }
  for (double* count : {&n_zeros, &n_pairs})
    MPI_Allreduce(MPI_IN_PLACE, count, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  EXPECT_GT(n_pairs, 0.0);
  EXPECT_GT(n_zeros, 0.0);  // or nothing was tried
}

TEST(Assemble, HasAnEntryOnBothSidesOfTheDiagonal)
{
  const System system = assemble_disc(PETSC_COMM_WORLD);
  petsc::Matrix transposed;
  petsc::check(MatTranspose(system.K, MAT_INITIAL_MATRIX, transposed.put()));
  PetscInt begin = 0, end = 0;
  petsc::check(MatGetOwnershipRange(system.K, &begin, &end));
  for (PetscInt row = begin; row < end; ++row)
    EXPECT_EQ(row_of(system.K, row).columns, row_of(transposed, row).columns) << row;
}

/// The disc with a beam on its outer edge, whose nodes are those of the disc.
mesh::Mesh stiffened_disc()
{
  mesh::Mesh mesh = testing::small_disc();
  const mesh::Group& edge = mesh::find_group(mesh, "outer_edge");
  const auto angle = [&](int node) {
    return std::atan2(mesh.positions[node][1], mesh.positions[node][0]);
  };
  std::vector<int> nodes = edge.nodes;
  std::ranges::sort(nodes, {}, angle);
  mesh::ElementBlock ring{.shape = mesh::Shape::line,
                          .order = 1,
                          .nodes_per_element = 2,
                          .numbers = {},
                          .nodes = {},
                          .group = {}};
  const auto group = static_cast<int>(&edge - mesh.groups.data());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    ring.numbers.push_back(10000 + std::int64_t(i));
    ring.group.push_back(group);
    ring.nodes.insert(ring.nodes.end(), {nodes[i], nodes[(i + 1) % nodes.size()]});
  }
  mesh.blocks.push_back(ring);
  return mesh;
}

const std::vector<BeamSection> rim{{.group = "outer_edge",
                                    .material = {.young = 2e11, .poisson = 0.3, .density = 7800.0},
                                    .area = 1e-4,
                                    .I_y = 1e-9,
                                    .I_z = 2e-9,
                                    .J = 1.5e-9,
                                    .orientation = std::array{0.0, 0.0, 1.0}}};

System assemble_stiffened_disc(MPI_Comm comm)
{
  const mesh::Mesh mesh = stiffened_disc();
  const int n_ranks = petsc::size(comm);
  return assemble(
      mesh, {.shells = testing::section, .beams = rim},
      make_dof_map(mesh, {.couplings = testing::hub}, mesh::node_owners(mesh, n_ranks), n_ranks),
      comm);
}

TEST(Assemble, JoinsBeamsAndShellsAtTheirNodes)
{
  const System disc = assemble_disc(PETSC_COMM_WORLD);
  const System stiffened = assemble_stiffened_disc(PETSC_COMM_WORLD);
  expect_no_force_in_rigid_motion(stiffened);
  const double added = quadratic_form(stiffened.M, rigid_motion(stiffened, 2)) -
                       quadratic_form(disc.M, rigid_motion(disc, 2));
  // A polygon of chords of 10 mm in a circle of 162 mm: 1 - (10/162)^2 / 24.
  EXPECT_NEAR(added / (7800.0 * 1e-4 * 2.0 * std::numbers::pi * 0.162), 1.0, 3e-4);
}

TEST(Assemble, MixesBeamsAndShellsAlikeOnEachNumberOfRanks)
{
  const auto energy = [](const System& system) {
    petsc::Vector u = rigid_motion(system, 2);
    petsc::Vector v = rigid_motion(system, 4);
    petsc::check(VecPointwiseMult(u, v, v));  // w = -x, rotations zero
    return quadratic_form(system.K, u);
  };
  const double here = energy(assemble_stiffened_disc(PETSC_COMM_WORLD));
  const double alone = energy(assemble_stiffened_disc(PETSC_COMM_SELF));
  EXPECT_GT(alone, 1.01 * energy(assemble_disc(PETSC_COMM_SELF)));
  EXPECT_NEAR(here, alone, 1e-12 * alone);  // order of the sums of the products only
}

TEST(Assemble, HoldsComponentsThatTheModelDoesNotHave)
{
  const mesh::Mesh mesh = mesh::beam(
      {.start = {0, 0, 0}, .end = {2, 0, 0}, .elements = 8, .element_size = {}, .points = {}});
  BeamSection section = rim[0];
  section.group = "beam";
  section.theory = BeamTheory::bernoulli_euler;
  const int n_ranks = petsc::size(PETSC_COMM_WORLD);
  DofMap map =
      make_dof_map(mesh, {.components = {2, 4}}, mesh::node_owners(mesh, n_ranks), n_ranks);
  EXPECT_EQ(map.dof(0, 1), std::nullopt);
  const System planar =
      assemble(mesh, {.beams = std::span(&section, 1)}, std::move(map), PETSC_COMM_WORLD);
  PetscInt n = 0;
  petsc::check(MatGetSize(planar.K, &n, nullptr));
  EXPECT_EQ(n, 18);
  // w = x^2, theta_y = -2 x bends with the curvature 2: 2 EI L of twice the energy, per element.
  petsc::Vector u;
  petsc::check(MatCreateVecs(planar.K, u.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(u, &first, &last));
  for (int node = 0; node < 9; ++node) {
    const double x = mesh.positions[node][0];
    if (*planar.dofs.dof(node, 2) < first || *planar.dofs.dof(node, 2) >= last) continue;
    petsc::check(VecSetValue(u, *planar.dofs.dof(node, 2), x * x, INSERT_VALUES));
    petsc::check(VecSetValue(u, *planar.dofs.dof(node, 4), -2.0 * x, INSERT_VALUES));
  }
  petsc::check(VecAssemblyBegin(u));
  petsc::check(VecAssemblyEnd(u));
  EXPECT_NEAR(quadratic_form(planar.K, u) / (4.0 * 2e11 * 1e-9 * 2.0), 1.0, 1e-12);
}

TEST(Assemble, NamesABeamSectionWithoutLines)
{
  const mesh::Mesh mesh = testing::small_disc();
  const int n_ranks = petsc::size(PETSC_COMM_WORLD);
  const DofMap map =
      make_dof_map(mesh, {.couplings = testing::hub}, mesh::node_owners(mesh, n_ranks), n_ranks);
  try {
    assemble(mesh, {.shells = testing::section, .beams = rim}, map, PETSC_COMM_WORLD);
    FAIL() << "a beam section of a group without lines is accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("\"outer_edge\": the group has no line elements"),
              std::string::npos);
  }
}

TEST(Assemble, NamesAnElementThatIsFoldedOver)
{
  mesh::Mesh mesh = testing::small_disc();
  mesh::ElementBlock& block = mesh.blocks[0];
  std::swap(mesh.positions[block.nodes[0]], mesh.positions[block.nodes[5]]);
  const int n_ranks = petsc::size(PETSC_COMM_WORLD);
  const DofMap map =
      make_dof_map(mesh, {.couplings = testing::hub}, mesh::node_owners(mesh, n_ranks), n_ranks);
  EXPECT_THROW(assemble(mesh, testing::section, map, PETSC_COMM_WORLD), Error);
}

TEST(Assemble, NamesAnElementWithoutSection)
{
  const mesh::Mesh mesh = testing::small_disc();
  const int n_ranks = petsc::size(PETSC_COMM_WORLD);
  const DofMap map =
      make_dof_map(mesh, {.couplings = testing::hub}, mesh::node_owners(mesh, n_ranks), n_ranks);
  EXPECT_THROW(assemble(mesh, Structure{}, map, PETSC_COMM_WORLD), Error);
}

/// A part of a cylinder about z, of an angle.
mesh::Mesh bent_plate(double radius, double angle, testing::Rectangle flat)
{
  flat.a = radius * angle;
  mesh::Mesh mesh = testing::rectangle(flat);
  for (std::array<double, 3>& x : mesh.positions)
    x = {radius * std::cos(x[0] / radius), radius * std::sin(x[0] / radius), x[1]};
  return mesh;
}

std::string error_of_assembly(const mesh::Mesh& mesh, double thickness)
{
  const ShellSection section{
      .group = "plate", .material = testing::section[0].material, .thickness = thickness};
  const int n = petsc::size(PETSC_COMM_WORLD);
  try {
    assemble(mesh, std::span(&section, 1), make_dof_map(mesh, {}, mesh::node_owners(mesh, n), n),
             PETSC_COMM_WORLD);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Assemble, RefusesByElementWhatIsNotANumber)
{
  const mesh::Mesh mesh =
      bent_plate(0.1, 1.5, {.a = 0.0, .b = 0.1, .n_x = 4, .n_y = 3, .order = 3});
  // The inner points of integration are at 0.577 of the half thickness from the middle.
  EXPECT_EQ(error_of_assembly(mesh, 0.3), "");
  const std::string text = error_of_assembly(mesh, 0.5);
  for (const char* word : {"of group \"plate\"", "stiffness", "not a number", "thinner"})
    EXPECT_NE(text.find(word), std::string::npos) << text;
}

}  // namespace
}  // namespace chladni::plate
