#include "report/fe/mesh_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "mesh/element_types.hpp"
#include "plate/dofs/couplings.hpp"
#include "plate/sections/sections.hpp"
#include "report/page/page.hpp"
#include "report/text_table.hpp"
#include "report/version.hpp"

namespace chladni::report {

namespace {

using Place = std::int32_t;

/// How far one goes along the lattice of an element from one drawn node to the next.
int step_of(Detail detail, int order)
{
  return detail == Detail::lattice ? 1 : order;
}

std::size_t n_cells(const mesh::Mesh& mesh, Detail detail)
{
  std::size_t n = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (mesh::is_solid(block.shape)) continue;
    n += mesh::lattice_cells(block, step_of(detail, block.order)).size() *
         static_cast<std::size_t>(block.n_elements());
  }
  for (const mesh::FreeFace& face : mesh::free_faces(mesh)) {
    const int order = mesh.blocks[face.block].order;
    n += mesh::face_cells(int(face.nodes.size()), order, detail == Detail::lattice).size();
  }
  return n;
}

/// The node that is drawn in place of each node: the first one in its cube of the grid.
std::vector<int> clusters(const mesh::Mesh& mesh, double width)
{
  std::map<std::array<std::int64_t, 3>, int> first;
  std::vector<int> drawn(mesh.positions.size());
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    std::array<std::int64_t, 3> cube{};
    for (std::size_t c = 0; c < 3; ++c) cube[c] = std::llround(mesh.positions[i][c] / width);
    drawn[i] = first.emplace(cube, i).first->second;
  }
  return drawn;
}

/// Draws with some nodes in place of others.
class Drawer {
 public:
  Drawer(const mesh::Mesh& mesh, Detail detail, std::vector<int> drawn)
      : mesh_(mesh),
        drawn_(std::move(drawn)),
        place_(mesh.positions.size(), -1),
        is_on_skin_(mesh.positions.size(), 0)
  {
    drawing_.detail = detail;
    for (const mesh::FreeFace& face : mesh::free_faces(mesh))
      for (const int node : face.nodes) is_on_skin_[std::size_t(node)] = 1;
  }
  void add_cells();
  void add_edges();
  void add_group(const GroupParts& parts);
  MeshDrawing drawing() && { return std::move(drawing_); }

 private:
  Place place(int node);
  void add_cell(std::array<Place, 4> corners, int group, mesh::Shape shape);
  std::vector<Place> along(const std::vector<int>& edge);

  const mesh::Mesh& mesh_;
  std::vector<int> drawn_;
  std::vector<Place> place_;
  std::vector<char> is_on_skin_;  ///< of solids
  std::set<std::vector<Place>> seen_;
  MeshDrawing drawing_;
};

Place Drawer::place(int node)
{
  Place& place = place_[drawn_[node]];
  if (place < 0) {
    place = static_cast<Place>(drawing_.positions.size() / 3);
    for (const double x : mesh_.positions[drawn_[node]])
      drawing_.positions.push_back(static_cast<float>(x));
  }
  return place;
}

/// Clusters shrink some cells to triangles, lines and points, and make some equal to others: what
/// is no longer a surface, or is there already, is left out.
void Drawer::add_cell(std::array<Place, 4> corners, int group, mesh::Shape shape)
{
  if (drawing_.detail == Detail::clusters) {
    std::vector<Place> round;
    for (const Place corner : corners)
      if (round.empty() || (round.back() != corner && round.front() != corner))
        round.push_back(corner);
    if (round.size() < (shape == mesh::Shape::line ? 2U : 3U)) return;
    round.resize(4, round.back());
    std::ranges::copy(round, corners.begin());
    std::ranges::sort(round);
    if (!seen_.insert(round).second) return;
  }
  drawing_.cells.insert(drawing_.cells.end(), corners.begin(), corners.end());
  drawing_.group_of_cell.push_back(group);
}

