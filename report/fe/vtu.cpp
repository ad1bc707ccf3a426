#include "report/fe/vtu.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "report/page/base64.hpp"

namespace chladni::report {
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
  }
  return 0;
}

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

}  // namespace chladni::report
