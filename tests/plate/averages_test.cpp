// Averaging couplings, as the assembled system shows them.
#include "plate/dofs/couplings.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "coupled_models.hpp"
#include "plate/assembly/recovery.hpp"
#include "plate/dofs/free_motions.hpp"

namespace chladni::plate {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using testing::average;
using testing::disc_system;
using testing::error_of;
using testing::expect_words;
using testing::map_of;
using testing::plate;
using testing::random_motion;
using testing::rotation_energy;

TEST(GroupShares, AddUpToLengthsAreasAndNumbers)
{
  const mesh::Mesh mesh = plate();
  const auto sum = [&](const std::string& group) {
    double total = 0.0;
    for (const auto& [node, share] : group_shares(mesh, group)) total += share;
    return total;
  };
  constexpr double round_off = 1e-14;
  EXPECT_NEAR(sum("plate"), 2.0, round_off);
  EXPECT_NEAR(sum("right"), 1.0, round_off);
  EXPECT_NEAR(sum("top"), 2.0, round_off);
  EXPECT_EQ(sum("corner"), 1.0);
  // Simpson's rule on an edge of order 2: the middle of an edge of a third weighs 4 / 6 of it.
  const std::vector<int>& right = mesh::find_group(mesh, "right").nodes;
  EXPECT_NEAR(group_shares(mesh, "right").at(right[1]), 4.0 / 18.0, round_off);
}

TEST(Averages, AreTheRigidMotionThatFitsBest)
{
  const mesh::Mesh mesh = testing::small_disc();
  const System system = disc_system(mesh, {average("pad", "inner_edge")});
  const MatrixXd motions = node_motions(system.dofs, random_motion(system));
  const int reference = system.dofs.reference_node("pad").value();
  const auto position = [&](int node) { return system.dofs.position(node); };
  const Vector3d u_ref = motions.row(reference).head<3>();
  const Vector3d theta_ref = motions.row(reference).tail<3>();
  // What is left of the displacements has neither a mean nor a moment along the edge.
  Vector3d mean = Vector3d::Zero(), moment = Vector3d::Zero();
  for (const auto& [node, length] : group_shares(mesh, "inner_edge")) {
    const Vector3d r = position(node) - position(reference);
    const Vector3d rest =
        length / 0.157 * (motions.row(node).head<3>().transpose() - u_ref - theta_ref.cross(r));
    mean += rest;
    moment += r.cross(rest);
  }
  // Rotations are 1 / 0.025 m times displacements of order 1, solved for as combinations of 40
  // terms.
  EXPECT_LT(mean.norm(), 1e-10);
  EXPECT_LT(moment.norm(), 1e-10);
}

TEST(Averages, ChangeNeitherStiffnessNorMass)
{
  const mesh::Mesh mesh = testing::small_disc();
  const System free = disc_system(mesh, {});
  const System averaged = disc_system(mesh, {average("pad", "inner_edge")});
  PetscInt n_free = 0, n_averaged = 0;
  petsc::check(MatGetSize(free.K, &n_free, nullptr));
  petsc::check(MatGetSize(averaged.K, &n_averaged, nullptr));
  EXPECT_EQ(n_free, n_averaged);
  EXPECT_EQ(n_free_motions(free_parts(mesh, averaged.dofs, {})), 6);
  const double inertia = rotation_energy(free, free.M);
  EXPECT_NEAR(rotation_energy(averaged, averaged.M) / inertia, 1.0,
              1e-10);  // sums of cancelling terms
}

TEST(Averages, GiveTheReferenceNodeDofsOfItsOwn)
{
  const mesh::Mesh mesh = testing::small_disc();
  const DofMap map = map_of(mesh, {average("pad", "inner_edge")});
  const int reference = map.reference_node("pad").value();
  std::vector<int> dofs;
  int n_pivots = 0;
  for (int c = 0; c < 6; ++c) dofs.push_back(map.dof(reference, c).value());
  for (const int node : mesh::find_group(mesh, "inner_edge").nodes) {
    for (int c = 0; c < 6; ++c) {
      const auto dof = map.dof(node, c);
      if (!dof) ++n_pivots;
      EXPECT_TRUE(!dof || std::ranges::count(dofs, *dof) == 0);
    }
  }
  EXPECT_EQ(n_pivots, 6);
}

TEST(Averages, NameWhatTheyCannotDo)
{
  const mesh::Mesh mesh = plate();
  expect_words(error_of(mesh, {average("pad", "left")}), {"pad", "left", "one line"});
  expect_words(error_of(mesh, {average("pad", "corner")}), {"pad", "too few"});
  const mesh::Mesh disc = testing::small_disc();
  expect_words(error_of(disc, {average("a", "inner_edge"), average("b", "disc")}),
               {"coupling \"a\"", "coupling \"b\"", "in common"});
}

TEST(Averages, TakeNodesThatFollowARigidBody)
{
  mesh::Mesh mesh = testing::small_disc();
  mesh::Group both = mesh::find_group(mesh, "track");
  const std::vector<int> edge = mesh::find_group(mesh, "inner_edge").nodes;
  both.name = "both";
  both.nodes.insert(both.nodes.end(), edge.begin(), edge.end());
  mesh.groups.push_back(both);
  const System system =
      disc_system(mesh, {{.name = "hub", .group = "inner_edge"}, average("pad", "both")});
  const MatrixXd motions = node_motions(system.dofs, random_motion(system));
  Vector3d mean = Vector3d::Zero();
  double sum = 0.0;
  for (const auto& [node, share] : group_shares(mesh, "both")) {
    mean += share * motions.row(node).head<3>().transpose();
    sum += share;
  }
  mean /= sum;
  const int pad = system.dofs.reference_node("pad").value();
  EXPECT_LT((mean - motions.row(pad).head<3>().transpose()).norm(), 1e-10);
}

TEST(Averages, NeedAllComponents)
{
  const std::vector<Coupling> pad{average("pad", "inner_edge")};
  expect_words(
      error_of(testing::small_disc(), Kinematics{.couplings = pad, .components = {2, 3, 4}}),
      {"averaging", "all six DOFs", "rigid"});
}

}  // namespace
}  // namespace chladni::plate