void Drawer::add_cells()
{
  for (const mesh::FreeFace& face : mesh::free_faces(mesh_)) {
    const mesh::ElementBlock& block = mesh_.blocks[face.block];
    const bool with_edges = drawing_.detail == Detail::lattice;
    for (mesh::LatticeCell cell :
         mesh::face_cells(int(face.nodes.size()), block.order, with_edges)) {
      for (int& corner : cell) corner = place(face.nodes[std::size_t(corner)]);
      add_cell(cell, block.group[face.element], block.shape);
    }
  }
  for (const mesh::ElementBlock& block : mesh_.blocks) {
    if (mesh::is_solid(block.shape)) continue;
    const std::vector<mesh::LatticeCell> cells =
        mesh::lattice_cells(block, step_of(drawing_.detail, block.order));
    for (int e = 0; e < block.n_elements(); ++e) {
      for (mesh::LatticeCell cell : cells) {
        for (int& corner : cell) corner = place(block.element_nodes(e)[corner]);
        add_cell(cell, block.group[e], block.shape);
      }
    }
  }
}

/// The drawn nodes of an edge.
std::vector<Place> Drawer::along(const std::vector<int>& edge)
{
  const auto order = static_cast<int>(edge.size()) - 1;
  std::vector<Place> places;
  for (int i = 0; i <= order; i += step_of(drawing_.detail, order))
    places.push_back(place(edge[i]));
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

void Drawer::add_edges()
{
  if (drawing_.detail == Detail::clusters) return;
  std::set<std::pair<Place, Place>> seen;
  for (const mesh::ElementBlock& block : mesh_.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      for (const std::vector<int>& edge : mesh::edges_of(block, e)) {
        const auto is_outside = [&](int node) { return is_on_skin_[std::size_t(node)] != 0; };
        if (mesh::is_solid(block.shape) && !std::ranges::all_of(edge, is_outside)) continue;
        const std::vector<Place> places = along(edge);
        if (!seen.insert(std::minmax(places.front(), places.back())).second) continue;
        for (std::size_t i = 1; i < places.size(); ++i)
          drawing_.edges.insert(drawing_.edges.end(), {places[i - 1], places[i]});
      }
    }
  }
}

void Drawer::add_group(const GroupParts& parts)
{
  GroupDrawing group;
  for (const std::vector<int>& edge : parts.edges) {
    const std::vector<Place> places = along(edge);
    for (std::size_t i = 1; i < places.size(); ++i)
      group.lines.insert(group.lines.end(), {places[i - 1], places[i]});
  }
  std::set<Place> points;
  for (const int node : parts.points) points.insert(place(node));
  group.points.assign(points.begin(), points.end());
  drawing_.groups.push_back(std::move(group));
}

MeshDrawing drawn(const mesh::Mesh& mesh, std::span<const GroupParts> parts, Detail detail,
                  std::vector<int> nodes)
{
  Drawer drawer(mesh, detail, std::move(nodes));
  drawer.add_cells();
  drawer.add_edges();
  for (const GroupParts& group : parts) drawer.add_group(group);
  return std::move(drawer).drawing();
}

double width_of(const mesh::Mesh& mesh)
{
  double width = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto [least, greatest] =
        std::ranges::minmax_element(mesh.positions, {}, [&](const auto& x) { return x[c]; });
    width = std::max(width, (*greatest)[c] - (*least)[c]);
  }
  return width;
}

}  // namespace

MeshDrawing draw_mesh(const mesh::Mesh& mesh, std::span<const GroupParts> parts,
                      const DrawingLimits& limits)
{
  std::vector<int> own(mesh.positions.size());
  for (int i = 0; i < mesh.n_nodes(); ++i) own[i] = i;
  const std::size_t n_lattice = n_cells(mesh, Detail::lattice);
  const std::size_t n_corners = n_cells(mesh, Detail::corners);
  const bool is_linear = n_lattice == n_corners;
  if (n_lattice <= (is_linear ? limits.corners : limits.lattice))
    return drawn(mesh, parts, Detail::lattice, std::move(own));
  if (n_corners <= limits.corners) return drawn(mesh, parts, Detail::corners, std::move(own));
  double cube = width_of(mesh) / std::sqrt(static_cast<double>(limits.corners));
  MeshDrawing drawing = drawn(mesh, parts, Detail::clusters, clusters(mesh, cube));
  while (drawing.group_of_cell.size() > limits.corners) {
    cube *= 1.3;
    drawing = drawn(mesh, parts, Detail::clusters, clusters(mesh, cube));
  }
  return drawing;
}

