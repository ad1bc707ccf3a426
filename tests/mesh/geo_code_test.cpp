#include "mesh/gmsh_text.hpp"

#include <gtest/gtest.h>

#include "common/error.hpp"
#include "file_test.hpp"

namespace chladni::mesh {
namespace {

using Statements = std::vector<std::string>;

TEST(GeoCode, IsStatementsWithoutCommentsAndTexts)
{
  EXPECT_EQ(geo_statements("a = 1;// ; b\n\n  Point(1)\t= {0, /* ; */ 0};"),
            (Statements{"a = 1", "Point(1) = {0, 0}", ""}));
  EXPECT_EQ(geo_statements("Printf(\"Mesh 2; // no\");x"), (Statements{"Printf(\"\")", "x"}));
  EXPECT_EQ(geo_statements("a /* without end"), Statements{"a"});
  EXPECT_EQ(geo_statements("\"without end"), Statements{"\"\""});
  EXPECT_EQ(geo_statements(""), Statements{""});
}

TEST(GeoCode, HasWordsOutsideOfLongerOnes)
{
  const Statements code = geo_statements("lc_max = 2 * width;");
  EXPECT_TRUE(has_word(code, "width"));
  EXPECT_TRUE(has_word(code, "lc_max"));
  EXPECT_FALSE(has_word(code, "lc"));
  EXPECT_FALSE(has_word(code, "wid"));
  EXPECT_TRUE(has_word(geo_statements("widths = width;"), "width"));
}

TEST(GeoCode, KnowsTheCommandThatMeshes)
{
  EXPECT_TRUE(has_mesh_command(geo_statements("Mesh 2;")));
  EXPECT_TRUE(has_mesh_command(geo_statements("If (a)\nMesh\n2 ;\nEndIf")));
  EXPECT_FALSE(has_mesh_command(geo_statements("RefineMesh 2; Mesh.ElementOrder = 2;")));
}

TEST(GeoCode, KnowsWhereAlgorithm8IsSet)
{
  EXPECT_TRUE(sets_algorithm_8(geo_statements("Mesh.Algorithm=8 ;")));
  EXPECT_FALSE(
      sets_algorithm_8(geo_statements("Mesh.Algorithm = 6; a = 8; Mesh.Algorithm3D = 8;")));
  EXPECT_FALSE(sets_algorithm_8(geo_statements("Mesh.Algorithm = 88;")));
  const Statements of_a_surface = geo_statements("MeshAlgorithm  Surface {1, 2} = 8;");
  EXPECT_TRUE(sets_algorithm_8(of_a_surface));
  EXPECT_TRUE(sets_algorithm_8_of_a_surface(of_a_surface));
}

TEST(GeoCode, KnowsTheCommandsThatAct)
{
  EXPECT_EQ(acting_command(geo_statements("a = 1; SystemCall \"true\";")), "SystemCall");
  EXPECT_EQ(acting_command(geo_statements("If (a)\nSave \"a.msh\";\nEndIf")), "Save");
  EXPECT_EQ(acting_command(geo_statements("Printf(\"x\", 1) >> \"a.txt\";")), "Printf(...) > FILE");
  EXPECT_EQ(acting_command(geo_statements("Printf(\"a > b\", a > b);")), "");
  EXPECT_EQ(acting_command(geo_statements("// Save \"a.msh\";\nMesh.SaveAll = 1; Saved = 2;")), "");
}

TEST(GeoCode, MayHaveAMillionBlanksOrCharactersInAComment)
{
  const std::string million(1000000, ' ');
  EXPECT_EQ(geo_statements("a /*" + million + "*/ b" + million + "c"), Statements{"a b c"});
}

class MshText : public testing::FileTest {};

TEST_F(MshText, IsWholeWithAllItsSections)
{
  const auto said = [&](const std::string& text) -> std::string {
    try {
      check_msh_is_whole(write("a.msh", text));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::string whole =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n"
      "$Elements\n1\n1 15 2 1 1 1\n$EndElements\n";
  const std::string comments = "$Comments\nof a program\n$EndComments\n";
  EXPECT_EQ(said(whole), "");
  EXPECT_EQ(said(comments + whole), "");
  EXPECT_NE(said(comments).find("$MeshFormat is missing from its first line"), std::string::npos);
  EXPECT_NE(said("\n" + whole).find("$MeshFormat is missing"), std::string::npos);
  const auto without = [&](std::string text, const std::string& line) {
    return text.erase(text.find(line), line.size());
  };
  for (const std::string section : {"MeshFormat", "Nodes", "Elements"}) {
    const std::string cut = without(whole, "$End" + section + "\n");
    EXPECT_NE(said(cut).find("is cut off: $End" + section + " is missing"), std::string::npos)
        << said(cut);
    if (section == "MeshFormat") continue;
    EXPECT_NE(said(without(cut, "$" + section + "\n")).find("is cut off: $" + section + " is"),
              std::string::npos);
  }
  EXPECT_NE(said("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\r\n1\n").find("$EndEntities"),
            std::string::npos);
}

}  // namespace
}  // namespace chladni::mesh
