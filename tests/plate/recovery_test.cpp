#include "plate/assembly/recovery.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/partition.hpp"
#include "plate/assembly/assemble.hpp"
#include "plate/dofs/dof_map.hpp"
#include "square_plate.hpp"

namespace chladni::plate {
namespace {

using Eigen::MatrixXd;
using std::numbers::pi;

const Material steel_of_plate{.young = 2e11, .poisson = 0.3, .density = 8000.0};
constexpr double a = 1.0;
constexpr double p_0 = 1e4;

/// A plate of side 1 and its section.
struct Plate {
  mesh::Mesh mesh;
  ShellSection section;
};

Plate square(double thickness, int n, int order)
{
  return {.mesh = testing::rectangle({.a = a, .b = a, .n_x = n, .n_y = n, .order = order}),
          .section = {.group = "plate", .material = steel_of_plate, .thickness = thickness}};
}

/// The motion w = sin(pi x) sin(pi y) of a thin plate with its rotations, at the nodes.
MatrixXd sine_wave(const mesh::Mesh& mesh)
{
  MatrixXd motions = MatrixXd::Zero(mesh.n_nodes(), 6);
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const auto& x = mesh.positions[node];
    const double w_x = pi * std::cos(pi * x[0]) * std::sin(pi * x[1]);
    const double w_y = pi * std::sin(pi * x[0]) * std::cos(pi * x[1]);
    motions.row(node) << 0, 0, std::sin(pi * x[0]) * std::sin(pi * x[1]), w_y, -w_x, 0;
  }
  return motions;
}

/// The largest error of M_xx over the nodes, relative to its largest value.
double moment_error(int n, int order)
{
  const double t = 0.01;
  const Plate plate = square(t, n, order);
  const ShellResultants result =
      nodal_resultants(plate.mesh, plate.section, sine_wave(plate.mesh), PETSC_COMM_WORLD);
  const double D = steel_of_plate.young * t * t * t / (12.0 * (1.0 - 0.3 * 0.3));
  const double amplitude = D * pi * pi * (1.0 + 0.3);
  double largest = 0.0;
  for (int node = 0; node < plate.mesh.n_nodes(); ++node) {
    const auto& x = plate.mesh.positions[node];
    const double exact = amplitude * std::sin(pi * x[0]) * std::sin(pi * x[1]);
    largest = std::max(largest, std::abs(result.M(node, 0) - exact) / amplitude);
  }
  return largest;
}

TEST(NodalResultants, ConvergeWithTheOrderOfTheElements)
{
  // Moments are derivatives of the rotations: order p of polynomials of order p, less what the
  // edges of so few elements cost.
  for (const int order : {1, 2, 3}) {
    const double rate = std::log2(moment_error(4, order) / moment_error(8, order));
    EXPECT_GT(rate, order - 0.3) << order;
  }
}

TEST(NodalResultants, AreTheSameOnEachNumberOfRanks)
{
  const Plate plate = square(0.01, 4, 2);
  const MatrixXd motions = sine_wave(plate.mesh);
  const ShellResultants here =
      nodal_resultants(plate.mesh, plate.section, motions, PETSC_COMM_WORLD);
  const ShellResultants alone =
      nodal_resultants(plate.mesh, plate.section, motions, PETSC_COMM_SELF);
  EXPECT_LT((here.M - alone.M).norm(), 1e-12 * alone.M.norm());
  EXPECT_LT((here.Q - alone.Q).norm(), 1e-12 * alone.M.norm() / a);
}

TEST(NodalResultants, ReferToOneSideWhereNeighboursTurnOver)
{
  Plate plate = square(0.01, 4, 1);
  const MatrixXd motions = sine_wave(plate.mesh);
  const ShellResultants before =
      nodal_resultants(plate.mesh, plate.section, motions, PETSC_COMM_WORLD);
  mesh::ElementBlock& block = plate.mesh.blocks[0];
  std::swap(block.nodes[4 * 5 + 1], block.nodes[4 * 5 + 2]);  // mirrors element 6
  const ShellResultants after =
      nodal_resultants(plate.mesh, plate.section, motions, PETSC_COMM_WORLD);
  EXPECT_LT((before.M - after.M).norm(), 1e-12 * before.M.norm());
  EXPECT_LT((before.Q - after.Q).norm(), 1e-12 * before.Q.norm());
}

/// The solution of a plate under pressure p_0, hard simply supported, by its double sine series
/// (Navier): moments are those of Kirchhoff's plate for any thickness.
struct Navier {
  double M_centre = 0.0;  ///< M_xx at the centre
  double Q_edge = 0.0;    ///< Q_x in the middle of the edge x = 0
};

Navier navier()
{
  Navier sum;
  for (int m = 1; m < 400; m += 2) {
    for (int n = 1; n < 400; n += 2) {
      const double q = 16.0 * p_0 / (pi * pi * m * n);
      const double k2 = pi * pi * (m * m + n * n) / (a * a);
      const double sign = ((m + n) / 2) % 2 == 1 ? 1.0 : -1.0;  // sin(m pi / 2) sin(n pi / 2)
      sum.M_centre += q / (k2 * k2) * pi * pi * (m * m + 0.3 * n * n) / (a * a) * sign;
      sum.Q_edge += q / k2 * m * pi / a * (n % 4 == 1 ? 1.0 : -1.0);
    }
  }
  return sum;
}

petsc::Vector solve(const System& system, Vec f, const std::vector<int>& held)
{
  petsc::Matrix K;
  petsc::check(MatDuplicate(system.K, MAT_COPY_VALUES, K.put()));
  petsc::Vector u;
  petsc::check(VecDuplicate(f, u.put()));
  petsc::check(VecSet(u, 0.0));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  std::vector<PetscInt> own;
  for (const int dof : held)
    if (dof >= first && dof < last) own.push_back(dof);
  petsc::check(MatZeroRowsColumns(K, static_cast<PetscInt>(own.size()), own.data(), 1e10, u, f));
  petsc::LinearSolver solver;
  petsc::check(KSPCreate(PETSC_COMM_WORLD, solver.put()));
  petsc::check(KSPSetOperators(solver, K, K));
  petsc::check(KSPSetType(solver, KSPPREONLY));
  PC pc = nullptr;
  petsc::check(KSPGetPC(solver, &pc));
  petsc::check(PCSetType(pc, PCCHOLESKY));
  petsc::check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  petsc::check(KSPSolve(solver, f, u));
  return u;
}

ShellResultants under_pressure(const Plate& plate)
{
  const int n_ranks = petsc::size(PETSC_COMM_WORLD);
  const System system =
      assemble(plate.mesh, std::vector{plate.section},
               make_dof_map(plate.mesh, {}, mesh::node_owners(plate.mesh, n_ranks), n_ranks),
               PETSC_COMM_WORLD);
  std::vector<Support> supports{{.group = "plate", .components = {0, 1, 5}}};  // no membrane
  for (const char* edge : {"left", "right"})
    supports.push_back({.group = edge, .components = {2, 3}});
  for (const char* edge : {"bottom", "top"})
    supports.push_back({.group = edge, .components = {2, 4}});
  const petsc::Vector f = load_vector(
      plate.mesh, system, std::vector<Load>{PressureLoad{.group = "plate", .pressure = p_0}});
  const petsc::Vector u = solve(system, f, held_dofs(plate.mesh, system.dofs, supports));
  return nodal_resultants(plate.mesh, plate.section, node_motions(system.dofs, u),
                          PETSC_COMM_WORLD);
}

/// @param t           thickness
/// @param tolerance_M of the moment at the centre
void expect_navier(double t, double tolerance_M, double tolerance_Q)
{
  const Plate plate = square(t, 8, 3);
  const ShellResultants result = under_pressure(plate);
  const Navier exact = navier();
  const int centre = mesh::find_group(plate.mesh, "centre").nodes[0];
  const auto& left = mesh::find_group(plate.mesh, "left").nodes;
  const int edge = left[left.size() / 2];
  // The pressure pushes along n, so the side of n is in tension.
  EXPECT_NEAR(result.M(centre, 0) / exact.M_centre, 1.0, tolerance_M) << t;
  EXPECT_NEAR(std::abs(result.Q(edge, 0)) / exact.Q_edge, 1.0, tolerance_Q) << t;
  EXPECT_NEAR(result.M(centre, 3) / exact.M_centre, 0.0, 1e-6) << t;  // symmetry
}

TEST(NodalResultants, OfAPlateUnderPressureAreThoseOfNavier)
{
  EXPECT_NEAR(navier().M_centre, 0.0479 * p_0 * a * a, 1e-4 * p_0);  // Timoshenko's table
  EXPECT_NEAR(navier().Q_edge, 0.338 * p_0 * a, 2e-3 * p_0);
  // Third differences of a cubic field on 8 elements; the series has 200 terms.
  expect_navier(0.1, 1e-3, 1e-2);
  expect_navier(0.001, 1e-3, 1e-2);
}

}  // namespace
}  // namespace chladni::plate