namespace {

/// By its elements; a group without any is one of its edges, if it has some.
std::vector<GroupKind> kinds_by_elements(const mesh::Mesh& mesh)
{
  std::vector<GroupKind> kinds(mesh.groups.size(), GroupKind::points);
  for (const mesh::ElementBlock& block : mesh.blocks) {
    constexpr std::array of_dimension{GroupKind::lines, GroupKind::surface, GroupKind::volume};
    for (const int group : block.group)
      if (group >= 0) kinds[group] = of_dimension[std::size_t(mesh::dimension(block.shape) - 1)];
  }
  const bool has_solids = std::ranges::any_of(
      mesh.blocks, [](const mesh::ElementBlock& block) { return mesh::is_solid(block.shape); });
  for (std::size_t g = 0; g < kinds.size(); ++g)
    if (has_solids && mesh.groups[g].dimension == 2) kinds[g] = GroupKind::surface;
  return kinds;
}

double volume_of(const mesh::Mesh& mesh, int group)
{
  double volume = 0.0;
  for (const mesh::ElementBlock& block : mesh.blocks)
    for (int e = 0; mesh::is_solid(block.shape) && e < block.n_elements(); ++e)
      if (block.group[e] == group) volume += plate::solid_of_mesh(mesh, block, e).dV.sum();
  return volume;
}

double sum(const std::map<int, double>& shares)
{
  double total = 0.0;
  for (const auto& [node, share] : shares) total += share;
  return total;
}

std::array<std::array<double, 2>, 3> extents_of(const mesh::Mesh& mesh, const mesh::Group& group)
{
  std::array<std::array<double, 2>, 3> extents{};
  for (std::size_t c = 0; c < 3 && !group.nodes.empty(); ++c) {
    const auto coordinate = [&](int node) { return mesh.positions[node][c]; };
    const auto [least, greatest] = std::ranges::minmax_element(group.nodes, {}, coordinate);
    extents[c] = {coordinate(*least), coordinate(*greatest)};
  }
  return extents;
}

/// The nodes of the group that no edge has.
std::vector<int> without_edges(const mesh::Group& group, const std::vector<std::vector<int>>& edges)
{
  std::vector<int> joined;
  for (const std::vector<int>& edge : edges) joined.insert(joined.end(), edge.begin(), edge.end());
  std::ranges::sort(joined);
  std::vector<int> points = group.nodes;
  std::erase_if(points, [&](int node) { return std::ranges::binary_search(joined, node); });
  return points;
}

GroupParts parts_of(const mesh::Mesh& mesh, const mesh::Group& group, GroupKind kind)
{
  GroupParts parts{.kind = kind, .edges = {}, .points = {}, .extents = extents_of(mesh, group)};
  // A curve and a surface of a file may have one name, which then means the first of them.
  const bool is_meant = &mesh::find_group(mesh, group.name) == &group;
  if (kind == GroupKind::volume) {
    parts.size = volume_of(mesh, static_cast<int>(&group - mesh.groups.data()));
    return parts;
  }
  if (kind == GroupKind::surface) {
    if (is_meant) parts.size = sum(plate::group_shares(mesh, group.name));
    return parts;
  }
  if (group.dimension > 0) parts.edges = mesh::edges_in(mesh, group);
  parts.points = without_edges(group, parts.edges);
  if (parts.edges.empty()) return parts;
  if (is_meant) parts.size = sum(plate::edge_shares(mesh, group.name));
  if (kind == GroupKind::points) parts.kind = GroupKind::curve;
  return parts;
}

}  // namespace

std::string name_of(GroupKind kind)
{
  switch (kind) {
    case GroupKind::volume:
      return "volume";
    case GroupKind::surface:
      return "surface";
    case GroupKind::lines:
      return "lines";
    case GroupKind::curve:
      return "curve";
    case GroupKind::points:
      break;
  }
  return "points";
}

std::vector<GroupParts> group_parts(const mesh::Mesh& mesh)
{
  const std::vector<GroupKind> kinds = kinds_by_elements(mesh);
  std::vector<GroupParts> parts;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    parts.push_back(parts_of(mesh, mesh.groups[g], kinds[g]));
  return parts;
}

