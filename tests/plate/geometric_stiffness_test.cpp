#include "plate/assembly/geometric_stiffness.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "common/petsc.hpp"
#include "mesh/extrude.hpp"
#include "plate/assembly/assemble.hpp"
#include "small_disc.hpp"

namespace chladni::plate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The load of a spin of 1 rad/s about z: f = (x, y, 0) dm.
MassLoad spin_about_z()
{
  MassLoad load = MassLoad::Zero();
  load[3] = load[7] = 1.0;
  return load;
}

/// Of every node a motion (u, theta), in the rows of the system.
using Motion = std::function<Eigen::Matrix<double, 6, 1>(const Vector3d& x)>;

petsc::Vector sampled(const System& system, const Motion& motion)
{
  petsc::Vector v;
  petsc::check(MatCreateVecs(system.K, v.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(v, &first, &last));
  for (int node = 0; node < system.dofs.n_nodes(); ++node) {
    const Eigen::Matrix<double, 6, 1> values = motion(system.dofs.position(node));
    for (int c = 0; c < 6; ++c) {
      const auto dof = system.dofs.dof(node, c);
      if (!dof || *dof < first || *dof >= last) continue;
      petsc::check(VecSetValue(v, *dof, values[c], INSERT_VALUES));
    }
  }
  petsc::check(VecAssemblyBegin(v));
  petsc::check(VecAssemblyEnd(v));
  return v;
}

double form(Mat A, Vec v)
{
  petsc::Vector product;
  petsc::check(VecDuplicate(v, product.put()));
  petsc::check(MatMult(A, v, product));
  double value = 0.0;
  petsc::check(VecDot(v, product, &value));
  return value;
}

/// A disc on a rigid hub, held there, that answers the load on its mass.
struct HeldDisc {
  mesh::Mesh mesh = testing::small_disc();
  std::vector<ShellSection> sections;
  std::vector<SolidSection> solids;
  std::vector<PointMass> masses;
  Structure structure;
  System system;

  HeldDisc(double offset, std::vector<PointMass> lumped)
      : sections(with_offset(offset)),
        masses(std::move(lumped)),
        structure{.shells = sections, .masses = masses},
        system(assembled())
  {}
  /// Of solids, of shells' order and thickness.
  HeldDisc(int order, double poisson)
      : mesh(solid_disc(order)),
        solids{{.group = "disc", .material = {9.15915e10, poisson, 6300.0}}},
        structure{.solids = solids},
        system(assembled())
  {}
  HeldDisc(const HeldDisc&) = delete;
  HeldDisc& operator=(const HeldDisc&) = delete;

  static std::vector<ShellSection> with_offset(double offset)
  {
    std::vector<ShellSection> sections = testing::section;
    sections[0].offset = offset;
    return sections;
  }
  static mesh::Mesh solid_disc(int order)
  {
    return mesh::extruded(mesh::annulus({.inner_radius = 0.025,
                                         .outer_radius = 0.162,
                                         .element_size = 0.03,
                                         .element_order = order}),
                          {.from = -0.01, .to = 0.01}, {});
  }
  System assembled() const
  {
    const int n = petsc::size(PETSC_COMM_WORLD);
    return assemble(mesh, structure,
                    make_dof_map(mesh, {.couplings = testing::hub}, mesh::node_owners(mesh, n), n),
                    PETSC_COMM_WORLD);
  }
  MassModel model() const { return mass_model(mesh, structure, system.dofs, PETSC_COMM_WORLD); }

  petsc::Vector displacements(const MassLoad& load) const
  {
    const petsc::Matrix columns = mass_moments(model()).displacement;
    petsc::Vector f, u;
    petsc::check(MatCreateVecs(system.K, u.put(), f.put()));
    for (PetscInt j = 0; j < 12; ++j) {
      Vec column = nullptr;
      petsc::check(MatDenseGetColumnVecRead(columns, j, &column));
      petsc::check(VecAXPY(f, load[j], column));
      petsc::check(MatDenseRestoreColumnVecRead(columns, j, &column));
    }
    petsc::Matrix K;
    petsc::check(MatDuplicate(system.K, MAT_COPY_VALUES, K.put()));
    const int hub = *system.dofs.reference_node("hub");
    std::array<PetscInt, 6> held{};
    for (int c = 0; c < 6; ++c) held[std::size_t(c)] = *system.dofs.dof(hub, c);
    petsc::check(VecSet(u, 0.0));
    const double stiff = 1e15;  // in place of an infinite one
    petsc::check(MatZeroRowsColumns(K, 6, held.data(), stiff, u, f));
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
  petsc::Matrix stiffness(const MassLoad& load) const
  {
    return geometric_stiffness(model(), displacements(load), load);
  }
};

/// What a dead load does on a rigid rotation about the origin to second order:
/// -int f . theta x (theta x x) dm.
double work_on(const MassMoments& moments, const MassLoad& load, const Vector3d& theta)
{
  const Matrix3d T = theta * theta.transpose() - theta.squaredNorm() * Matrix3d::Identity();
  const Matrix3d c = load.tail<9>().reshaped(3, 3);
  // f = c_0 + c x
  return -load.head<3>().dot(T * moments.first) - (c.transpose() * T * moments.second).trace();
}

/// Any load in the plane of the disc: its own plane is not bent by it.
MassLoad in_plane()
{
  MassLoad load = MassLoad::Zero();
  load.head<2>() << 0.02, -0.03;
  load[3] = 1.0;  // x e_x
  load[4] = 0.7;  // x e_y
  load[6] = -0.2;
  load[7] = 0.4;
  return load;
}

TEST(GeometricStiffness, OfARigidRotationIsTheSecondOrderOfTheLoadsWork)
{
  // What differs is the error of the mesh.
  const PointMass at_hub{.at = "hub", .mass = 0.3, .offset = {0.04, 0.02, 0.03}};
  const PointMass at_followers{.at = "inner_edge", .mass = 0.02, .offset = {0.0, 0.01, 0.02}};
  for (const double offset : {0.0, 0.012}) {
    const HeldDisc disc(offset, {at_hub, at_followers});
    const MassMoments moments = mass_moments(disc.model());
    for (const MassLoad& load : {spin_about_z(), in_plane()}) {
      const petsc::Matrix K = disc.stiffness(load);
      const double size = work_on(moments, load, {0, 0, 1});
      for (const Vector3d& theta :
           {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(0.5, -0.3, 0.4)}) {
        const petsc::Vector v = sampled(disc.system, [&](const Vector3d& x) {
          Eigen::Matrix<double, 6, 1> motion;
          motion << theta.cross(x), theta;
          return motion;
        });
        EXPECT_NEAR(form(K, v), work_on(moments, load, theta), 2e-4 * size)
            << theta.transpose() << ", " << offset;
      }
    }
  }
}

TEST(GeometricStiffness, OfSolidsIsExactInARigidRotation)
{
  for (const int order : {1, 2, 3}) {
    const HeldDisc disc(order, 0.3);
    const MassMoments moments = mass_moments(disc.model());
    for (const MassLoad& load : {spin_about_z(), in_plane()}) {
      const petsc::Matrix K = disc.stiffness(load);
      for (const Vector3d& theta :
           {Vector3d(1, 0, 0), Vector3d(0, 0, 1), Vector3d(0.5, -0.3, 0.4)}) {
        const petsc::Vector v = sampled(disc.system, [&](const Vector3d& x) {
          Eigen::Matrix<double, 6, 1> motion;
          motion << theta.cross(x), theta;
          return motion;
        });
        // Round-off of the static solution.
        EXPECT_NEAR(form(K, v), work_on(moments, load, theta),
                    1e-9 * work_on(moments, load, {0, 0, 1}))
            << theta.transpose() << ", order " << order;
      }
    }
  }
}

TEST(GeometricStiffness, DoesNotResistTranslations)
{
  const HeldDisc disc(0.012, {{.at = "hub", .mass = 0.3, .offset = {0.04, 0.02, 0.03}}});
  const petsc::Matrix K = disc.stiffness(spin_about_z());
  const petsc::Vector v = sampled(disc.system, [](const Vector3d&) {
    return Eigen::Matrix<double, 6, 1>(1.0, -2.0, 0.5, 0.0, 0.0, 0.0);
  });
  petsc::Vector forces;
  petsc::check(VecDuplicate(v, forces.put()));
  petsc::check(MatMult(K, v, forces));
  double largest = 0.0, size = 0.0;
  petsc::check(VecNorm(forces, NORM_INFINITY, &largest));
  petsc::check(MatNorm(K, NORM_INFINITY, &size));
  EXPECT_LT(largest, 1e-12 * size);
}

/// Radial and circumferential stress over the density of an annulus whose inner edge is held, per
/// (rad/s)^2: sigma_r = A + B / r^2 - (3 + nu) r^2 / 8, sigma_t = A - B / r^2 - (1 + 3 nu) r^2 / 8.
struct AnnulusStress {
  double A, B, nu;

  AnnulusStress(double a, double b, double poisson) : A(0), B(0), nu(poisson)
  {
    // sigma_r(b) = 0; E u / r = sigma_t - nu sigma_r = 0 at a.
    const double at_b = (3.0 + nu) * b * b / 8.0;
    const double at_a = (1.0 - nu * nu) * a * a / 8.0;
    // A + B / b^2 = at_b;  (1 - nu) A - (1 + nu) B / a^2 = at_a
    B = ((1.0 - nu) * at_b - at_a) / ((1.0 + nu) / (a * a) + (1.0 - nu) / (b * b));
    A = at_b - B / (b * b);
  }
  double radial(double r) const { return A + B / (r * r) - (3.0 + nu) * r * r / 8.0; }
  double hoop(double r) const { return A - B / (r * r) - (1.0 + 3.0 * nu) * r * r / 8.0; }
};

void expect_stress_of_annulus(const HeldDisc& disc, double poisson)
{
  const double a = 0.025, b = 0.162, h = 0.02, rho = 6300.0;
  const AnnulusStress stress(a, b, poisson);
  const petsc::Matrix K = disc.stiffness(spin_about_z());
  for (const int n : {2, 3}) {
    // w = (r - a)^2 r^(n-2) cos(n phi): at rest with its slopes at the hub. Sections do not turn.
    const auto radius = [&](double r) { return (r - a) * (r - a) * std::pow(r, n - 2); };
    const auto slope = [&](double r) {
      return (r - a) * std::pow(r, n - 3) * (2.0 * r + (n - 2) * (r - a));
    };
    const petsc::Vector v = sampled(disc.system, [&](const Vector3d& x) {
      const double r = std::hypot(x.x(), x.y());
      Eigen::Matrix<double, 6, 1> motion = Eigen::Matrix<double, 6, 1>::Zero();
      if (r > 0.5 * a) motion[2] = radius(r) * std::cos(n * std::atan2(x.y(), x.x()));
      return motion;
    });
    // pi rho h int (sigma_r w'^2 + sigma_t n^2 w^2 / r^2) r dr
    double expected = 0.0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
      const double r = a + (b - a) * (i + 0.5) / steps, w = radius(r), w_r = slope(r);
      expected += (stress.radial(r) * w_r * w_r + stress.hoop(r) * n * n * w * w / (r * r)) * r *
                  (b - a) / steps;
    }
    expected *= std::numbers::pi * rho * h;
    // Cubic elements of 30 mm, two at the hub where the stress falls as 1 / r^2.
    EXPECT_NEAR(form(K, v), expected, 2e-3 * expected) << n;
  }
}

TEST(GeometricStiffness, OfASpinningDiscIsThatOfTheStressOfAnAnnulus)
{
  expect_stress_of_annulus(HeldDisc(0.0, std::vector<PointMass>{}), 0.3);
  expect_stress_of_annulus(HeldDisc(3, 0.0), 0.0);  // without contraction a solid is plane
}

}  // namespace
}  // namespace chladni::plate
