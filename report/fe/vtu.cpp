#include "report/fe/vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

#include "common/eigen_every.hpp"
#include "mesh/element_types.hpp"
#include "plate/elements/solid_element.hpp"
#include "plate/sections/sections.hpp"
#include "report/page/page.hpp"
#include "sound/levels.hpp"
#include "sound/tone.hpp"

namespace chladni::report {

using Eigen::Index, Eigen::MatrixXd;

namespace {

/// The number of bytes as UInt64, then the values.
template <typename T>
std::string encoded(const T* values, std::size_t n)
{
  const std::uint64_t n_bytes = n * sizeof(T);
  std::vector<unsigned char> bytes(sizeof(n_bytes) + n_bytes);
  std::memcpy(bytes.data(), &n_bytes, sizeof(n_bytes));
  if (n > 0) std::memcpy(bytes.data() + sizeof(n_bytes), values, n_bytes);
  return base64(std::as_bytes(std::span(bytes)));
}

/// As the value of an attribute: names come from mesh files, too.
std::string as_attribute(std::string_view text)
{
  std::string escaped;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '&' || c == '<' || c == '>' || c == '"' || code < 0x20)
      escaped += fmt::format("&#{};", code < 0x20 ? ' ' : code);
    else
      escaped += c;
  }
  return escaped;
}

std::string array_of(const VtuField& field)
{
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const RowMajor values = field.values;
  return fmt::format(
      "<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n{}\n"
      "</DataArray>\n",
      as_attribute(field.name), values.cols(),
      encoded(values.data(), static_cast<std::size_t>(values.size())));
}

std::string array_of(const VtuMarks& marks)
{
  return fmt::format("<DataArray type=\"UInt8\" Name=\"{}\" format=\"binary\">\n{}\n</DataArray>\n",
                     as_attribute(marks.name), encoded(marks.values.data(), marks.values.size()));
}

std::string array_of(const char* name, const std::vector<int>& values)
{
  const std::vector<std::int64_t> wide(values.begin(), values.end());
  return fmt::format("<DataArray type=\"Int64\" Name=\"{}\" format=\"binary\">\n{}\n</DataArray>\n",
                     name, encoded(wide.data(), wide.size()));
}

std::string arrays_of(const std::vector<VtuField>& fields)
{
  std::string text;
  for (const VtuField& field : fields) text += array_of(field);
  return text;
}

}  // namespace

int vtu_cell_type(mesh::Shape shape, int order)
{
  switch (shape) {
    case mesh::Shape::line:
      return order == 1 ? 3 : 68;
    case mesh::Shape::triangle:
      return order == 1 ? 5 : 69;
    case mesh::Shape::quadrilateral:
      return order == 1 ? 9 : 70;
    case mesh::Shape::tetrahedron:
      return order == 2 ? 24 : 10;
    case mesh::Shape::hexahedron:
      return order == 2 ? 25 : 12;
    case mesh::Shape::wedge:
      return order == 2 ? 26 : 13;
  }
  return 0;
}

namespace {

/// The places of the nodes that a cell lists: VTK has no hexahedron with 32 nodes, so that order 3
/// is told by its corners.
std::vector<int> cell_places(const mesh::ElementBlock& block)
{
  if (!mesh::is_solid(block.shape)) return mesh::corners_first(block.shape, block.order);
  std::vector<int> places = mesh::corner_places(block);
  for (int k = static_cast<int>(places.size()); block.order == 2 && k < block.nodes_per_element;
       ++k)
    places.push_back(k);
  return places;
}

}  // namespace

std::string vtu_text(const VtuGrid& grid)
{
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n";
  text += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", grid.points.rows(),
                      grid.types.size());
  text += "<Points>\n" + array_of({.name = "points", .values = grid.points}) + "</Points>\n";
  text += "<Cells>\n" + array_of("connectivity", grid.connectivity) +
          array_of("offsets", grid.offsets) + array_of("types", grid.types) + "</Cells>\n";
  text += "<PointData>\n" + arrays_of(grid.of_points) + "</PointData>\n<CellData>\n" +
          arrays_of(grid.of_cells);
  for (const VtuMarks& marks : grid.marks_of_cells) text += array_of(marks);
  return text + "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

namespace {

/// One point for each node of each group.
class Points {
 public:
  int point(int node, int group)
  {
    const auto [it, is_new] =
        index_.emplace(std::pair(node, group), static_cast<int>(nodes.size()));
    if (is_new) {
      nodes.push_back(node);
      groups.push_back(group);
    }
    return it->second;
  }
  std::vector<int> nodes, groups;