namespace {

/// What the page says of a drawing that leaves something out.
std::string said_of(Detail detail)
{
  switch (detail) {
    case Detail::lattice:
      return "";
    case Detail::corners:
      return "Elements are drawn by their corners alone, to keep this page small.";
    case Detail::clusters:
      break;
  }
  return "Drawn coarser than the mesh is, to keep this page small: corners near to each other are "
         "one. The .vtu file has all elements.";
}

Json group_json(const mesh::Group& group, const GroupParts& parts, const GroupDrawing& drawing)
{
  std::vector<Json> extents;
  for (const std::array<double, 2>& range : parts.extents)
    extents.push_back(rounded(std::span(range)));
  return Json::object({{"name", group.name},
                       {"kind", name_of(parts.kind)},
                       {"n_nodes", group.nodes.size()},
                       {"size", rounded(parts.size)},
                       {"extents", Json::array(extents)},
                       {"lines", packed(drawing.lines)},
                       {"points", packed(drawing.points)}});
}

}  // namespace

std::string mesh_page(const std::string& title, const mesh::Mesh& mesh,
                      const std::vector<GroupParts>& parts, const TextTable& summary)
{
  const MeshDrawing drawing = draw_mesh(mesh, parts);
  std::vector<Json> groups;
  for (std::size_t g = 0; g < parts.size(); ++g)
    groups.push_back(group_json(mesh.groups[g], parts[g], drawing.groups[g]));
  const Json picture = Json::object({{"positions", packed(drawing.positions)},
                                     {"cells", packed(drawing.cells)},
                                     {"group_of_cell", packed(drawing.group_of_cell)},
                                     {"edges", packed(drawing.edges)},
                                     {"said", said_of(drawing.detail)}});
  const Json content = Json::object({{"title", title},
                                     {"version", version},
                                     {"drawing", picture},
                                     {"groups", Json::array(groups)},
                                     {"tables", Json::array({table_json("Mesh", summary)})},
                                     {"mesh_checksum", mesh::checksum(mesh)}});
  return report_page(title, content, "null");
}

namespace {

std::string name_of(mesh::Shape shape)
{
  switch (shape) {
    case mesh::Shape::line:
      return "lines";
    case mesh::Shape::triangle:
      return "triangles";
    case mesh::Shape::quadrilateral:
      return "quadrilaterals";
    case mesh::Shape::tetrahedron:
      return "tetrahedra";
    case mesh::Shape::hexahedron:
      return "hexahedra";
    case mesh::Shape::wedge:
      return "wedges";
  }
  return "";
}

}  // namespace

TextTable mesh_table(const mesh::Mesh& mesh)
{
  TextTable table{.header = {"part of the mesh", "count"}, .rows = {}};
  table.rows.push_back({"nodes", fmt::format("{}", mesh.n_nodes())});
  for (const mesh::ElementBlock& block : mesh.blocks) {
    table.rows.push_back({fmt::format("{} of order {}", name_of(block.shape), block.order),
                          fmt::format("{}", block.n_elements())});
  }
  for (const mesh::Group& group : mesh.groups) {
    table.rows.push_back(
        {fmt::format("nodes of {}", group.name), fmt::format("{}", group.nodes.size())});
  }
  return table;
}

std::vector<Json::Member> mesh_json(const mesh::Mesh& mesh)
{
  int n_elements = 0;
  for (const mesh::ElementBlock& block : mesh.blocks) n_elements += block.n_elements();
  return {{"n_nodes", mesh.n_nodes()},
          {"n_elements", n_elements},
          {"mesh_checksum", mesh::checksum(mesh)},
          {"notes", Json::array({mesh.notes.begin(), mesh.notes.end()})}};
}

