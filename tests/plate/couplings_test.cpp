// Links and chains of couplings, and what stands at the nodes that they move.
#include "plate/dofs/couplings.hpp"

#include <gtest/gtest.h>

#include "coupled_models.hpp"
#include "plate/assembly/recovery.hpp"
#include "plate/dofs/point_elements.hpp"

namespace chladni::plate {
namespace {

using testing::average;
using testing::disc_system;
using testing::energy;
using testing::error_of;
using testing::expect_words;
using testing::link;
using testing::map_of;
using testing::plate;
using testing::random_motion;

TEST(Links, FollowTheirNearestNodes)
{
  const mesh::Mesh mesh = plate();
  const DofMap map = map_of(mesh, {link("top", "bottom")});
  for (const int node : mesh::find_group(mesh, "top").nodes) {
    ASSERT_TRUE(map.is_dependent(node));
    EXPECT_EQ(map.arm(node), Eigen::Vector3d(0.0, 1.0, 0.0));
  }
}

TEST(Links, LeadThroughRigidCouplingsToTheirEnd)
{
  const mesh::Mesh mesh = plate();
  const DofMap map = map_of(mesh, {link("top", "bottom"), {.name = "base", .group = "bottom"}});
  for (const int node : mesh::find_group(mesh, "top").nodes) {
    EXPECT_EQ(map.reference(node), map.reference_node("base"));
    EXPECT_NEAR(map.arm(node)[1], 1.0, 1e-15);
  }
}

TEST(Links, NameBothCouplingsOfAConflict)
{
  const mesh::Mesh mesh = plate();
  expect_words(error_of(mesh, {link("top", "bottom"), {.name = "base", .group = "top"}}),
               {"two couplings", "link of \"top\" to \"bottom\"", "coupling \"base\""});
  expect_words(error_of(mesh, {link("top", "bottom"), link("bottom", "top")}),
               {"circle", "link of \"top\" to \"bottom\"", "link of \"bottom\" to \"top\""});
  expect_words(error_of(mesh, {link("right", "centre")}), {"both nearest", "pair"});
  expect_words(error_of(mesh, {link("corner", "top")}), {"belongs to both groups"});
  expect_words(error_of(mesh, {link("right", "rim")}), {"rim", "bottom"});
}

TEST(PointElements, ActOnTheMotionOfAverages)
{
  const mesh::Mesh mesh = testing::small_disc();
  const std::vector<Coupling> couplings{average("pad", "inner_edge"), link("track", "outer_edge")};
  const std::array<double, 6> k{1e9, 2e9, 3e9, 4e5, 5e5, 6e5}, c{1, 2, 3, 4, 5, 6};
  const PointMass mass{.at = "pad", .mass = 50.0, .inertia = {1, 2, 3}, .offset = {0, 0.1, 0.2}};
  const Spring ground{.at = "pad", .stiffness = k, .damping = c};
  const System plain = disc_system(mesh, couplings);
  const System with =
      assemble(mesh, {.shells = testing::section, .masses = {&mass, 1}, .springs = {&ground, 1}},
               map_of(mesh, couplings), PETSC_COMM_WORLD);
  const petsc::Vector q = random_motion(with);
  const int pad = with.dofs.reference_node("pad").value();
  const Eigen::Vector<double, 6> u = node_motions(with.dofs, q).row(pad);
  const auto of = [&](const std::array<double, 6>& d) {
    return u.dot(Eigen::Map<const Eigen::Vector<double, 6>>(d.data()).asDiagonal() * u);
  };
  // Differences of sums whose terms are larger: K of the disc has entries of 1e11.
  EXPECT_NEAR((energy(with.K, q) - energy(plain.K, q)) / of(k), 1.0, 1e-6);
  EXPECT_NEAR((energy(with.M, q) - energy(plain.M, q)) / u.dot(point_mass_matrix(mass) * u), 1.0,
              1e-10);
  EXPECT_NEAR(energy(with.C, q) / of(c), 1.0, 1e-10);
}

}  // namespace
}  // namespace chladni::plate
