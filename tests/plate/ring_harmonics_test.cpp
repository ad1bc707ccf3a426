// A ring in its harmonics, as the assembled system shows it.
#include "plate/dofs/dof_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "coupled_models.hpp"
#include "mesh/generators.hpp"
#include "plate/assembly/recovery.hpp"

namespace chladni::plate {
namespace {

using Eigen::MatrixXd;
using testing::dofs_of;
using testing::energy;
using testing::expect_words;
using testing::map_of;
using testing::random_motion;

std::string ring_error(const mesh::Mesh& mesh, const std::vector<Coupling>& couplings,
                       const std::vector<RingHarmonics>& rings)
{
  return testing::error_of(mesh, {.couplings = couplings, .rings = rings});
}

System harmonic_disc(const mesh::Mesh& mesh, int up_to)
{
  const std::vector<RingHarmonics> rings{{"track", up_to}};
  return assemble(mesh, testing::section,
                  dofs_of(mesh, {.couplings = testing::hub, .rings = rings}), PETSC_COMM_WORLD);
}

/// The motion of all nodes in the coordinates of a system in which each has DOFs of its own.
petsc::Vector coordinates_of(const System& plain, const MatrixXd& motions)
{
  petsc::Vector q;
  petsc::check(MatCreateVecs(plain.K, q.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(q, &first, &last));
  for (int node = 0; node < plain.dofs.n_nodes(); ++node) {
    for (int c = 0; c < 6; ++c) {
      const auto dof = plain.dofs.dof(node, c);
      if (!dof || *dof < first || *dof >= last) continue;
      petsc::check(VecSetValue(q, *dof, motions(node, c), INSERT_VALUES));
    }
  }
  petsc::check(VecAssemblyBegin(q));
  petsc::check(VecAssemblyEnd(q));
  return q;
}

TEST(RingHarmonics, AreAnotherBasisOfTheSameSpace)
{
  const mesh::Mesh mesh = testing::small_disc();
  const System plain =
      assemble(mesh, testing::section, map_of(mesh, testing::hub), PETSC_COMM_WORLD);
  const System disc = harmonic_disc(mesh, 3);
  ASSERT_EQ(disc.dofs.n_dofs(), plain.dofs.n_dofs());
  const petsc::Vector c = random_motion(disc);
  const petsc::Vector u = coordinates_of(plain, node_motions(disc.dofs, c));
  double c_norm = 0.0, u_norm = 0.0;
  petsc::check(VecNorm(c, NORM_2, &c_norm));
  petsc::check(VecNorm(u, NORM_2, &u_norm));
  EXPECT_NEAR(u_norm, c_norm, 1e-12 * c_norm);  // F is orthogonal
  // Sums of some 1e4 terms in another order.
  EXPECT_NEAR(energy(disc.K, c) / energy(plain.K, u), 1.0, 1e-11);
  EXPECT_NEAR(energy(disc.M, c) / energy(plain.M, u), 1.0, 1e-11);
}

TEST(RingHarmonics, OfTheDisplacementAlongTheRadiusAreUniformAndOfTheAxisTilted)
{
  const mesh::Mesh mesh = testing::small_disc();
  const System disc = harmonic_disc(mesh, 3);
  const HarmonicRing& ring = disc.dofs.harmonic_rings().at(0);
  EXPECT_EQ(ring.n_wanted(), 7);
  const auto motion_of = [&](int k, int component) {  // of the ring by one unit of a coordinate
    petsc::Vector q;
    petsc::check(MatCreateVecs(disc.K, q.put(), nullptr));
    PetscInt first = 0, last = 0;
    petsc::check(VecGetOwnershipRange(q, &first, &last));
    const PetscInt dof = disc.dofs.dof_of_number(ring.numbers[std::size_t(k)], component).value();
    if (dof >= first && dof < last) petsc::check(VecSetValue(q, dof, 1.0, INSERT_VALUES));
    petsc::check(VecAssemblyBegin(q));
    petsc::check(VecAssemblyEnd(q));
    return node_motions(disc.dofs, q);
  };
  const MatrixXd breathing = motion_of(0, 0), tilt = motion_of(1, 2), twist = motion_of(4, 4);
  for (const int node : ring.nodes) {
    const Eigen::Vector3d x = disc.dofs.position(node);
    const double cosine = x[0] / 0.13, sine = x[1] / 0.13;
    // sqrt(1 / 12) e_r; sqrt(2 / 12) cos(phi) e_z; sqrt(2 / 12) sin(2 phi) e_t as rotation. The
    // mesh is good to 1e-9.
    EXPECT_NEAR(breathing(node, 0), cosine / std::sqrt(12.0), 1e-8);
    EXPECT_NEAR(breathing(node, 1), sine / std::sqrt(12.0), 1e-8);
    EXPECT_NEAR(tilt(node, 2), cosine / std::sqrt(6.0), 1e-8);
    EXPECT_NEAR(twist(node, 3), -2.0 * sine * cosine * sine / std::sqrt(6.0), 1e-8);
    EXPECT_NEAR(twist(node, 4), 2.0 * sine * cosine * cosine / std::sqrt(6.0), 1e-8);
  }
}

TEST(RingHarmonics, RefuseWhatIsNoFreeRing)
{
  const mesh::Mesh mesh = testing::small_disc();
  const std::vector<Coupling>& hub = testing::hub;
  EXPECT_EQ(ring_error(mesh, hub, {{"track", 6}}), "");
  expect_words(ring_error(mesh, hub, {{"track", 7}}),
               {"ring \"track\"", "harmonics = 7", "12 nodes", "1 to 6"});
  expect_words(ring_error(mesh, hub, {{"inner_edge", 2}}), {"\"inner_edge\"", "follow \"hub\""});
  expect_words(ring_error(mesh, hub, {{"rim", 2}}), {"\"rim\"", "track"});
  expect_words(ring_error(mesh, hub, {{"disc", 2}}),
               {"\"disc\"", "not equally spaced on a circle"});
  expect_words(ring_error(mesh, hub, {{"hub", 1}}), {"\"hub\"", "1 nodes"});
  expect_words(ring_error(mesh, {testing::average("pad", "track")}, {{"track", 2}}),
               {"\"track\"", "coupling"});
  expect_words(ring_error(mesh, hub, {{"track", 2}, {"track", 2}}), {"follow \"track\""});
}

TEST(RingHarmonics, NeedAllComponents)
{
  const std::vector<RingHarmonics> rings{{"track", 2}};
  const std::string error =
      testing::error_of(testing::small_disc(), {.components = {2, 3, 4}, .rings = rings});
  expect_words(error, {"\"track\"", "all six DOFs"});
}

TEST(RingHarmonics, NeedNodesThatAreEquallySpaced)
{
  mesh::Mesh mesh = testing::small_disc();
  const int node = mesh::find_group(mesh, "track").nodes[3];
  const auto [x, y, z] = mesh.positions[node];
  mesh.positions[node] = {x - 1e-4 * y, y + 1e-4 * x, z};  // along the circle
  expect_words(ring_error(mesh, testing::hub, {{"track", 2}}),
               {"\"track\"", "not equally spaced", "off its place"});
}

}  // namespace
}  // namespace chladni::plate
