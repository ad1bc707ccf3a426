#include <fmt/format.h>

#include "mbs_export/files/file_parts.hpp"

namespace chladni::mbs_export::file_parts {

using Eigen::Index, Eigen::MatrixXd;

namespace {

const std::string unit = "m per unit of each coordinate";

Index n_columns_of(const SectorMotions& motions)
{
  Index n = 0;
  for (const SectorMotions::Harmonic& h : motions.harmonics) n += h.x.cols();
  return n;
}

std::vector<int> read_orders(const files::Reader& file, int n_sectors)
{
  const std::string name = "picture/sectors/harmonics";
  std::vector<int> orders;
  for (const std::int64_t order : file.integers(name)) {
    const int last = orders.empty() ? 0 : orders.back();
    if (order < last || order > n_sectors / 2)
      file.fail(name, fmt::format("has {}, expected {} .. {} there", order, last, n_sectors / 2));
    orders.push_back(static_cast<int>(order));
  }
  return orders;
}

}  // namespace

void write_sector_motions(files::Writer& file, const std::optional<SectorMotions>& motions)
{
  if (!motions) return;
  const Index n = n_columns_of(*motions);
  MatrixXd x(motions->rows_of_sector(), n), y(motions->rows_of_sector(), n);
  std::vector<int> orders;
  std::vector<std::int64_t> coordinates;
  for (const SectorMotions::Harmonic& h : motions->harmonics) {
    x.middleCols(Index(orders.size()), h.x.cols()) = h.x;
    y.middleCols(Index(orders.size()), h.y.cols()) = h.y;
    orders.insert(orders.end(), h.columns.size(), h.order);
    coordinates.insert(coordinates.end(), h.columns.begin(), h.columns.end());
  }
  file.write("picture/sectors/count", std::int64_t{motions->n_sectors}, "1");
  file.write("picture/sectors/harmonics", std::span<const int>(orders), "1");
  file.write("picture/sectors/coordinates", std::span<const std::int64_t>(coordinates), "1");
  file.write("picture/sectors/x", x, unit);
  file.write("picture/sectors/y", y, unit);
  if (motions->T.size() > 0) file.write("picture/sectors/transformation", motions->T, "1");
}

std::optional<SectorMotions> read_sector_motions(const files::Reader& file, Index n_points,
                                                 Index n_columns)
{
  if (!file.contains("picture/sectors")) return std::nullopt;
  SectorMotions motions{.n_sectors = read_count(file, "picture/sectors/count"),
                        .n_coordinates = n_columns,
                        .harmonics = {}};
  if (motions.n_sectors < 3 || n_points % motions.n_sectors != 0) {
    file.fail("picture/sectors/count",
              fmt::format("is {}, of a picture of {} nodes", motions.n_sectors, n_points));
  }
  const std::vector<int> orders = read_orders(file, motions.n_sectors);
  if (orders.empty()) file.fail("picture/sectors/harmonics", "is empty");
  const Index n = Index(orders.size()), n_rows = 3 * n_points / motions.n_sectors;
  const std::vector<int> coordinates =
      read_indices(file, "picture/sectors/coordinates", n_columns, n);
  const MatrixXd x = file.matrix("picture/sectors/x", {n_rows, n}),
                 y = file.matrix("picture/sectors/y", {n_rows, n});
  for (Index first = 0, last = 0; first < n; first = last) {
    const int order = orders[std::size_t(first)];
    while (last < n && orders[std::size_t(last)] == order) ++last;
    motions.harmonics.push_back(
        {.order = order,
         .x = x.middleCols(first, last - first),
         .y = y.middleCols(first, last - first),
         .columns = {coordinates.begin() + first, coordinates.begin() + last}});
  }
  if (file.contains("picture/sectors/transformation"))
    motions.T = file.matrix("picture/sectors/transformation", {n_columns, n_columns});
  return motions;
}

}  // namespace chladni::mbs_export::file_parts
