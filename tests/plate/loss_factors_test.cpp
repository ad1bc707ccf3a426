// Structural damping: H is the sum of eta_e K_e over elements and springs.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "mesh/generators.hpp"
#include "mesh/partition.hpp"
#include "plate/assembly/assemble.hpp"

namespace chladni::plate {
namespace {

const Material steel{.young = 2e11, .poisson = 0.3, .density = 7800.0, .loss_factor = 0.02};

mesh::Mesh plate_mesh()
{
  return mesh::annulus({.inner_radius = 0.05,
                        .outer_radius = 0.1,
                        .element_size = 0.02,
                        .element_order = 2,
                        .rings = {},
                        .pattern = mesh::Pattern::structured});
}

mesh::Mesh beam_mesh()
{
  return mesh::beam({.start = {0, 0, 0},
                     .end = {2, 0, 0},
                     .elements = 4,
                     .element_size = {},
                     .points = {{.name = "middle", .distance = 1.0}}});
}

System system_of(const mesh::Mesh& mesh, const Structure& structure)
{
  const int n_ranks = petsc::size(PETSC_COMM_WORLD);
  return assemble(mesh, structure,
                  make_dof_map(mesh, {}, mesh::node_owners(mesh, n_ranks), n_ranks),
                  PETSC_COMM_WORLD);
}

/// Largest entry of A - factor B over that of A.
double difference(Mat A, double factor, Mat B)
{
  petsc::Matrix D;
  petsc::check(MatDuplicate(A, MAT_COPY_VALUES, D.put()));
  petsc::check(MatAXPY(D, -factor, B, DIFFERENT_NONZERO_PATTERN));
  double of_difference = 0.0, of_A = 0.0;
  petsc::check(MatNorm(D, NORM_INFINITY, &of_difference));
  petsc::check(MatNorm(A, NORM_INFINITY, &of_A));
  return of_difference / of_A;
}

std::vector<BeamSection> beams(double of_material, std::optional<double> of_section)
{
  return {{.group = "beam",
           .material = {.young = 2e5, .poisson = 0.25, .density = 7.0, .loss_factor = of_material},
           .area = 0.01,
           .I_y = 1e-4,
           .I_z = 1e-4,
           .J = 2e-4,
           .loss_factor = of_section}};
}

TEST(LossFactors, OfOneMaterialAreItsMultipleOfTheStiffness)
{
  const std::vector<ShellSection> shells{
      {.group = "disc", .material = steel, .thickness = 0.01, .offset = 0.002}};
  const System system = system_of(plate_mesh(), {.shells = shells});
  ASSERT_NE(Mat(system.H), nullptr);
  EXPECT_LT(difference(system.H, 0.02, system.K), 1e-13);
}

TEST(LossFactors, WithoutAnyAreNoMatrix)
{
  Material undamped = steel;
  undamped.loss_factor = 0.0;
  const std::vector<ShellSection> shells{
      {.group = "disc", .material = undamped, .thickness = 0.01}};
  EXPECT_EQ(Mat(system_of(plate_mesh(), {.shells = shells}).H), nullptr);
}

TEST(LossFactors, OfASectionStandInPlaceOfThoseOfItsMaterial)
{
  const mesh::Mesh mesh = beam_mesh();
  const System lossy = system_of(mesh, {.beams = beams(0.02, 0.3)});
  EXPECT_LT(difference(lossy.H, 0.3, lossy.K), 1e-13);
  EXPECT_EQ(Mat(system_of(mesh, {.beams = beams(0.02, 0.0)}).H), nullptr);
}

TEST(LossFactors, OfSpringsAddToThoseOfElements)
{
  const mesh::Mesh mesh = beam_mesh();
  const std::array<double, 6> k{0, 0, 5e3, 0, 0, 0};
  const std::vector<Spring> springs{{.at = "middle", .stiffness = k, .loss_factor = 0.5},
                                    {.at = "start", .to = "end", .stiffness = k}};
  const auto all = beams(0.02, {});
  const System without = system_of(mesh, {.beams = all});
  const System with = system_of(mesh, {.beams = all, .springs = springs});
  const std::vector<Spring> first(springs.begin(), springs.begin() + 1);
  const System first_alone = system_of(mesh, {.beams = all, .springs = first});
  // H = 0.02 K_beam + 0.5 K_spring, and the second spring has none.
  petsc::Matrix expected;
  petsc::check(MatDuplicate(without.K, MAT_COPY_VALUES, expected.put()));
  petsc::check(MatScale(expected, 0.02 - 0.5));
  petsc::check(MatAXPY(expected, 0.5, first_alone.K, DIFFERENT_NONZERO_PATTERN));
  EXPECT_LT(difference(with.H, 1.0, expected), 1e-12);
}

}  // namespace
}  // namespace chladni::plate
