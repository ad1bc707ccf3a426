#include "mesh/repetition.hpp"

#include <gtest/gtest.h>

#include "mesh/generators.hpp"
#include "mesh/sectors.hpp"

namespace chladni::mesh {
namespace {

AnnulusOptions disc(int sectors = 1)
{
  return {.inner_radius = 0.05,
          .outer_radius = 0.15,
          .element_size = 0.03,
          .element_order = 2,
          .rings = {{.name = "track", .radius = 0.1, .nodes = 16}},
          .pattern = Pattern::structured,
          .sectors = sectors};
}

TEST(Repetitions, OfAPlainDiscAreItsElementsAroundUnlessARingHasFewerNodes)
{
  AnnulusOptions plain = disc();
  plain.rings.clear();
  const Mesh mesh = annulus(plain);
  const int n_rows = mesh.blocks[0].n_elements() / n_repetitions(mesh);
  EXPECT_EQ(mesh.blocks[0].n_elements() % n_repetitions(mesh), 0);
  EXPECT_LE(n_rows, 5);
  EXPECT_EQ(n_repetitions(annulus(disc())), 16);
}

TEST(Repetitions, EndWhereANodeAnElementsGroupOrASetOfNodesDiffers)
{
  Mesh moved = annulus(disc());
  moved.positions[7][2] += 1e-4;
  EXPECT_EQ(n_repetitions(moved), 1);
  Mesh marked = annulus(disc());
  marked.groups.push_back({.name = "point", .dimension = 0, .nodes = {7}});
  EXPECT_EQ(n_repetitions(marked), 1);
  Mesh patched = annulus(disc());
  patched.groups.push_back({.name = "patch", .dimension = 2, .nodes = {}});
  patched.blocks[0].group[3] = static_cast<int>(patched.groups.size()) - 1;
  EXPECT_EQ(n_repetitions(patched), 1);
}

TEST(OneSector, OfAWholeDiscIsTheGeneratorsSector)
{
  const Mesh ours = one_sector(annulus(disc()), 16), theirs = annulus(disc(16));
  ASSERT_EQ(ours.n_nodes(), theirs.n_nodes());
  EXPECT_EQ(ours.sectors.count, 16);
  EXPECT_EQ(ours.sectors.pairs.size(), theirs.sectors.pairs.size());
  EXPECT_EQ(ours.blocks[0].n_elements(), theirs.blocks[0].n_elements());
  EXPECT_EQ(find_group(ours, "track").nodes.size(), find_group(theirs, "track").nodes.size());
  double top_ours = 0.0, top_theirs = 0.0;
  for (const auto& x : ours.positions) top_ours = std::max(top_ours, x[1]);
  for (const auto& x : theirs.positions) top_theirs = std::max(top_theirs, x[1]);
  EXPECT_NEAR(top_ours, top_theirs, 1e-12);
}

}  // namespace
}  // namespace chladni::mesh
