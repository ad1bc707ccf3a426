#include "mesh/read_mesh.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "mesh/generators.hpp"
#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

namespace fs = std::filesystem;

const std::string cached_square_geo =
    "Point(1) = {0, 0, 0, 0.5}; Point(2) = {1, 0, 0, 0.5}; Point(3) = {1, 1, 0, 0.5};\n"
    "Point(4) = {0, 1, 0, 0.5};\n"
    "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
    "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n";

class MeshCache : public testing::MeshFile {
 protected:
  std::string folder() const { return path("kept/meshes"); }
  std::vector<fs::path> files() const
  {
    if (!fs::exists(folder())) return {};
    return {fs::directory_iterator(folder()), fs::directory_iterator()};
  }
  MeshOptions disc(double element_size) const
  {
    return {.annulus = AnnulusOptions{.inner_radius = 0.1,
                                      .outer_radius = 0.2,
                                      .element_size = element_size,
                                      .rings = {{.name = "ring", .radius = 0.15, .nodes = 12}}},
            .cache = folder()};
  }
  /// The mesh that `kept_mesh` gives, and whether it made it.
  static std::pair<Mesh, bool> made(const MeshOptions& options)
  {
    bool is_made = false;
    Mesh mesh = kept_mesh(options, [&] {
      is_made = true;
      MeshOptions without = options;
      without.cache.reset();
      return draft(without);
    });
    return {std::move(mesh), is_made};
  }
};

TEST_F(MeshCache, GivesTheMeshThatWasMade)
{
  const auto [first, is_first_made] = made(disc(0.03));
  const auto [second, is_second_made] = made(disc(0.03));
  EXPECT_TRUE(is_first_made);
  EXPECT_FALSE(is_second_made);
  EXPECT_EQ(checksum(first), checksum(second));
  ASSERT_EQ(first.groups.size(), second.groups.size());
  for (std::size_t g = 0; g < first.groups.size(); ++g) {
    EXPECT_EQ(first.groups[g].name, second.groups[g].name);
    EXPECT_EQ(first.groups[g].nodes, second.groups[g].nodes);
  }
  testing::expect_words(first.notes.back(), {"the mesh is kept in", folder()});
  testing::expect_words(second.notes.back(), {"the mesh is the one kept in", folder()});
}

TEST_F(MeshCache, IsUsedByGenerators)
{
  EXPECT_EQ(checksum(generate(disc(0.03))), checksum(generate(disc(0.03))));
  EXPECT_EQ(files().size(), 1);
}

TEST_F(MeshCache, FindsNoMeshOfAnotherGmsh)
{
  write("libgmsh.so", "one version");
  int n_made = 0;
  const auto make = [&] {
    ++n_made;
    MeshOptions without = disc(0.03);
    without.cache.reset();
    Mesh mesh = draft(without);
    EXPECT_TRUE(fs::exists(mesh.made_by)) << mesh.made_by;
    EXPECT_NE(mesh.made_by.find("libgmsh"), std::string::npos);
    mesh.made_by = path("libgmsh.so");
    return mesh;
  };
  kept_mesh(disc(0.03), make);
  kept_mesh(disc(0.03), make);
  EXPECT_EQ(n_made, 1);
  write("libgmsh.so", "another version");
  kept_mesh(disc(0.03), make);
  EXPECT_EQ(n_made, 2);
  fs::remove(path("libgmsh.so"));
  kept_mesh(disc(0.03), make);
  EXPECT_EQ(n_made, 3);
}

TEST_F(MeshCache, FindsNoMeshOfOtherOptions)
{
  made(disc(0.03));
  EXPECT_TRUE(made(disc(0.031)).second);
  MeshOptions other = disc(0.03);
  other.annulus->rings[0].name = "another";
  EXPECT_TRUE(made(other).second);
  other = disc(0.03);
  other.annulus->edge_row = 0.01;
  EXPECT_TRUE(made(other).second);
  EXPECT_EQ(files().size(), 4);
}

TEST_F(MeshCache, FindsNoMeshOfAChangedFile)
{
  MeshOptions options{
      .file = write("a.geo", cached_square_geo), .element_order = 1, .cache = folder()};
  EXPECT_TRUE(made(options).second);
  EXPECT_FALSE(made(options).second);
  write("a.geo", cached_square_geo + "// another\n");
  EXPECT_TRUE(made(options).second);
  options.element_order = 2;
  EXPECT_TRUE(made(options).second);
}

TEST_F(MeshCache, KeepsNothingThatOtherFilesDecideOn)
{
  write("b.geo", "lc = 0.5;\n");
  MeshOptions options{.file = write("a.geo", "Include \"b.geo\";\n" + cached_square_geo),
                      .element_order = 1,
                      .trust = Trust::owner};
  options.cache = folder();
  for (const Trust trust : {Trust::owner, Trust::stranger}) {
    options.trust = trust;
    testing::expect_words(kept_mesh(options, [] { return Mesh{}; }).notes.back(),
                          {"a.geo", "is not kept"});
  }
  options.trust = Trust::stranger;
  options.file =
      write("c.geo", cached_square_geo + "Field[1] = Structured; Field[1].FileName = \"b\";\n");
  testing::expect_words(kept_mesh(options, [] { return Mesh{}; }).notes.back(), {"is not kept"});
  EXPECT_TRUE(files().empty());
}

TEST_F(MeshCache, MakesADamagedMeshAnew)
{
  const std::string whole = checksum(made(disc(0.03)).first);
  const fs::path file = files().at(0);
  const auto size = fs::file_size(file);
  fs::resize_file(file, size - 1);
  EXPECT_TRUE(made(disc(0.03)).second);
  EXPECT_EQ(fs::file_size(file), size);
  std::fstream(file, std::ios::in | std::ios::out).seekp(static_cast<long>(size) / 2) << "damage";
  const auto [mesh, is_made] = made(disc(0.03));
  EXPECT_TRUE(is_made);
  EXPECT_EQ(checksum(mesh), whole);
  std::ofstream(file) << "chladni mesh 1\n";
  EXPECT_TRUE(made(disc(0.03)).second);
}

TEST_F(MeshCache, SaysThatItCannotKeep)
{
  MeshOptions options = disc(0.03);
  options.cache = write("no_folder", "a file") + "/below";
  testing::expect_words(made(options).first.notes.back(), {"could not be kept"});
}

}  // namespace
}  // namespace chladni::mesh
