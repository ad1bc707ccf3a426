#include "plate/sections/sections.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "shell_model.hpp"
#include "tests/plate/elements/elements_under_test.hpp"

namespace chladni::plate::testing {
namespace {

using Eigen::Vector3d;
using mesh::Shape;

constexpr double degree = std::numbers::pi / 180.0;
const Material iron{.young = 1.85e11, .poisson = 0.3, .density = 7800.0};

/// 1 by 1 m, from the y axis at an angle about it.
Surface flap(double angle)
{
  return [=](double u, double v) { return Vector3d(u * std::cos(angle), v, u * std::sin(angle)); };
}

/// The sides of a prism with its edges at a radius of 1 m about y, 1 m high.
std::vector<Surface> prism(int n_sides)
{
  std::vector<Surface> sides;
  for (int i = 0; i < n_sides; ++i) {
    const auto corner = [=](int k) {
      const double angle = 2.0 * std::numbers::pi * k / n_sides;
      return Vector3d(std::cos(angle), 0.0, std::sin(angle));
    };
    sides.emplace_back([=](double u, double v) {
      return Vector3d((1.0 - u) * corner(i) + u * corner(i + 1) + v * Vector3d::UnitY());
    });
  }
  return sides;
}

/// r^T M r of a translation along x.
double mass_of(const ShellModel& model)
{
  Eigen::VectorXd r = Eigen::VectorXd::Zero(model.n_dofs());
  for (Eigen::Index i = 0; i < r.size(); i += 6) r[i] = 1.0;
  return r.dot(model.M * r);
}

NodeVectors directors_of(const ShellModel& model, int element, double thickness)
{
  const ShellSection section{.group = {}, .material = iron, .thickness = thickness};
  return shell_nodes(model.mesh, model.mesh.blocks[0], element, shell_directors(model.mesh),
                     section)
      .D;
}

class ElementAtFolds : public ::testing::TestWithParam<ElementUnderTest> {
 protected:
  static Grid grid(int n_u, int n_v)
  {
    const auto [shape, order] = GetParam();
    return {.shape = shape, .order = order, .n_u = n_u, .n_v = n_v};
  }
};

TEST_P(ElementAtFolds, HasTheMassOfItsFlatParts)
{
  constexpr double t = 0.05;
  for (const double angle : {1.0, 5.0, 15.0, 30.0, 39.0, 40.0, 41.0, 75.0, 90.0}) {
    for (const int n : {1, 3}) {
      // 1 and 0.5 m beside each other: the mean of normals by numbers would lean to one side.
      const ShellModel model =
          shell_model({flap(std::numbers::pi), flap(angle * degree)}, grid(n, 2), iron, t);
      EXPECT_NEAR(mass_of(model) / (2.0 * iron.density * t), 1.0, 1e-12) << angle << ", " << n;
    }
  }
}

TEST_P(ElementAtFolds, HasTheMassOfPrisms)
{
  constexpr double t = 0.02;
  for (const int n_sides : {9, 10, 12, 18, 36}) {
    for (const int n : {1, 2, 4}) {
      const ShellModel model = shell_model(prism(n_sides), grid(n, 1), iron, t);
      const double area = 2.0 * n_sides * std::sin(std::numbers::pi / n_sides);
      EXPECT_NEAR(mass_of(model) / (iron.density * t * area), 1.0, 1e-12) << n_sides << ", " << n;
    }
  }
}

TEST_P(ElementAtFolds, HasTheMassOfItsFlatPartsBelowTheThickness)
{
  // Faces of directors that lean to the folds would cross in elements shorter than the thickness.
  for (const double t : {0.1, 0.5, 2.0}) {
    const ShellModel model =
        shell_model({flap(std::numbers::pi), flap(35.0 * degree)}, grid(5, 2), iron, t);
    EXPECT_TRUE(Eigen::VectorXd(model.K.diagonal()).allFinite()) << t;
    EXPECT_NEAR(mass_of(model) / (2.0 * iron.density * t), 1.0, 1e-12) << t;
  }
}

TEST_P(ElementAtFolds, OfAPlateTakesNoNormalOfAVane)
{
  for (int turn = 0; turn < 15; ++turn) {
    const double angle = std::array{90.0, 60.0, 30.0, 15.0, 5.0}[std::size_t(turn / 3)];
    std::vector<Surface> order{flap(std::numbers::pi), flap(0.0), flap(angle * degree)};
    std::rotate(order.begin(), order.begin() + turn % 3, order.end());  // whichever is first
    const ShellModel model = shell_model(order, grid(2, 2), iron, 0.1);
    for (int e = 0; e < model.mesh.blocks[0].n_elements(); ++e) {
      const NodeVectors x = element_positions(model.mesh, model.mesh.blocks[0], e);
      const bool is_vane = x.col(2).maxCoeff() > 1e-9;
      const double lean = is_vane ? angle * degree : 0.0;
      const Vector3d normal(-std::sin(lean), 0.0, std::cos(lean));
      const NodeVectors D = directors_of(model, e, 0.1);
      EXPECT_NEAR((D * normal).cwiseAbs().minCoeff(), 0.05, 1e-12) << angle << ", " << e;
      EXPECT_LT(D.rowwise().norm().maxCoeff(), 0.05 + 1e-12) << angle << ", " << e;
    }
  }
}

TEST_P(ElementAtFolds, MeetsItsNeighbourInOneDirectorBelowTheLimitAlone)
{
  for (const double angle : {20.0, 39.9, 40.1, 60.0}) {
    const ShellModel model =
        shell_model({flap(std::numbers::pi), flap(angle * degree)}, grid(1, 1), iron, 0.1);
    const mesh::ElementBlock& block = model.mesh.blocks[0];
    const NodeVectors first = directors_of(model, 0, 0.1),
                      last = directors_of(model, block.n_elements() - 1, 0.1);
    for (int i = 0; i < block.nodes_per_element; ++i) {
      for (int j = 0; j < block.nodes_per_element; ++j) {
        if (block.element_nodes(0)[i] != block.element_nodes(block.n_elements() - 1)[j]) continue;
        const double distance =
            std::min((first.row(i) - last.row(j)).norm(), (first.row(i) + last.row(j)).norm());
        if (angle < 40.0) {
          EXPECT_LT(distance, 1e-12) << angle;
        } else
          EXPECT_GT(distance, 0.01) << angle;
      }
    }
  }
}

TEST_P(ElementAtFolds, HoldTwiceWhatARibHasWithinAPlate)
{
  const Surface left = [](double u, double v) { return Vector3d(u - 1.0, v, 0.0); };
  const auto overlap_of = [&](const std::vector<Surface>& surfaces, double offset) {
    ShellModel model = shell_model(surfaces, grid(2, 3), iron, 0.05);
    model.mesh.groups = {{.name = "plate", .dimension = 2, .nodes = {}},
                         {.name = "rib", .dimension = 2, .nodes = {}}};
    mesh::ElementBlock& block = model.mesh.blocks[0];
    const int n_of_plate = 2 * block.n_elements() / int(surfaces.size());
    for (int e = 0; e < block.n_elements(); ++e) block.group[e] = e < n_of_plate ? 0 : 1;
    const std::vector<ShellSection> sections{
        {.group = "plate", .material = iron, .thickness = 0.06, .offset = offset},
        {.group = "rib", .material = iron, .thickness = 0.02}};
    return rib_overlap(model.mesh, sections);
  };
  for (const double angle : {90.0, 60.0, 135.0}) {
    const std::vector<Surface> joint{left, flap(0.0), flap(angle * degree)};
    const double of_rib = iron.density * 0.02 / std::sin(angle * degree);
    const RibOverlap found = overlap_of(joint, 0.0);
    EXPECT_NEAR(found.twice, 0.03 * of_rib, 1e-9) << angle;
    EXPECT_NEAR(found.mass, iron.density * (2.0 * 0.06 + 0.02), 1e-9) << angle;
    // A plate that is drawn at its face towards the rib, or away from it.
    EXPECT_NEAR(overlap_of(joint, -0.03).twice, 0.0, 1e-9) << angle;
    EXPECT_NEAR(overlap_of(joint, 0.03).twice, 0.06 * of_rib, 1e-9) << angle;
  }
  // What is missing outside a corner is what is there twice inside it.
  EXPECT_EQ(overlap_of({left, flap(90.0 * degree), flap(90.0 * degree)}, 0.0).twice, 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, ElementAtFolds, ::testing::ValuesIn(elements_under_test()),
                         element_name);

Vector3d radial(double angle)
{
  return {std::cos(angle), std::sin(angle), 0.0};
}

/// A twelfth of a prism of twelve sides about z, from one of these points to the next.
enum class From { middle_of_a_side, fold };
mesh::Mesh sector_of_prism(int order, From from)
{
  const double r = std::cos(15.0 * degree);
  const auto side = [](const Vector3d& a, const Vector3d& b) -> Surface {
    return
        [=](double u, double v) { return Vector3d((1.0 - u) * a + u * b + v * Vector3d::UnitZ()); };
  };
  std::vector<Surface> sides{side(radial(0.0), radial(30.0 * degree))};
  if (from == From::middle_of_a_side) {
    sides = {side(r * radial(0.0), radial(15.0 * degree)),
             side(radial(15.0 * degree), r * radial(30.0 * degree))};
  }
  ShellModel model = shell_model(
      sides, {.shape = Shape::quadrilateral, .order = order, .n_u = 1, .n_v = 2}, iron, 0.05);
  model.mesh.sectors.count = 12;
  const Eigen::AngleAxisd turn(30.0 * degree, Vector3d::UnitZ());
  for (int a = 0; a < model.mesh.n_nodes(); ++a)
    for (int b = 0; b < model.mesh.n_nodes(); ++b)
      if ((turn * model.position(a) - model.position(b)).norm() < 1e-9)
        model.mesh.sectors.pairs.push_back({a, b});
  return model.mesh;
}

TEST(Directors, OfASectorAreThoseOfTheWhole)
{
  for (const From from : {From::middle_of_a_side, From::fold}) {
    for (const int order : {1, 2, 3}) {
      const mesh::Mesh sector = sector_of_prism(order, from);
      EXPECT_EQ(std::ssize(sector.sectors.pairs), 2 * order + 1);
      const Directors directors = shell_directors(sector);
      for (const auto& [low, high] : sector.sectors.pairs) {
        EXPECT_NEAR(std::abs(directors.common.row(low).dot(radial(0.0))), 1.0, 1e-12);
        EXPECT_NEAR(std::abs(directors.common.row(high).dot(radial(30.0 * degree))), 1.0, 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace chladni::plate::testing
