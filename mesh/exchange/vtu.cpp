#include "mesh/exchange/vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "common/error.hpp"
#include "mesh/exchange/vtu_arrays.hpp"

namespace chladni::mesh {
namespace {

struct CellType {
  Shape shape;
  int order;
};

/// The order of a triangle, quadrilateral or line with so many nodes, up to 4; 0 for other numbers.
int order_of(Shape shape, std::size_t n_nodes)
{
  for (std::size_t p = 1; p <= 4; ++p) {
    const std::size_t n = shape == Shape::line       ? p + 1
                          : shape == Shape::triangle ? (p + 1) * (p + 2) / 2
                                                     : (p + 1) * (p + 1);
    if (n == n_nodes) return static_cast<int>(p);
  }
  return 0;
}

/// By VTK's number; nothing for what is neither line nor surface.
std::optional<CellType> cell_type(std::int64_t type, std::size_t n_nodes)
{
  switch (type) {
    case 3:
      return CellType{Shape::line, 1};
    case 21:
      return CellType{Shape::line, 2};
    case 35:
      return CellType{Shape::line, 3};
    case 68:
      return CellType{Shape::line, order_of(Shape::line, n_nodes)};
    case 5:
      return CellType{Shape::triangle, 1};
    case 22:
      return CellType{Shape::triangle, 2};
    case 69:
      return CellType{Shape::triangle, order_of(Shape::triangle, n_nodes)};
    case 9:
      return CellType{Shape::quadrilateral, 1};
    case 23:
    case 28:
      return CellType{Shape::quadrilateral, 2};
    case 70:
      return CellType{Shape::quadrilateral, order_of(Shape::quadrilateral, n_nodes)};
    default:
      return std::nullopt;
  }
}

[[noreturn]] void refuse_cell(std::size_t cell, std::int64_t type)
{
  static const std::set<std::int64_t> solids{10, 11, 12, 13, 14, 15, 16, 24, 25, 26, 27, 29, 32, 33,
                                             37, 41, 42, 63, 64, 65, 66, 67, 71, 72, 73, 74, 78};
  if (solids.contains(type))
    throw Error(fmt::format("cell {} (type {} of VTK) is {}", cell, type, solids_are_not_read));
  throw Error(
      fmt::format("cell {} is of type {} of VTK; vertices, lines, triangles and quadrilaterals of "
                  "order 1 to 4 are known (types 1, 3, 5, 9, 21, 22, 23, 28, 35, 68, 69, 70)",
                  cell, type));
}

class Reader {
 public:
  explicit Reader(VtuPiece piece) : piece_(std::move(piece)), n_left_out_(piece_.n_texts) {}

  ExchangeMesh read()
  {
    read_points();
    read_cells();
    for (const VtuArray& array : piece_.arrays)
      if (is_data(array)) read_data(array);
    if (n_left_out_ > 0)
      mesh_.notes.push_back(fmt::format("{} arrays that are no groups are left out", n_left_out_));
    return std::move(mesh_);
  }

 private:
  /// What became of a cell: an element, or a set of nodes.
  struct Cell {
    std::optional<std::size_t> element;
    std::vector<std::int64_t> nodes = {};
  };

  const VtuArray& array(const std::string& section, const std::string& name,
                        std::int64_t size) const
  {
    for (const VtuArray& found : piece_.arrays) {
      if (found.section != section || (!name.empty() && found.name != name)) continue;
      if (size >= 0 && static_cast<std::int64_t>(found.size()) != size)
        found.refuse(fmt::format("has {} values instead of {}", found.size(), size));
      return found;
    }
    throw Error(fmt::format("its array {} \"{}\" is missing", section, name));
  }

  const std::vector<std::int64_t>& integers(const std::string& name, std::int64_t size) const
  {
    const VtuArray& found = array("Cells", name, size);
    if (found.is_real) found.refuse("holds real numbers");
    return found.integers;
  }

  void read_points()
  {
    if (piece_.n_points > (std::int64_t{1} << 31))
      throw Error("it has more points than can be counted");
    const VtuArray& points = array("Points", "", 3 * piece_.n_points);
    if (!points.is_real) points.refuse("holds no real numbers");
    for (std::int64_t i = 0; i < piece_.n_points; ++i) {
      const auto at = points.reals.begin() + 3 * i;
      for (int c = 0; c < 3; ++c)
        if (!std::isfinite(at[c])) points.refuse(fmt::format("point {} stands nowhere", i));
      mesh_.nodes.emplace(i + 1, std::array{at[0], at[1], at[2]});
    }
  }