 private:
  std::map<std::pair<int, int>, int> index_;
};

void add_cell(VtuGrid& grid, Points& points, const mesh::ElementBlock& block, int element)
{
  const std::span<const int> nodes = block.element_nodes(element);
  for (const int place : cell_places(block))
    grid.connectivity.push_back(points.point(nodes[place], block.group[element]));
  grid.offsets.push_back(static_cast<int>(grid.connectivity.size()));
  grid.types.push_back(vtu_cell_type(block.shape, block.order));
}

/// Number, group and rank of each element. Nodes inside an element belong to its rank, those on its
/// edges to a lower one perhaps.
void add_cell_fields(VtuGrid& grid, const mesh::Mesh& mesh, std::span<const int> owners)
{
  const auto n = static_cast<Index>(grid.types.size());
  VtuField number{.name = "element", .values = MatrixXd(n, 1)};
  VtuField group{.name = "group", .values = MatrixXd(n, 1)};
  VtuField rank{.name = "partition", .values = MatrixXd(n, 1)};
  Index cell = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e, ++cell) {
      int highest = 0;
      for (const int node : block.element_nodes(e)) highest = std::max(highest, owners[node]);
      number.values(cell) = static_cast<double>(block.numbers[e]);
      group.values(cell) = block.group[e];
      rank.values(cell) = highest;
    }
  }
  grid.of_cells = {std::move(number), std::move(group), std::move(rank)};
}

/// At the points of shells; 0 elsewhere.
VtuField thickness(const mesh::Mesh& mesh, std::span<const plate::ShellSection> sections,
                   const Points& points)
{
  const std::vector<int> of_group = plate::section_of_group(mesh, sections);
  VtuField field{.name = "thickness",
                 .values = MatrixXd::Zero(static_cast<Index>(points.nodes.size()), 1)};
  for (std::size_t i = 0; i < points.nodes.size(); ++i) {
    const int group = points.groups[i];
    const int section = group < 0 ? -1 : of_group[group];
    if (section < 0) continue;
    field.values(static_cast<Index>(i)) =
        plate::value_at(sections[section].thickness, mesh.positions[points.nodes[i]]);
  }
  return field;
}

}  // namespace

SceneGrid scene_grid(const mesh::Mesh& mesh, std::span<const plate::ShellSection> sections,
                     std::span<const int> owners)
{
  SceneGrid result;
  Points points;
  for (const mesh::ElementBlock& block : mesh.blocks)
    for (int e = 0; e < block.n_elements(); ++e) add_cell(result.grid, points, block, e);
  result.grid.points.resize(static_cast<Index>(points.nodes.size()), 3);
  for (std::size_t i = 0; i < points.nodes.size(); ++i) {
    const auto& x = mesh.positions[points.nodes[i]];
    result.grid.points.row(static_cast<Index>(i)) << x[0], x[1], x[2];
  }
  result.grid.of_points.push_back(thickness(mesh, sections, points));
  add_cell_fields(result.grid, mesh, owners);
  result.node_of_point = std::move(points.nodes);
  result.group_of_point = std::move(points.groups);
  return result;
}

void add_motions(SceneGrid& scene_grid, const Eigen::MatrixXd& motions, const std::string& prefix)
{
  const MatrixXd of_points = motions(scene_grid.node_of_point, every);
  auto& fields = scene_grid.grid.of_points;
  fields.push_back({.name = prefix + "displacement", .values = of_points.leftCols<3>()});
  fields.push_back({.name = prefix + "rotation", .values = of_points.rightCols<3>()});
}

void add_resultants(SceneGrid& scene_grid, const mesh::Mesh& mesh,
                    std::span<const plate::ShellSection> sections,
                    std::span<const plate::ShellResultants> resultants)
{
  const std::vector<int> of_group = plate::section_of_group(mesh, sections);
  const auto n = static_cast<Index>(scene_grid.node_of_point.size());
  VtuField N{.name = "membrane_force", .values = MatrixXd::Zero(n, 6)};
  VtuField M{.name = "moment", .values = MatrixXd::Zero(n, 6)};
  VtuField Q{.name = "shear_force", .values = MatrixXd::Zero(n, 3)};
  for (Index i = 0; i < n; ++i) {
    const int group = scene_grid.group_of_point[static_cast<std::size_t>(i)];
    const int node = scene_grid.node_of_point[static_cast<std::size_t>(i)];
    if (group < 0 || of_group[group] < 0) continue;
    const plate::ShellResultants& section = resultants[of_group[group]];
    N.values.row(i) = section.N.row(node);
    M.values.row(i) = section.M.row(node);
    Q.values.row(i) = section.Q.row(node);
  }
  for (VtuField* field : {&N, &M, &Q}) scene_grid.grid.of_points.push_back(std::move(*field));
}

void add_stresses(SceneGrid& scene_grid, const mesh::Mesh& mesh,
                  std::span<const plate::SolidSection> sections, std::span<const MatrixXd> stresses)
{
  if (sections.empty()) return;
  const auto n = static_cast<Index>(scene_grid.node_of_point.size());
  VtuField stress{.name = "stress", .values = MatrixXd::Zero(n, 6)};
  for (Index i = 0; i < n; ++i) {
    const int group = scene_grid.group_of_point[static_cast<std::size_t>(i)];
    if (group < 0) continue;
    const std::string& name = mesh.groups[static_cast<std::size_t>(group)].name;
    const auto section = std::ranges::find(sections, name, &plate::SolidSection::group);
    if (section == sections.end()) continue;
    stress.values.row(i) = stresses[static_cast<std::size_t>(section - sections.begin())].row(
        scene_grid.node_of_point[static_cast<std::size_t>(i)]);
  }
  VtuField equivalent{.name = "von_mises", .values = plate::von_mises(stress.values)};
  scene_grid.grid.of_points.push_back(std::move(stress));
  scene_grid.grid.of_points.push_back(std::move(equivalent));
}

