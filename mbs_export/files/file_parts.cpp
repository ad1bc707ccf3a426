#include "mbs_export/files/file_parts.hpp"

#include <fmt/format.h>

#include <limits>
#include <set>

#include "common/error.hpp"

namespace chladni::mbs_export::file_parts {

using Eigen::Index;

void write_attachment(files::Writer& file, const std::vector<AttachmentNode>& nodes,
                      const std::vector<AttachmentSet>& sets)
{
  std::vector<std::int64_t> numbers;
  Eigen::MatrixXd positions(Index(nodes.size()), 3), axes(Index(nodes.size()), 3);
  for (const AttachmentNode& node : nodes) {
    positions.row(Index(numbers.size())) = node.position;
    axes.row(Index(numbers.size())) = node.drilling_axis;
    numbers.push_back(node.number);
  }
  std::vector<std::string> names;
  for (const AttachmentSet& set : sets) names.push_back(link_name(set.name));
  file.write("attachment/node_numbers", std::span<const std::int64_t>(numbers), "1");
  file.write("attachment/node_positions", positions, "m");
  if (!axes.isZero(0.0)) file.write("attachment/drilling_axes", axes, "1");
  file.write("attachment/set_names", names);
  for (const AttachmentSet& set : sets)
    file.write("attachment/sets/" + set.name, std::span<const int>(set.nodes), "1");
}

Attachment read_attachment(const files::Reader& file)
{
  Attachment attachment;
  const auto numbers = file.integers("attachment/node_numbers");
  const Index n = Index(numbers.size());
  const Eigen::MatrixXd positions = file.matrix("attachment/node_positions", {n, 3});
  const Eigen::MatrixXd axes = file.contains("attachment/drilling_axes")
                                   ? file.matrix("attachment/drilling_axes", {n, 3})
                                   : Eigen::MatrixXd::Zero(n, 3);
  for (Index i = 0; i < n; ++i) {
    attachment.nodes.push_back(
        {numbers[static_cast<std::size_t>(i)], positions.row(i), axes.row(i)});
  }
  std::set<std::string> names;
  for (const std::string& name : file.texts("attachment/set_names")) {
    if (!names.insert(name).second) file.fail("attachment/set_names", "names '" + name + "' twice");
    attachment.sets.push_back({name, read_indices(file, "attachment/sets/" + name, n)});
  }
  return attachment;
}

void write_picture(files::Writer& file, const Picture& picture)
{
  if (picture.positions.rows() == 0) return;
  files::IntegerMatrix cells(Index(picture.cells.size()), 4);
  for (Index i = 0; i < cells.rows(); ++i)
    for (Index k = 0; k < 4; ++k)
      cells(i, k) = picture.cells[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
  file.write("picture/positions", picture.positions, "m");
  file.write("picture/cells", cells, "1");
  if (picture.transformation.size() > 0)
    file.write("picture/displacements", picture.transformation, "m per unit of each coordinate");
}

Picture read_surface(const files::Reader& file)
{
  if (!file.contains("picture")) return {};
  Picture picture;
  picture.positions = file.matrix("picture/positions", {files::any, 3});
  const Index n = picture.positions.rows();
  const files::IntegerMatrix cells = file.integer_matrix("picture/cells", {files::any, 4});
  if (cells.size() > 0 && (cells.minCoeff() < 0 || cells.maxCoeff() >= n))
    file.fail("picture/cells", fmt::format("has a corner outside 0 .. {}", n - 1));
  for (Index i = 0; i < cells.rows(); ++i) {
    picture.cells.push_back(
        {int(cells(i, 0)), int(cells(i, 1)), int(cells(i, 2)), int(cells(i, 3))});
  }
  return picture;
}

Picture read_picture(const files::Reader& file, Index n_columns)
{
  Picture picture = read_surface(file);
  if (file.contains("picture")) {
    picture.transformation =
        file.matrix("picture/displacements", {3 * picture.positions.rows(), n_columns});
  }
  return picture;
}

void write_sector_harmonics(files::Writer& file, const std::optional<SectorHarmonics>& harmonics)
{
  if (!harmonics) return;
  file.write("sectors/count", std::int64_t{harmonics->n_sectors}, "1");
  file.write("sectors/harmonics", std::span<const int>(harmonics->order), "1");
}

std::optional<SectorHarmonics> read_sector_harmonics(const files::Reader& file, Index n)
{
  if (!file.contains("sectors")) return std::nullopt;
  SectorHarmonics harmonics{.n_sectors = read_count(file, "sectors/count"), .order = {}};
  if (harmonics.n_sectors < 3)
    file.fail("sectors/count", fmt::format("is {}, expected 3 or more", harmonics.n_sectors));
  const int largest = harmonics.n_sectors / 2;
  for (const std::int64_t order : file.integers("sectors/harmonics", n)) {
    if (order < -1 || order > largest) {
      file.fail("sectors/harmonics",
                fmt::format("has the harmonic {}, expected -1 .. {}", order, largest));
    }
    harmonics.order.push_back(static_cast<int>(order));
  }
  return harmonics;
}

std::vector<int> read_indices(const files::Reader& file, const std::string& name, Index limit,
                              Index size)
{
  std::vector<int> indices;
  for (const std::int64_t i : file.integers(name, size)) {
    if (i < 0 || i >= limit)
      file.fail(name, fmt::format("has the index {}, expected 0 .. {}", i, limit - 1));
    indices.push_back(static_cast<int>(i));
  }
  return indices;
}

int read_count(const files::Reader& file, const std::string& name)
{
  const std::int64_t count = file.integer(name);
  if (count < 0 || count > std::numeric_limits<int>::max())
    file.fail(name, fmt::format("is {}, expected a count", count));
  return static_cast<int>(count);
}

const std::string& link_name(const std::string& name)
{
  if (name.empty() || name == "." || name.find('/') != std::string::npos) {
    throw Error(
        fmt::format("'{}' cannot name a set in a file; use letters, digits, _ and -", name));
  }
  return name;
}

}  // namespace chladni::mbs_export::file_parts