namespace {

/// One measure with the inner edges of its histogram's bins; the outer ones are open.
struct Measure {
  const char* key;
  const char* name;
  double mesh::ElementQuality::*value;
  std::vector<double> edges;
};

const std::vector<Measure>& measures()
{
  using Q = mesh::ElementQuality;
  static const std::vector<Measure> all{
      {"scaled_jacobian", "scaled Jacobian", &Q::scaled_jacobian, {0.0, 0.2, 0.4, 0.6, 0.8, 0.9}},
      {"aspect_ratio", "aspect ratio", &Q::aspect_ratio, {1.5, 2.0, 3.0, 5.0, 10.0, 20.0}},
      {"warp_deg", "warp, degrees", &Q::warp, {1.0, 2.0, 5.0, 10.0, 20.0, 40.0}},
      {"skew", "skew", &Q::skew, {0.1, 0.25, 0.5, 0.75, 0.9, 0.95}}};
  return all;
}

struct Statistics {
  double least, mean, greatest;
  std::vector<int> counts;  ///< of the bins
};

Statistics statistics(const std::vector<mesh::ElementQuality>& elements, const Measure& measure)
{
  std::vector<double> values;
  for (const mesh::ElementQuality& e : elements) values.push_back(e.*measure.value);
  const auto [least, greatest] = std::ranges::minmax(values);
  Statistics s{.least = least,
               .mean = std::accumulate(values.begin(), values.end(), 0.0) /
                       static_cast<double>(values.size()),
               .greatest = greatest,
               .counts = std::vector<int>(measure.edges.size() + 1, 0)};
  for (const double x : values) {
    const auto bin = std::ranges::upper_bound(measure.edges, x);
    ++s.counts[bin - measure.edges.begin()];
  }
  return s;
}

/// "< 0", "0 to 0.2", ..., ">= 0.9"
std::string bin_name(const std::vector<double>& edges, std::size_t bin)
{
  if (bin == 0) return fmt::format("< {}", edges.front());
  if (bin == edges.size()) return fmt::format(">= {}", edges.back());
  return fmt::format("{} to {}", edges[bin - 1], edges[bin]);
}

std::string histogram(const Measure& measure, const Statistics& s)
{
  constexpr int width = 40;
  const int most = std::ranges::max(s.counts);
  std::string text = fmt::format("\n{}\n", measure.name);
  for (std::size_t bin = 0; bin < s.counts.size(); ++bin) {
    const auto n = static_cast<std::size_t>(std::int64_t(width) * s.counts[bin] / most);
    const std::string bar(s.counts[bin] > 0 ? std::max<std::size_t>(n, 1) : 0, '#');
    text += fmt::format("  {:>12} {:>8}  {}\n", bin_name(measure.edges, bin), s.counts[bin], bar);
  }
  return text;
}

}  // namespace

std::string quality_text(const std::vector<mesh::ElementQuality>& elements)
{
  if (elements.empty())
    return "no shells, whose shapes are measured; solids are checked at their integration points\n";
  TextTable table{.header = {"shape of the elements", "min", "mean", "max"}, .rows = {}};
  std::string histograms;
  for (const Measure& measure : measures()) {
    const Statistics s = statistics(elements, measure);
    table.rows.push_back({measure.name, fmt::format("{:.4f}", s.least),
                          fmt::format("{:.4f}", s.mean), fmt::format("{:.4f}", s.greatest)});
    histograms += histogram(measure, s);
  }
  std::vector<std::int64_t> numbers = mesh::unusable(elements);
  std::string text = format_table(table) + histograms;
  text += fmt::format("\nelements that cannot work: {}", numbers.size());
  if (numbers.empty()) return text + "\n";
  const bool more = numbers.size() > 10;
  numbers.resize(std::min<std::size_t>(numbers.size(), 10));
  return text + fmt::format(": {}{}\n", fmt::join(numbers, ", "), more ? ", ..." : "");
}

std::vector<Json::Member> quality_json(const std::vector<mesh::ElementQuality>& elements)
{
  std::vector<Json::Member> of_measures;
  for (const Measure& measure : measures()) {
    if (elements.empty()) break;  // lines alone
    const Statistics s = statistics(elements, measure);
    of_measures.emplace_back(
        measure.key,
        Json::object({{"min", s.least},
                      {"mean", s.mean},
                      {"max", s.greatest},
                      {"bin_edges", Json::array({measure.edges.begin(), measure.edges.end()})},
                      {"counts", Json::array({s.counts.begin(), s.counts.end()})}}));
  }
  const std::vector<std::int64_t> numbers = mesh::unusable(elements);
  return {{"quality", Json::object(of_measures)},
          {"unusable_elements", Json::array({numbers.begin(), numbers.end()})}};
}

}  // namespace chladni::report
