// What users' meshes hold beside well-formed elements in one piece.
#include <gmsh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::add_rectangle;
using testing::error_of;
using testing::expect_words;
using testing::MeshFile;

TEST_F(MeshFile, ThatIsCutOffIsRefusedInEachFormat)
{
  for (const double format : {2.2, 4.1}) {
    for (const int binary : {0, 1}) {
      const std::string file = save("a.msh", [&] {
        add_rectangle(0, 20, "strip");
        gmsh::model::mesh::generate(2);
        gmsh::option::setNumber("Mesh.MshFileVersion", format);
        gmsh::option::setNumber("Mesh.Binary", binary);
      });
      EXPECT_EQ(error_of({.file = file}), "no error");
      const auto size = std::filesystem::file_size(file);
      for (const double part : {0.95, 0.7, 0.4, 0.1, 0.0}) {
        std::filesystem::resize_file(file, static_cast<std::uintmax_t>(part * double(size)));
        const std::string error = error_of({.file = file});
        EXPECT_NE(error.find("a.msh"), std::string::npos) << format << " " << part << " " << error;
        EXPECT_NE(error.find("missing"), std::string::npos)
            << format << " " << part << " " << error;
      }
    }
  }
}

TEST_F(MeshFile, OfSolidsOrCurvesOnlyIsRefused)
{
  const auto save_dimension = [&](int dimension) {
    return save("a.msh", [=] {
      gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1);
      gmsh::model::occ::synchronize();
      std::vector<std::pair<int, int>> entities;
      gmsh::model::getEntities(entities, dimension);
      std::vector<int> tags;
      for (const auto& [d, tag] : entities) tags.push_back(tag);
      gmsh::model::addPhysicalGroup(dimension, tags);
      gmsh::model::mesh::generate(dimension);
    });
  };
  expect_words(error_of({.file = save_dimension(3), .shell_groups = {"plate"}}),
               {"solid", " and 0 line", "mid-surface"});
  EXPECT_EQ(generate({.file = save_dimension(3)}).blocks.at(0).shape, Shape::tetrahedron)
      << "where no section says what it is";
  expect_words(error_of({.file = save_dimension(1)}), {"0 solid", "neither surface elements"});
}

TEST_F(MeshFile, WithCoincidentNodesIsRefusedMergedOrKept)
{
  const std::string file = save("a.msh", [] {
    add_rectangle(0, 3, "left");
    add_rectangle(1, 2, "right");
    gmsh::model::mesh::generate(2);
  });
  expect_words(error_of({.file = file}), {"2 and 5, 3 and 8", "coincident_nodes = \"merge\""});
  const Mesh kept = generate({.file = file, .coincident_nodes = Coincident::keep});
  EXPECT_EQ(kept.n_nodes(), 8 + 6);
  const Mesh merged = generate({.file = file, .coincident_nodes = Coincident::merge});
  EXPECT_EQ(merged.n_nodes(), 8 + 6 - 2);
  EXPECT_EQ(find_group(merged, "right").nodes.size(), 6u);
  expect_words(merged.notes.at(0), {"2 coincident nodes were merged"});
  expect_words(
      error_of({.file = file, .coincident_nodes = Coincident::merge, .merge_tolerance = 0.4}),
      {"element", "would collapse"});
}

TEST_F(MeshFile, OfSerendipityElementsIsCompleted)
{
  for (const int order : {2, 3}) {
    const std::string file = save("a.msh", [=] {
      add_rectangle(0, 3, "plate");
      gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 1);
      gmsh::model::mesh::generate(2);
      gmsh::model::mesh::setOrder(order);
    });
    const Mesh mesh = generate({.file = file});
    EXPECT_EQ(mesh.n_nodes(), (3 * order + 1) * (order + 1));
    EXPECT_EQ(find_group(mesh, "plate").nodes.size(), mesh.positions.size());
    ASSERT_FALSE(mesh.notes.empty());
    const ElementBlock& block = mesh.blocks.at(0);
    for (int e = 0; e < block.n_elements(); ++e) {
      const auto nodes = block.element_nodes(e);
      const auto& first = mesh.positions[nodes[0]];
      const auto& inner = mesh.positions[nodes[order + 2]];  // one step along each edge
      EXPECT_NEAR(std::abs(inner[0] - first[0]) * order, 1.0 / 3.0, 1e-11);
      EXPECT_NEAR(std::abs(inner[1] - first[1]) * order, 1.0, 1e-11);  // round-off in Gmsh
    }
  }
}

TEST_F(MeshFile, TellsOfAGroupThatNoElementUses)
{
  const std::string file = save("a.msh", [] {
    add_rectangle(0, 2, "plate");
    const int point = gmsh::model::geo::addPoint(5, 5, 0);
    gmsh::model::geo::synchronize();
    gmsh::model::setPhysicalName(0, gmsh::model::addPhysicalGroup(0, {point}), "lost");
    gmsh::model::mesh::generate(2);
  });
  const Mesh mesh = generate({.file = file});
  ASSERT_EQ(mesh.notes.size(), 1u);
  expect_words(mesh.notes[0], {"\"lost\"", "left out"});
}

}  // namespace
}  // namespace chladni::mesh