  void read_cells()
  {
    const std::vector<std::int64_t>& offsets = integers("offsets", piece_.n_cells);
    const std::vector<std::int64_t>& types = integers("types", piece_.n_cells);
    const std::vector<std::int64_t>& connectivity = integers("connectivity", -1);
    std::int64_t begin = 0;
    for (std::size_t c = 0; c < offsets.size(); ++c) {
      if (offsets[c] < begin || offsets[c] > static_cast<std::int64_t>(connectivity.size()))
        throw Error(fmt::format("Cells \"offsets\": cell {} ends at {}", c, offsets[c]));
      std::vector<std::int64_t> nodes(connectivity.begin() + begin,
                                      connectivity.begin() + offsets[c]);
      begin = offsets[c];
      for (std::int64_t& node : nodes) {
        if (node < 0 || node >= piece_.n_points)
          throw Error(fmt::format("cell {}: there is no point {}", c, node));
        ++node;
      }
      add_cell(c, types[c], std::move(nodes));
    }
  }

  void add_cell(std::size_t c, std::int64_t type, std::vector<std::int64_t> nodes)
  {
    constexpr std::int64_t vertex = 1, vertices = 2;
    if (type == vertex || type == vertices) {
      cells_.push_back({.element = std::nullopt, .nodes = std::move(nodes)});
      return;
    }
    const auto kind = cell_type(type, nodes.size());
    if (!kind) refuse_cell(c, type);
    if (kind->order == 0)
      throw Error(fmt::format("cell {} has {} nodes; orders 1 to 4 are known", c, nodes.size()));
    cells_.push_back({.element = mesh_.elements.size()});
    mesh_.elements.push_back(
        exchange_element(static_cast<std::int64_t>(c) + 1, kind->shape, kind->order, nodes));
  }

  static constexpr std::string_view mark = "group ";

  static bool is_data(const VtuArray& array)
  {
    return array.section == "PointData" || array.section == "CellData";
  }
  static bool is_marked(const VtuArray& array)
  {
    return is_data(array) && !array.is_real && array.components == 1 &&
           array.name.starts_with(mark);
  }

  void read_data(const VtuArray& array)
  {
    constexpr std::size_t most_values = 256;
    const bool is_of_cells = array.section == "CellData";
    const auto n = static_cast<std::size_t>(is_of_cells ? piece_.n_cells : piece_.n_points);
    if (array.components < 1 || array.size() != n * static_cast<std::size_t>(array.components))
      array.refuse(fmt::format("has {} values for {} cells or points", array.size(), n));
    if (is_marked(array)) return add_group(array, array.name.substr(mark.size()), std::nullopt);
    const bool has_marks = std::ranges::any_of(piece_.arrays, is_marked);
    const std::set<std::int64_t> values(array.integers.begin(), array.integers.end());
    if (has_marks || array.is_real || array.components != 1 || values.size() > most_values) {
      ++n_left_out_;
      return;
    }
    for (const std::int64_t value : values)
      add_group(array, fmt::format("{}_{}", array.name, value), value);
  }

  /// @param value  of the members; nothing: whatever is not 0
  void add_group(const VtuArray& array, const std::string& name, std::optional<std::int64_t> value)
  {
    for (std::size_t i = 0; i < array.integers.size(); ++i) {
      if (value ? array.integers[i] != *value : array.integers[i] == 0) continue;
      if (array.section == "PointData") {
        exchange_group(mesh_, name, Members::nodes).nodes.push_back(std::int64_t(i) + 1);
      } else if (const auto element = cells_[i].element) {
        const bool is_line = mesh_.elements[*element].shape == Shape::line;
        const std::string of_shape = value && is_line ? name + "_lines" : name;
        exchange_group(mesh_, of_shape, Members::elements).elements.push_back(*element);
      } else {
        auto& nodes = exchange_group(mesh_, name, Members::nodes).nodes;
        nodes.insert(nodes.end(), cells_[i].nodes.begin(), cells_[i].nodes.end());
      }
    }
  }

  VtuPiece piece_;
  ExchangeMesh mesh_;
  std::vector<Cell> cells_;
  int n_left_out_;
};

}  // namespace

ExchangeMesh vtu_mesh(const std::string& text)
{
  return Reader(vtu_piece(text)).read();
}

}  // namespace chladni::mesh
