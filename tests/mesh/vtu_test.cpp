// Grids of VTK: what is taken over in each way that arrays are written, and the sentences for what
// is not.
#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cstring>

#include "mesh/exchange/vtu.hpp"
#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::area;
using testing::error_of;
using testing::expect_refused;
using testing::expect_words;
using testing::MeshFile;
using testing::Refusal;

Mesh mesh_of_text(const std::string& text, const MeshOptions& options = {})
{
  return mesh_of(vtu_mesh(text), options);
}

std::string error_in(const std::string& text)
{
  try {
    mesh_of_text(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string ascii(const std::string& type, const std::string& name, const std::string& values,
                  int components = 1)
{
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n{}\n"
      "</DataArray>\n",
      type, name, components, values);
}

struct Grid {
  std::string points = ascii("Float64", "Points", "0 0 0 2 0 0 2 1 0 0 1 0 3 0 0 3 1 0", 3);
  std::string connectivity = ascii("Int64", "connectivity", "0 1 2 3 1 4 5 2 0 3 1");
  std::string offsets = ascii("Int64", "offsets", "4 8 10 11");
  std::string types = ascii("UInt8", "types", "9 9 3 1");
  std::string of_points = {}, of_cells = {};
  std::string attributes = "byte_order=\"LittleEndian\" header_type=\"UInt64\"";
  int n_points = 6, n_cells = 4;
  std::string behind = {};  ///< the grid
};

std::string text_of(const Grid& grid)
{
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" {}>\n"
      "<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" "
      "NumberOfCells=\"{}\">\n<Points>{}</Points>\n"
      "<Cells>{}{}{}</Cells>\n<PointData>{}</PointData>\n<CellData>{}</CellData>\n</Piece>\n"
      "</UnstructuredGrid>\n{}</VTKFile>\n",
      grid.attributes, grid.n_points, grid.n_cells, grid.points, grid.connectivity, grid.offsets,
      grid.types, grid.of_points, grid.of_cells, grid.behind);
}

TEST(Vtu, HasGroupsByTheirNames)
{
  const Mesh mesh = mesh_of_text(text_of(
      {.of_points = ascii("UInt8", "group hub &amp; rim", "0 0 0 0 1 1") +
                    ascii("Float32", "u", "0 0 0 0 0 0") + ascii("String", "names", "x"),
       .of_cells =
           ascii("UInt8", "group plate", "1 1 0 0") + ascii("Int32", "group root", "0 0 7 0") +
           ascii("UInt8", "group tip", "0 0 0 1") + ascii("Int32", "material", "3 4 5 6")}));
  EXPECT_NEAR(area(mesh), 3.0, 1e-15);
  EXPECT_EQ(find_group(mesh, "plate").nodes.size(), 6u);
  EXPECT_EQ(find_group(mesh, "root").dimension, 1);
  EXPECT_EQ(find_group(mesh, "root").nodes, (std::vector<int>{0, 3}));
  EXPECT_EQ(find_group(mesh, "tip").nodes, (std::vector<int>{1}));
  EXPECT_EQ(find_group(mesh, "hub & rim").nodes, (std::vector<int>{4, 5}));
  EXPECT_EQ(mesh.groups.size(), 4u) << "material is no group beside those that are named";
}

TEST(Vtu, HasGroupsByTheValuesOfWholeNumbers)
{
  const Mesh mesh = mesh_of_text(text_of({.of_points = ascii("Int32", "side", "-1 0 0 -1 1 1"),
                                          .of_cells = ascii("Int32", "material", "3 4 3 3")}));
  EXPECT_EQ(find_group(mesh, "material_3").nodes, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(find_group(mesh, "material_3_lines").nodes, (std::vector<int>{0, 3}));
  EXPECT_EQ(find_group(mesh, "material_3_nodes").nodes, (std::vector<int>{1}));
  EXPECT_EQ(find_group(mesh, "material_4").nodes, (std::vector<int>{1, 2, 4, 5}));
  EXPECT_EQ(find_group(mesh, "side_-1").nodes, (std::vector<int>{0, 3}));
}

TEST(Vtu, NamesLinesOfAGroupOfSurfacesByTheirKind)
{
  const Mesh mesh = mesh_of_text(text_of({.of_cells = ascii("UInt8", "group a", "1 0 1 0")}));
  EXPECT_EQ(find_group(mesh, "a").nodes, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(find_group(mesh, "a_lines").nodes, (std::vector<int>{0, 3}));
}

TEST(Vtu, HasACellThatStandsThereTwiceOnce)
{
  const std::string twice = text_of(
      {.connectivity = ascii("Int64", "connectivity", "0 1 2 3 1 2 3 0 0 3 1"),
       .of_cells = ascii("UInt8", "group a", "1 0 0 0") + ascii("UInt8", "group b", "0 1 0 0")});
  const Mesh mesh = mesh_of_text(twice, {.shell_groups = {"b"}});
  EXPECT_NEAR(area(mesh), 2.0, 1e-15);
  EXPECT_EQ(mesh.groups[std::size_t(mesh.blocks.at(0).group.at(0))].name, "b") << "has a section";
  EXPECT_EQ(find_group(mesh, "a").nodes.size(), 4U);
}

TEST(Vtu, WithoutGroupsIsOneOfAllSurfaces)
{
  EXPECT_EQ(find_group(mesh_of_text(text_of({})), "surfaces").nodes.size(), 6u);
}

template <class T>
std::string raw(const std::vector<T>& values)
{
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string base64(const std::string& bytes)
{
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::string three = bytes.substr(at, 3);
    const std::size_t n = three.size();
    three.resize(3, '\0');
    unsigned value = 0;
    for (const char c : three) value = value << 8 | static_cast<unsigned char>(c);
    for (int k = 3; k >= 0; --k)
      text += 3 - k > static_cast<int>(n) ? '=' : digits[value >> (6 * k) & 63];
  }
  return text;
}

std::string packed(const std::string& bytes)
{
  std::string text(compressBound(bytes.size()), '\0');
  uLongf n = text.size();
  compress(reinterpret_cast<Bytef*>(text.data()), &n, reinterpret_cast<const Bytef*>(bytes.data()),
           bytes.size());
  text.resize(n);
  return text;
}

/// Header and values as VTK writes them with zlib: two blocks, the second one shorter.
struct Blocks {
  std::string header, values;
};
Blocks blocks(const std::string& bytes)
{
  const std::size_t first = bytes.size() / 2 + 1;
  const std::string a = packed(bytes.substr(0, first)), b = packed(bytes.substr(first));
  return {raw<std::uint32_t>({2, std::uint32_t(first), std::uint32_t(bytes.size() - first),
                              std::uint32_t(a.size()), std::uint32_t(b.size())}),
          a + b};
}

const std::string point_bytes = raw<float>({0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0, 3, 0, 0, 3, 1, 0});

std::string binary(const std::string& type, const std::string& name, const std::string& text)
{
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" format=\"binary\"> {}\n</DataArray>\n",
                     type, name, text);
}

TEST(Vtu, ReadsBase64AsItIsWrittenByAll)
{
  const std::string head = raw<std::uint64_t>({point_bytes.size()});
  for (const std::string& text :
       {base64(head + point_bytes), base64(head) + "\n" + base64(point_bytes)})
    EXPECT_NEAR(area(mesh_of_text(text_of({.points = binary("Float32", "Points", text)}))), 3.0,
                1e-15);
  const std::string types = raw<std::uint8_t>({9, 9, 3, 1});
  EXPECT_NEAR(area(mesh_of_text(
                  text_of({.types = binary("UInt8", "types",
                                           base64(raw<std::uint64_t>({types.size()}) + types))}))),
              3.0, 1e-15);
}

/// VTK's own writer puts ranges into arrays, as elements of their own.
TEST(Vtu, PassesOverWhatVtkNotesOnAnArray)
{
  std::string points = ascii("Float64", "Points", "0 0 0 2 0 0 2 1 0 0 1 0 3 0 0 3 1 0", 3);
  points.insert(points.find("</DataArray>"),
                "<InformationKey name=\"L2_NORM_RANGE\"><Value index=\"0\">7</Value>"
                "<Value index=\"1\">8</Value></InformationKey>");
  EXPECT_NEAR(area(mesh_of_text(text_of({.points = points}))), 3.0, 1e-15);
}

const std::string zlib_attributes =
    "byte_order=\"LittleEndian\" compressor=\"vtkZLibDataCompressor\"";

TEST(Vtu, ReadsBlocksPackedByZlib)
{
  const auto [header, values] = blocks(point_bytes);
  const Grid grid{.points = binary("Float32", "Points", base64(header) + base64(values)),
                  .attributes = zlib_attributes};
  EXPECT_NEAR(area(mesh_of_text(text_of(grid))), 3.0, 1e-15);
}

TEST(Vtu, ReadsAppendedBytesWhateverTheyAre)
{
  const auto [header, values] = blocks(point_bytes);
  const std::string types = raw<std::uint8_t>({9, 9, 3, 1});
  const Blocks type_blocks = blocks(types);
  const std::string front = header + values;
  Grid grid{
      .points = "<DataArray type=\"Float32\" Name=\"Points\" format=\"appended\" offset=\"0\"/>",
      .types = fmt::format(
          "<DataArray type=\"UInt8\" Name=\"types\" format=\"appended\" offset=\"{}\"/>",
          front.size()),
      .attributes = zlib_attributes};
  grid.behind = "<AppendedData encoding=\"raw\">\n _" + front + type_blocks.header +
                type_blocks.values + "</AppendedData>\n";
  EXPECT_NEAR(area(mesh_of_text(text_of(grid))), 3.0, 1e-15);
  const std::string letters = base64(header) + base64(values);
  grid.types =
      fmt::format("<DataArray type=\"UInt8\" Name=\"types\" format=\"appended\" offset=\"{}\"/>",
                  letters.size());
  grid.behind = "<AppendedData encoding=\"base64\">\n _" + letters + base64(type_blocks.header) +
                base64(type_blocks.values) + "</AppendedData>\n";
  EXPECT_NEAR(area(mesh_of_text(text_of(grid))), 3.0, 1e-15);
}

TEST(Vtu, RefusesWhatIsWrongOrNotKnown)
{
  const auto behind_end = raw<std::uint64_t>({1000});
  const std::vector<Refusal> refusals{
      {"<VTKFile type=\"PolyData\"></VTKFile>", {"PolyData", "UnstructuredGrid"}},
      {"<VTKFile type=\"UnstructuredGrid\"><Piece", {"no XML"}},
      {text_of({.attributes = "byte_order=\"BigEndian\""}), {"BigEndian"}},
      {text_of({.attributes = "compressor=\"vtkLZ4DataCompressor\""}), {"vtkLZ4DataCompressor"}},
      {text_of({.points = ascii("Float64", "Points", "0 0 0", 3)}), {"3 values instead of 18"}},
      {text_of({.points = ascii("Float64", "Points", "0 0 0 2 x 0", 3)}), {"\"x\" is no number"}},
      {text_of({.points = ascii("Float64", "Points", "nan 0 0 2 0 0 2 1 0 0 1 0 3 0 0 3 1 0", 3)}),
       {"point 0"}},
      {text_of({.points = ascii("Int32", "Points", "0 0 0 2 0 0 2 1 0 0 1 0 3 0 0 3 1 0", 3)}),
       {"no real numbers"}},
      {text_of({.points = ascii("String", "Points", "0")}), {"\"String\" is not known"}},
      {text_of({.points = binary("Float32", "Points", base64(behind_end))}), {"1000 bytes"}},
      {text_of({.points = binary("Float32", "Points", "AA!A")}), {"Points"}},
      {text_of({.points = "<DataArray type=\"Float32\" format=\"appended\" offset=\"9\"/>"}),
       {"behind the end"}},
      {text_of({.points = binary("Float32", "Points",
                                 base64(raw<std::uint32_t>({1, 72, 72, 4})) + base64("none")),
                .attributes = zlib_attributes}),
       {"does not unpack"}},
      {text_of(
           {.points = binary("Float32", "Points",
                             base64(raw<std::uint32_t>({1, 4000000000u, 0, 4})) + base64("none")),
            .attributes = zlib_attributes}),
       {"does not unpack"}},
      {text_of({.of_cells = ascii("UInt8", "group plate", "1 1")}), {"group plate", "2 values"}}};
  for (const Refusal& refusal : refusals) expect_refused(refusal, error_in(refusal.text));
  const std::vector<Refusal> of_cells{
      {text_of({.types = ascii("UInt8", "types", "10 9 3 1")}), {"cell 0", "solid", "mid-surface"}},
      {text_of({.types = ascii("UInt8", "types", "9 7 3 1")}), {"cell 1", "type 7"}},
      {text_of({.types = ascii("UInt8", "types", "5 9 3 1")}), {"element 1 has 4 nodes"}},
      {text_of({.types = ascii("UInt8", "types", "69 9 3 1")}), {"cell 0 has 4 nodes"}},
      {text_of({.connectivity = ascii("Int64", "connectivity", "0 1 2 9 1 4 5 2 0 3 1")}),
       {"cell 0", "no point 9"}},
      {text_of({.offsets = ascii("Int64", "offsets", "4 2 10 11")}), {"cell 1 ends at 2"}},
      {text_of({.offsets = ascii("Int64", "offsets", "4 8 10 99")}), {"cell 3 ends at 99"}},
      {text_of({.connectivity = ""}), {"\"connectivity\" is missing"}}};
  for (const Refusal& refusal : of_cells) expect_words(error_in(refusal.text), refusal.words);
}

TEST(Vtu, RefusesMorePiecesThanOne)
{
  std::string text = text_of({});
  const std::size_t end = text.find("</UnstructuredGrid>");
  text.insert(end, "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"></Piece>");
  expect_words(error_in(text), {"several pieces"});
}

/// An entity that doubles ten times and more makes no memory of that size.
TEST(Vtu, IsNotDeceivedByEntities)
{
  std::string text = "<!DOCTYPE a [<!ENTITY b \"0123456789\">";
  std::string last = "b";
  for (char c = 'c'; c < 'q'; ++c) {
    const std::string ref = "&" + last + ";";
    text +=
        fmt::format("<!ENTITY {} \"{}{}{}{}{}{}{}{}\">", c, ref, ref, ref, ref, ref, ref, ref, ref);
    last = std::string(1, c);
  }
  text +=
      "]>\n<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"0\" "
      "NumberOfCells=\"0\"><Points><DataArray type=\"Float64\" format=\"ascii\">&" +
      last + ";</DataArray></Points></Piece></UnstructuredGrid></VTKFile>";
  expect_words(error_in(text), {"no XML"});
}

class VtuFile : public MeshFile {};

TEST_F(VtuFile, IsScaledByItsUnit)
{
  const std::string file = write("a.vtu", text_of({}));
  EXPECT_NEAR(area(generate({.file = file, .length_unit = 1e-3})), 3e-6, 1e-18);
}

}  // namespace
}  // namespace chladni::mesh
