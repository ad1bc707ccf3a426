// Meshes that another process hands over, which may be in a stranger's hands.
#include "mesh/packed_mesh.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

#include "mesh/generators.hpp"

namespace chladni::mesh {
namespace {

Mesh disc()
{
  return annulus({.inner_radius = 0.1,
                  .outer_radius = 0.2,
                  .element_size = 0.05,
                  .element_order = 2,
                  .rings = {}});
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
  Mesh mesh = disc();
  change(mesh);
  return mesh;
}

TEST(PackedMesh, IsTheMesh)
{
  Mesh mesh = disc();
  mesh.notes = {"a note"};
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
      [](Mesh& m) { m.groups[0].dimension = 3; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i)
    EXPECT_THROW(unpacked(packed(with(changes[i]))), Error) << i;
}

TEST(PackedMesh, ThatIsCutOffIsRefused)
{
  const std::vector<char> whole = packed(disc());
  for (std::size_t n = 0; n < whole.size(); n += 97)
    EXPECT_THROW(unpacked({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n)}), Error);
  std::vector<char> longer = whole;
  longer.push_back(0);
  EXPECT_THROW(unpacked(longer), Error);
}

TEST(PackedMesh, OfDamagedBytesIsRefusedOrAMesh)
{
  const std::vector<char> whole = packed(disc());
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

}  // namespace
}  // namespace chladni::mesh
