// What a stranger's mesh file may not do, and how those end that make Gmsh crash, loop or swell.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::error_of;
using testing::expect_words;
using testing::MeshFile;

const std::string square_geo =
    "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};\n"
    "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
    "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n";

/// Two quadrilaterals, with a place for the nodes' numbers.
std::string msh_with_node(const std::string& number)
{
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n" + number +
         " 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n1\n1 3 2 1 1 " + number +
         " 2 3 4\n$EndElements\n";
}

class HostileFile : public MeshFile {
 protected:
  std::string trace() const { return path("trace"); }
  /// GEO code that leaves the trace.
  std::string system_call() const { return "SystemCall \"touch " + trace() + "\";\n"; }
  bool has_left_a_trace() const { return std::filesystem::exists(trace()); }

  void expect_refused(const MeshOptions& options, const std::vector<std::string>& words) const
  {
    expect_words(error_of(options), words);
    EXPECT_FALSE(has_left_a_trace());
  }
};

TEST_F(HostileFile, DoesWhatItWantsForItsOwner)
{
  const std::string file = write("a.geo", square_geo + system_call());
  EXPECT_EQ(error_of({.file = file, .trust = Trust::owner}), "no error");
  EXPECT_TRUE(has_left_a_trace());
}

TEST_F(HostileFile, StartsNoProgram)
{
  const std::vector<std::string> words{"a.geo", "SystemCall", "--trust-mesh"};
  expect_refused({.file = write("a.geo", square_geo + system_call())}, words);
  expect_refused({.file = write("a.geo", square_geo + "NonBlocking" + system_call())},
                 {"NonBlockingSystemCall"});
}

TEST_F(HostileFile, StartsNoProgramThatItsTextHides)
{
  write("hidden.txt", system_call());
  const std::vector<std::string> words{"a.geo", "start a program", "--trust-mesh"};
  expect_refused({.file = write("a.geo", square_geo + "Merge \"hidden.txt\";\n")}, words);
  expect_refused({.file = write("a.geo", square_geo + "Include \"hidden.txt\";\n")}, words);
  write("hidden.msh", system_call());
  expect_refused({.file = write("a.geo", square_geo + "Merge \"hidden.msh\";\n")}, words);
}

TEST_F(HostileFile, WritesNoFile)
{
  for (const std::string& code :
       {"Save \"" + trace() + ".msh\";\n", "Printf(\"x\") > \"" + trace() + "\";\n",
        "Printf(\"x\") >> \"" + trace() + "\";\n"}) {
    expect_refused({.file = write("a.geo", square_geo + code)}, {"a.geo", "--trust-mesh"});
    write("hidden.txt", code);
    expect_refused({.file = write("a.geo", square_geo + "Include \"hidden.txt\";\n")},
                   {"a.geo", "write a file"});
    EXPECT_FALSE(std::filesystem::exists(trace() + ".msh"));
  }
}

TEST_F(HostileFile, IsNoMeshWithoutItsHeader)
{
  expect_refused({.file = write("a.msh", system_call())}, {"a.msh", "$MeshFormat"});
  expect_refused({.file = write("a.msh", system_call() + msh_with_node("1"))},
                 {"a.msh", "$MeshFormat"});
  expect_refused({.file = write("a.msh", "// $MeshFormat\n" + system_call() + msh_with_node("1"))},
                 {"a.msh", "$MeshFormat"});
}

TEST_F(HostileFile, BringsNoOptionsAlong)
{
  write("a.msh.opt", system_call());
  expect_refused({.file = write("a.msh", msh_with_node("1"))}, {"a.msh.opt", "Gmsh would obey"});
  write("b.geo.opt", system_call());
  expect_refused({.file = write("b.geo", square_geo)}, {"b.geo.opt", "Gmsh would obey"});
}

TEST_F(HostileFile, IsNotCommandedByTheNamesAroundIt)
{
  const std::string folder = path("x\";SystemCall \"touch trace\";\"");
  std::filesystem::create_directories(folder);
  const std::string geo = "DefineConstant[ n = 3 ];\n" + square_geo;
  const std::string name = std::filesystem::path(folder).filename().string() + "/a.geo";
  expect_refused({.file = write(name, geo), .parameters = {{"n", 4.0}}}, {"quote"});
  EXPECT_FALSE(std::filesystem::exists("trace"));
  expect_refused({.file = write("a.geo", geo), .parameters = {{"n; " + system_call(), 4.0}}},
                 {"a.geo", "parameter"});
}

TEST_F(HostileFile, HasNoAbsurdNodeNumbers)
{
  EXPECT_EQ(error_of({.file = write("a.msh", msh_with_node("1"))}), "no error");
  for (const char* number : {"-1", "0", "-7", "999999999999"})
    expect_words(error_of({.file = write("a.msh", msh_with_node(number))}), {"a.msh", number});
}

TEST_F(HostileFile, ThatNeverEndsIsEnded)
{
  const auto begin = std::chrono::steady_clock::now();
  const std::string code = square_geo + "For i In {1:1000000000}\nx = i;\nEndFor\n";
  expect_words(error_of({.file = write("a.geo", code), .most_seconds = 1.0}),
               {"a.geo", "within 1 s", "--trust-mesh"});
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(taken.count(), 10.0);
}

TEST_F(HostileFile, ThatGmshCrashesOnEndsInASentence)
{
#ifdef CHLADNI_SANITIZED
  const char* crash = "Gmsh crashed on it";  // the sanitizer makes an exit of the signal
#else
  const char* crash = "Gmsh crashed on it (Segmentation fault)";
#endif
  std::string disc = "Mesh.Algorithm = 8;\nPoint(100) = {0, 0, 0};\n";
  for (int i = 1; i <= 60; ++i) {
    const std::string n = std::to_string(i), angle = "(2 * Pi * " + n + " / 60)";
    disc += "Point(" + n + ") = {Cos" + angle + ", Sin" + angle + ", 0, 0.1};\n";
  }
  for (int i = 1; i <= 60; ++i) {
    const std::string n = std::to_string(i);
    disc += "Line(" + n + ") = {" + n + ", " + std::to_string(i % 60 + 1) + "};\n";
  }
  write("disc.txt", disc + "Curve Loop(1) = {1:60}; Plane Surface(1) = {1};\nMesh 2;\n");
  const std::string error = error_of({.file = write("a.geo", "Include \"disc.txt\";\n")});
  if (error == "no error") GTEST_SKIP() << "this version of Gmsh does not crash on it";
  expect_words(error, {"a.geo", crash});
}

TEST_F(HostileFile, ThatSwellsIsEnded)
{
#ifdef CHLADNI_SANITIZED
  GTEST_SKIP() << "the sanitizer ends a process without memory in its own way";
#endif
  const std::string code = "For i In {1:100000000}\nPoint(i) = {i, 0, 0};\nEndFor\n";
  expect_words(error_of({.file = write("a.geo", code), .most_MiB = 100}),
               {"a.geo", "more than 100 MiB", "--trust-mesh"});
}

}  // namespace
}  // namespace chladni::mesh
