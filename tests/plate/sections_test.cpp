// Thickness and offset that vary, as the assembled system shows them.
#include "plate/sections/sections.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "coupled_models.hpp"
#include "plate/dofs/free_motions.hpp"

namespace chladni::plate {
namespace {

using testing::dofs_of;
using testing::energy;
using testing::expect_words;
using testing::link;
using testing::map_of;
using testing::material;
using testing::plate;
using testing::random_motion;
using testing::rotation_energy;

TEST(Profile, IsLinearBetweenItsPlacesAndConstantBeyond)
{
  const Profile t(Coordinate::radius, {1.0, 2.0, 4.0}, {0.5, 0.1, 0.3});
  EXPECT_EQ(value_at(t, {0.3, 0.4, 9.0}), 0.5);
  EXPECT_NEAR(value_at(t, {0.9, 1.2, 9.0}), 0.3, 1e-15);
  EXPECT_NEAR(value_at(t, {0.0, 3.0, 0.0}), 0.2, 1e-15);
  EXPECT_EQ(value_at(t, {5.0, 0.0, 0.0}), 0.3);
  EXPECT_EQ(value_at(0.02, {5.0, 0.0, 0.0}), 0.02);
}

TEST(Profile, IsAFormulaOfThePosition)
{
  const Profile t = Profile::by_formula("0.02 + 0.1 * (radius - 5)^2 + sin(angle) * z - x * y");
  const double exact = 0.02 + 0.1 * 0.0 + 0.8 * 7.0 - 12.0;  // radius 5, sin(angle) = 4 / 5
  EXPECT_NEAR(value_at(t, {3.0, 4.0, 7.0}), exact, 1e-14);
}

std::string formula_error(const std::string& text, const std::array<double, 3>& x)
{
  try {
    value_at(Profile::by_formula(text), x);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Profile, NamesAFormulaThatIsNone)
{
  expect_words(formula_error("0.02 * raduis", {1.0, 0.0, 0.0}), {"raduis", "radius"});
  expect_words(formula_error("0.02 *", {1.0, 0.0, 0.0}), {"0.02 *"});
  expect_words(formula_error("1 / z", {1.0, 0.0, 0.0}), {"1 / z", "inf", "(1, 0, 0)"});
}

TEST(Profile, RefusesADecimalCommaAmongArguments)
{
  expect_words(formula_error("max(0,02, x)", {1.0, 0.0, 0.0}), {"max(0,02, x)", "0.02"});
  expect_words(formula_error("max(1,2)", {1.0, 0.0, 0.0}), {"blank after the comma"});
  EXPECT_EQ(formula_error("max(0.02,0.01) + min(x,0.02,0.03)", {1.0, 0.0, 0.0}), "");
  expect_words(formula_error("max(0, 02, x)", {1.0, 0.0, 0.0}), {"begins with 0", "0.02"});
  expect_words(formula_error("min(1,5, x)", {1.0, 0.0, 0.0}), {"blank"});
  EXPECT_EQ(
      formula_error("max(0.02, 0.5 * x, 0, 1e-02, 100, x0 * 0)", {1.0, 0.0, 0.0}).find("comma"),
      std::string::npos);
}

TEST(Thickness, ByAFormulaIsThatOfTheTable)
{
  const mesh::Mesh mesh = plate();
  const auto system = [&](const Profile& thickness) {
    const ShellSection section{.group = "plate", .material = material, .thickness = thickness};
    return assemble(mesh, std::vector{section}, map_of(mesh, {}), PETSC_COMM_WORLD);
  };
  const System table = system({Coordinate::x, {0.0, 2.0}, {0.1, 0.3}});
  const System formula = system(Profile::by_formula("0.1 + 0.1 * x"));
  const petsc::Vector q = random_motion(table);
  EXPECT_NEAR(energy(formula.K, q) / energy(table.K, q), 1.0, 1e-12);  // round-off of sums
}

TEST(Thickness, ThatAFormulaMakesNegativeNamesTheNode)
{
  const mesh::Mesh mesh = plate();
  const ShellSection section{
      .group = "plate", .material = material, .thickness = Profile::by_formula("0.1 - 0.1 * x")};
  try {
    assemble(mesh, std::vector{section}, map_of(mesh, {}), PETSC_COMM_WORLD);
    FAIL() << "a thickness of zero is accepted";
  } catch (const Error& error) {
    expect_words(error.what(), {"plate", "0.1 - 0.1 * x", "node 5", "> 0"});
  }
}

/// A plate of linear thickness over x whose mid-surface is off its mesh.
System tapered(const mesh::Mesh& mesh)
{
  const ShellSection section{.group = "plate",
                             .material = material,
                             .thickness = {Coordinate::x, {0.0, 2.0}, {0.1, 0.3}},
                             .offset = {Coordinate::x, {0.0, 2.0}, {0.05, 0.15}}};
  return assemble(mesh, std::vector{section}, map_of(mesh, {}), PETSC_COMM_WORLD);
}

TEST(Offset, LeavesSixRigidMotions)
{
  const mesh::Mesh mesh = plate();
  EXPECT_EQ(n_free_motions(free_parts(mesh, tapered(mesh).dofs, {})), 6);
}

TEST(Offset, MovesTheMassWithTheMidSurface)
{
  const mesh::Mesh mesh = plate();
  const System system = tapered(mesh);
  // w = x - 2 y is a rotation by theta = (-2, -1, 0): points at height z move by (-z, 2 z, x - 2
  // y). With t = 0.1 (1 + x), and the lower face in the plane of the mesh: int z^2 dz = t^3 / 3.
  const auto integrand = [](double x, double y) {
    const double t = 0.1 * (1.0 + x);
    return 8000.0 * (5.0 * t * t * t / 3.0 + t * (x - 2.0 * y) * (x - 2.0 * y));
  };
  double exact = 0.0;  // Gauss with 3 points: degree 5 in x, 2 in y
  const std::array<double, 3> g{-std::sqrt(0.6), 0.0, std::sqrt(0.6)};
  const std::array<double, 3> w{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      exact += 0.5 * w[i] * w[j] * integrand(1.0 + g[i], 0.5 + 0.5 * g[j]);
  // The directors are normal to the mesh, the faces of the mid-surface are inclined by 0.05.
  EXPECT_NEAR(rotation_energy(system, system.M) / exact, 1.0, 1e-12);
}

/// The plate with a beam on its lower edge, whose nodes are those of the plate.
mesh::Mesh stiffened_plate()
{
  mesh::Mesh mesh = plate();
  const mesh::Group& edge = mesh::find_group(mesh, "bottom");
  mesh::ElementBlock line{.shape = mesh::Shape::line,
                          .order = static_cast<int>(edge.nodes.size()) - 1,
                          .nodes_per_element = static_cast<int>(edge.nodes.size()),
                          .numbers = {1000},
                          .nodes = edge.nodes,
                          .group = {static_cast<int>(&edge - mesh.groups.data())}};
  mesh.blocks.push_back(line);
  return mesh;
}

TEST(Offset, IsThatOfTheShellsAndNotOfBeamsAtTheirNodes)
{
  const BeamSection beam{
      .group = "bottom", .material = material, .area = 0.1, .I_y = 1e-3, .I_z = 1e-3, .J = 2e-3};
  const mesh::Mesh bare = plate(), stiffened = stiffened_plate();
  const auto energies = [&](double offset) {
    const ShellSection shell{
        .group = "plate", .material = material, .thickness = 0.1, .offset = offset};
    const System without =
        assemble(bare, {.shells = {&shell, 1}}, map_of(bare, {}), PETSC_COMM_WORLD);
    const System with = assemble(stiffened, {.shells = {&shell, 1}, .beams = {&beam, 1}},
                                 map_of(stiffened, {}), PETSC_COMM_WORLD);
    EXPECT_EQ(n_free_motions(free_parts(stiffened, with.dofs, {})), 6);
    return std::array{rotation_energy(without, without.M), rotation_energy(with, with.M)};
  };
  const auto [flat, flat_with] = energies(0.0);
  const auto [moved, moved_with] = energies(0.2);
  EXPECT_GT(moved, 1.05 * flat);
  EXPECT_NEAR((moved_with - moved) / (flat_with - flat), 1.0, 1e-12);  // round-off of sums
}

TEST(Offset, AndLinksAreThoseOfTheWholeModelWhereComponentsAreHeld)
{
  const mesh::Mesh mesh = plate();
  const ShellSection section{
      .group = "plate", .material = material, .thickness = 0.1, .offset = 0.03};
  const std::vector<Coupling> links{link("top", "bottom")};
  const System whole = assemble(mesh, std::vector{section}, map_of(mesh, links), PETSC_COMM_WORLD);
  const System part =
      assemble(mesh, std::vector{section},
               dofs_of(mesh, {.couplings = links, .components = {0, 2, 4}}), PETSC_COMM_WORLD);
  petsc::Vector q_whole, q_part;
  petsc::check(MatCreateVecs(whole.K, q_whole.put(), nullptr));
  petsc::check(MatCreateVecs(part.K, q_part.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(q_part, &first, &last));
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    for (const int c : part.dofs.components()) {
      const auto dof = part.dofs.dof(node, c);
      if (!dof || *dof < first || *dof >= last) continue;
      const double value = std::sin(double(node + 7 * c));
      petsc::check(VecSetValue(q_part, *dof, value, INSERT_VALUES));
      petsc::check(VecSetValue(q_whole, *whole.dofs.dof(node, c), value, INSERT_VALUES));
    }
  }
  for (Vec q : {Vec(q_whole), Vec(q_part)}) {
    petsc::check(VecAssemblyBegin(q));
    petsc::check(VecAssemblyEnd(q));
  }
  EXPECT_NEAR(energy(part.K, q_part) / energy(whole.K, q_whole), 1.0, 1e-12);  // round-off of sums
  EXPECT_NEAR(energy(part.M, q_part) / energy(whole.M, q_whole), 1.0, 1e-12);
}

}  // namespace
}  // namespace chladni::plate