namespace {

constexpr std::size_t most_marks = 30'000'000;  ///< bytes, of all groups together

struct Cells {
  VtuGrid grid;
  std::vector<std::int64_t> element, group;
};

void add_cell(Cells& cells, int type, int group, std::int64_t element)
{
  cells.grid.offsets.push_back(static_cast<int>(cells.grid.connectivity.size()));
  cells.grid.types.push_back(type);
  cells.group.push_back(group);
  cells.element.push_back(element);
}

void add_elements(Cells& cells, const mesh::ElementBlock& block)
{
  const std::vector<int> order = cell_places(block);
  for (int e = 0; e < block.n_elements(); ++e) {
    for (const int place : order) cells.grid.connectivity.push_back(block.element_nodes(e)[place]);
    add_cell(cells, vtu_cell_type(block.shape, block.order), block.group[e], block.numbers[e]);
  }
}

void add_edge(Cells& cells, const std::vector<int>& edge, int group)
{
  const auto order = static_cast<int>(edge.size()) - 1;
  for (const int place : mesh::corners_first(mesh::Shape::line, order))
    cells.grid.connectivity.push_back(edge[place]);
  add_cell(cells, vtu_cell_type(mesh::Shape::line, order), group, 0);
}

/// What elements alone do not show of a group.
void add_parts(Cells& cells, const GroupParts& parts, int group)
{
  if (parts.kind == GroupKind::curve)
    for (const std::vector<int>& edge : parts.edges) add_edge(cells, edge, group);
  for (const int node : parts.points) {
    cells.grid.connectivity.push_back(node);
    add_cell(cells, vtu_vertex, group, 0);
  }
}

VtuField column(const std::string& name, const std::vector<std::int64_t>& values)
{
  VtuField field{.name = name, .values = Eigen::MatrixXd(std::ssize(values), 1)};
  for (Index i = 0; i < std::ssize(values); ++i)
    field.values(i) = static_cast<double>(values[static_cast<std::size_t>(i)]);
  return field;
}

VtuMarks marks_of_group(const mesh::Mesh& mesh, const Cells& cells, std::size_t group)
{
  VtuMarks marks{.name = "group " + mesh.groups[group].name, .values = {}};
  for (const std::int64_t of_cell : cells.group)
    marks.values.push_back(std::cmp_equal(of_cell, group) ? 1 : 0);
  return marks;
}

}  // namespace

std::string mesh_vtu(const mesh::Mesh& mesh, const std::vector<GroupParts>& parts)
{
  Cells cells;
  for (const mesh::ElementBlock& block : mesh.blocks) add_elements(cells, block);
  for (std::size_t g = 0; g < parts.size(); ++g) add_parts(cells, parts[g], static_cast<int>(g));
  cells.grid.points.resize(mesh.n_nodes(), 3);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const auto& [x, y, z] = mesh.positions[i];
    cells.grid.points.row(i) << x, y, z;
  }
  cells.grid.of_points = {column("node", mesh.node_numbers)};
  cells.grid.of_cells = {column("element", cells.element), column("group", cells.group)};
  if (cells.group.size() * mesh.groups.size() <= most_marks)
    for (std::size_t g = 0; g < mesh.groups.size(); ++g)
      cells.grid.marks_of_cells.push_back(marks_of_group(mesh, cells, g));
  return vtu_text(cells.grid);
}

namespace {

constexpr int vtk_tetrahedron = 10;
constexpr int vtk_wedge = 13;

}  // namespace

std::string sound_vtu(const std::vector<sound::Tone>& tones)
{
  VtuGrid grid;
  if (tones.empty()) return vtu_text(grid);
  const sound::FieldPicture picture = sound::field_picture(tones.front());
  grid.points = picture.points;
  for (const std::vector<int>& cell : picture.cells) {
    grid.connectivity.insert(grid.connectivity.end(), cell.begin(), cell.end());
    grid.offsets.push_back(static_cast<int>(grid.connectivity.size()));
    grid.types.push_back(cell.size() == 6 ? vtk_wedge : vtk_tetrahedron);
  }
  Eigen::VectorXd level(picture.pressure.size());
  for (Eigen::Index i = 0; i < level.size(); ++i)
    level[i] = sound::level_dB(std::abs(picture.pressure[i]) / std::numbers::sqrt2);
  grid.of_points = {{.name = "pressure_re", .values = picture.pressure.real()},
                    {.name = "pressure_im", .values = picture.pressure.imag()},
                    {.name = "amplitude", .values = picture.pressure.cwiseAbs()},
                    {.name = "level_dB", .values = level}};
  return vtu_text(grid);
}

}  // namespace chladni::report
