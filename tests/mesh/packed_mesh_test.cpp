// Meshes that another process hands over, which may be in a stranger's hands.
#include "mesh/mesh_archive.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "mesh/generators.hpp"

namespace chladni::mesh {
namespace {

const Mesh& packed_disc()
{
  static const Mesh made = annulus({.inner_radius = 0.1,
                                    .outer_radius = 0.2,
                                    .element_size = 0.05,
                                    .element_order = 2,
                                    .rings = {}});
  return made;
}

std::vector<char> packed(const Mesh& mesh)
{
  Packer packer;
  pack(packer, mesh);
  return packer.bytes();
}

Mesh unpacked(const std::vector<char>& bytes)
{
  Unpacker unpacker(bytes);
  return unpack_mesh(unpacker);
}

/// The mesh with one thing in it changed.
Mesh with(const std::function<void(Mesh&)>& change)
{
  Mesh mesh = packed_disc();
  change(mesh);
  return mesh;
}

TEST(Packing, OfAnotherKindIsRefused)
{
  Packer packer;
  packer.all(1.0, std::vector<double>{1.0});
  const auto unpack = [&]<typename... Kinds>(Kinds... values) {
    Unpacker unpacker(packer.bytes());
    unpacker.all(values...);
  };
  unpack(0.0, std::vector<double>{});
  EXPECT_THROW(unpack(std::int64_t{0}, std::vector<double>{}), Error);
  EXPECT_THROW(unpack(0.0, std::vector<std::int64_t>{}), Error);
  EXPECT_THROW(unpack(0.0, std::string()), Error);
  EXPECT_THROW(unpack(std::optional<double>{}, std::vector<double>{}), Error);
}

TEST(PackedMesh, IsTheMesh)
{
  Mesh mesh = packed_disc();
  mesh.notes = {"a note"};
  mesh.equations = {{"line 7", {{0, 2, 1.0}, {1, 5, -0.5}}}};
  const Mesh back = unpacked(packed(mesh));
  EXPECT_EQ(checksum(back), checksum(mesh));
  EXPECT_EQ(back.node_numbers, mesh.node_numbers);
  EXPECT_EQ(back.notes, mesh.notes);
  ASSERT_EQ(back.groups.size(), mesh.groups.size());
  EXPECT_EQ(back.groups.back().name, mesh.groups.back().name);
  EXPECT_EQ(back.groups.back().nodes, mesh.groups.back().nodes);
  ASSERT_EQ(back.blocks.size(), mesh.blocks.size());
  EXPECT_EQ(back.blocks[0].numbers, mesh.blocks[0].numbers);
  EXPECT_EQ(back.blocks[0].group, mesh.blocks[0].group);
}

TEST(PackedMesh, IsRefusedWhenItsPartsDoNotFit)
{
  const std::vector<std::function<void(Mesh&)>> changes{
      [](Mesh& m) { m.blocks[0].nodes[5] = m.n_nodes(); },
      [](Mesh& m) { m.blocks[0].nodes[5] = -1; },
      [](Mesh& m) { m.blocks[0].group[0] = static_cast<int>(m.groups.size()); },
      [](Mesh& m) { m.blocks[0].group[0] = -2; },
      [](Mesh& m) { m.blocks[0].group.pop_back(); },
      [](Mesh& m) { m.blocks[0].numbers.pop_back(); },
      [](Mesh& m) { m.blocks[0].nodes_per_element = 0; },
      [](Mesh& m) { m.blocks[0].order = 1 << 30; },
      [](Mesh& m) { m.blocks[0].shape = static_cast<Shape>(7); },
      [](Mesh& m) { m.node_numbers.pop_back(); },
      [](Mesh& m) { m.node_numbers[0] = -1; },
      [](Mesh& m) { m.positions[3][1] = std::numeric_limits<double>::infinity(); },
      [](Mesh& m) { m.groups[0].nodes[0] = m.n_nodes(); },
      [](Mesh& m) { m.groups[0].dimension = 4; },
      [](Mesh& m) {
        m.equations = {{"line 7", {}}};
      },
      [](Mesh& m) {
        m.equations = {{"line 7", {{m.n_nodes(), 0, 1.0}}}};
      },
      [](Mesh& m) {
        m.equations = {{"line 7", {{0, 6, 1.0}}}};
      },
  };
  for (std::size_t i = 0; i < changes.size(); ++i)
    EXPECT_THROW(unpacked(packed(with(changes[i]))), Error) << i;
}

TEST(PackedMesh, ThatIsCutOffIsRefused)
{
  const std::vector<char> whole = packed(packed_disc());
  for (std::size_t n = 0; n < whole.size(); n += 97)
    EXPECT_THROW(unpacked({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n)}), Error);
  std::vector<char> longer = whole;
  longer.push_back(0);
  EXPECT_THROW(unpacked(longer), Error);
}

TEST(PackedMesh, OfDamagedBytesIsRefusedOrAMesh)
{
  const std::vector<char> whole = packed(packed_disc());
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    std::vector<char> bytes = whole;
    for (int k = 0; k < 4; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    try {
      const Mesh mesh = unpacked(bytes);
      EXPECT_FALSE(checksum(mesh).empty());
    } catch (const Error&) {
    }
  }
}

MeshOptions unpacked_options(const std::vector<char>& bytes)
{
  Unpacker unpacker(bytes);
  MeshOptions options = unpack_options(unpacker);
  EXPECT_TRUE(unpacker.at_end());
  return options;
}

std::vector<char> packed(const MeshOptions& options)
{
  Packer packer;
  pack(packer, options);
  return packer.bytes();
}

/// Every number is another one, so that two that are exchanged show.
std::vector<MeshOptions> options_of_all_kinds()
{
  const std::vector<RingOptions> rings{{.name = "a", .radius = 0.31, .nodes = 32, .z = 0.33},
                                       {.name = "b", .radius = 0.34, .nodes = 35}};
  return {{.annulus = AnnulusOptions{0.11, 0.12, 0.13, 4, rings, Pattern::triangles, 0.14, 15}},
          {.hat_disc = HatDiscOptions{0.11, 0.12, 0.13, 0.14, 0.15, 0.16, 0.17, 0.18, 2, rings,
                                      Pattern::unstructured, 0.19, BoltOptions{5, 0.21, 0.22}, 3}},
          {.pad = PadOptions{0.11, 0.12, 0.13, 0.14, 0.15, 2, Pattern::triangles, 0.16}},
          {.rectangle = RectangleOptions{0.11, 0.12, 0.13, 4, Pattern::unstructured, 0.14}},
          {.beam = BeamMeshOptions{{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, 7, 0.8, {{"p", 0.9}}, 2}},
          {.file = "disc.geo",
           .element_order = 2,
           .element_size = 0.1,
           .size_factor = 0.2,
           .sizes = {{{0.3, 0.4, 0.5}, 0.6}},
           .parameters = {{"h", 0.7}},
           .length_unit = 0.001,
           .groups = {{"g", {"surface_1", "surface_2"}}},
           .rings = rings,
           .line_groups = {"l"},
           .shell_groups = {"s", "t"}}};
}

TEST(PackedOptions, AreTheOptions)
{
  for (const MeshOptions& options : options_of_all_kinds()) {
    const std::vector<char> bytes = packed(options);
    EXPECT_EQ(packed(unpacked_options(bytes)), bytes);
  }
  const MeshOptions disc = unpacked_options(packed(options_of_all_kinds()[0]));
  ASSERT_TRUE(disc.annulus.has_value());
  EXPECT_EQ(disc.annulus->outer_radius, 0.12);
  EXPECT_EQ(disc.annulus->rings[0].z, 0.33);
  EXPECT_EQ(disc.annulus->rings[1].z, std::nullopt);
  EXPECT_EQ(disc.annulus->pattern, Pattern::triangles);
  EXPECT_EQ(disc.annulus->sectors, 15);
  EXPECT_FALSE(disc.hat_disc.has_value());
  const MeshOptions hat = unpacked_options(packed(options_of_all_kinds()[1]));
  EXPECT_EQ(hat.hat_disc.value().bolts.value().hole_radius, 0.22);
}

}  // namespace
}  // namespace chladni::mesh
