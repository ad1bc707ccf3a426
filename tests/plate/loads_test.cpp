#include "plate/assembly/assemble.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "mesh/partition.hpp"
#include "plate/dofs/dof_map.hpp"
#include "small_disc.hpp"
#include "square_plate.hpp"

namespace chladni::plate {
namespace {

const Material steel_like_material{.young = 2e11, .poisson = 0.3, .density = 8000.0};
const std::vector<int> six_components{0, 1, 2, 3, 4, 5};

/// A mesh of one section and its system, without couplings unless given.
struct Model {
  mesh::Mesh mesh;
  System system;
};

Model model_of(mesh::Mesh mesh, const ShellSection& section,
               const std::vector<Coupling>& couplings = {})
{
  const int n = petsc::size(PETSC_COMM_WORLD);
  DofMap map = make_dof_map(mesh, {.couplings = couplings}, mesh::node_owners(mesh, n), n);
  System system = assemble(mesh, std::vector{section}, std::move(map), PETSC_COMM_WORLD);
  return {.mesh = std::move(mesh), .system = std::move(system)};
}

Model plate_model()
{
  return model_of(testing::rectangle({.a = 2.0, .b = 1.0, .n_x = 4, .n_y = 3, .order = 2}),
                  {.group = "plate", .material = steel_like_material, .thickness = 0.05});
}

Model disc_with_hub()
{
  return model_of(testing::small_disc(), testing::section[0], testing::hub);
}

/// Force and moment about the origin of a load vector, [6], on every rank.
std::array<double, 6> resultant(const Model& model, Vec f)
{
  std::array<double, 6> sum{};
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(f, &first, &last));
  const PetscScalar* values = nullptr;
  petsc::check(VecGetArrayRead(f, &values));
  const DofMap& dofs = model.system.dofs;
  for (int node = 0; node < dofs.n_nodes(); ++node) {
    const auto dof = dofs.dof(node, 0);
    if (!dof || *dof < first || *dof >= last) continue;
    const Eigen::Vector3d x = dofs.position(node);
    const PetscScalar* q = values + (*dof - first);
    for (int c = 0; c < 3; ++c) {
      const int a = (c + 1) % 3, b = (c + 2) % 3;
      sum[c] += q[c];
      sum[3 + c] += q[3 + c] + x[a] * q[b] - x[b] * q[a];
    }
  }
  petsc::check(VecRestoreArrayRead(f, &values));
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 6, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return sum;
}

void expect_near(const std::array<double, 6>& actual, const std::array<double, 6>& expected,
                 double tolerance)
{
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance) << c;
}

std::array<double, 6> resultant_of(const Model& model, const Load& load)
{
  return resultant(model, load_vector(model.mesh, model.system, std::vector{load}));
}

constexpr double round_off = 1e-12;  // of sums of some hundred terms of order one

TEST(LoadVector, SharesANodalLoadEqually)
{
  const Load load = NodalLoad{.group = "right", .force = {3.0, 0.0, -1.0}, .moment = {0.5, 0, 0}};
  // -1 N on the edge at x = 2 about (0, 0): moments x f_z = 2 about y and -y f_z about x.
  expect_near(resultant_of(plate_model(), load), {3.0, 0.0, -1.0, 0.5 - 0.5, 2.0, -1.5}, round_off);
}

TEST(LoadVector, IntegratesALineLoadOverTheEdge)
{
  const Load load = EdgeLoad{.group = "right", .line_force = {0.0, 0.0, 4.0}};
  expect_near(resultant_of(plate_model(), load), {0.0, 0.0, 4.0, 2.0, -8.0, 0.0}, round_off);
}

TEST(LoadVector, CountsAnEdgeBetweenTwoElementsOnce)
{
  const Load load = EdgeLoad{.group = "middle", .line_force = {0.0, 0.0, 4.0}};
  expect_near(resultant_of(plate_model(), load), {0.0, 0.0, 4.0, 2.0, -4.0, 0.0}, round_off);
}

TEST(LoadVector, PushesPressureAlongTheNormals)
{
  const Load load = PressureLoad{.group = "plate", .pressure = 10.0};
  expect_near(resultant_of(plate_model(), load), {0.0, 0.0, 20.0, 10.0, -20.0, 0.0}, 1e-11);
}

TEST(LoadVector, WeighsTheBodyWithItsCouplings)
{
  const Model disc = disc_with_hub();
  const double area = std::numbers::pi * (0.162 * 0.162 - 0.025 * 0.025);
  const double weight = 6300.0 * 0.02 * area * 9.81;
  const auto force = resultant_of(disc, GravityLoad{.acceleration = {0.0, -9.81, 0.0}});
  EXPECT_NEAR(force[1], -weight, 1e-5 * weight);      // arcs, as above
  EXPECT_NEAR(force[3], 0.0, 1e-5 * weight * 0.162);  // through the centre
}

TEST(LoadVector, MovesForcesOnDependentNodesToTheirReference)
{
  const Model disc = disc_with_hub();
  const Load load = NodalLoad{.group = "inner_edge", .force = {0.0, 0.0, 5.0}};
  expect_near(resultant_of(disc, load), {0.0, 0.0, 5.0, 0.0, 0.0, 0.0}, round_off);
}

TEST(LoadVector, NamesWhatIsThereForAnUnknownGroup)
{
  const Model plate = plate_model();
  const auto message = [&](const Load& load) -> std::string {
    try {
      load_vector(plate.mesh, plate.system, std::vector{load});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(NodalLoad{.group = "rigth"}).find("right"), std::string::npos);
  EXPECT_NE(message(EdgeLoad{.group = "centre", .line_force = {}}).find("no edge"),
            std::string::npos);
  EXPECT_NE(message(PressureLoad{.group = "right", .pressure = 1.0})
                .find("neither shell elements nor faces"),
            std::string::npos);
}

TEST(HeldDofs, AreTheComponentsOfTheGroupsOnce)
{
  const Model plate = plate_model();
  const std::vector<int> held =
      held_dofs(plate.mesh, plate.system.dofs,
                std::vector<Support>{{.group = "left", .components = {0, 2}},
                                     {.group = "bottom", .components = {2}}});
  // 7 nodes on the left edge, 9 on the lower one, one of them on both.
  EXPECT_EQ(held.size(), 7u * 2u + 8u);
  EXPECT_TRUE(std::ranges::is_sorted(held));
}

TEST(HeldDofs, NameTheCouplingThatANodeFollows)
{
  const Model disc = disc_with_hub();
  try {
    held_dofs(disc.mesh, disc.system.dofs,
              std::vector<Support>{{.group = "inner_edge", .components = {0}}});
    FAIL() << "a dependent node was held";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("\"hub\" instead"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace chladni::plate
