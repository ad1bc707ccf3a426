#include "mbs_export/measured/universal_geometry.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "common/error.hpp"

namespace chladni::mbs_export {
namespace {

/// Record 2 of dataset 164 has what divides lengths, forces and temperatures of the file.
UniversalUnits read_units(RecordReader& records)
{
  records.line("units");
  const std::vector<double> per_si =
      records.reals("factors of length, force and temperature", 3, 25, 3);
  if (!(per_si[0] > 0.0)) records.fail("the factor of lengths is not positive");
  if (!(per_si[1] > 0.0)) records.fail("the factor of forces is not positive");
  return {1.0 / per_si[0], 1.0 / per_si[1]};
}

}  // namespace

bool UniversalGeometry::take(RecordReader& records, const UniversalDataset& dataset)
{
  switch (dataset.number) {
    case 15:
      read_nodes_15(records, dataset);
      return true;
    case 2411:
      read_nodes_2411(records);
      return true;
    case 164:
      units_ = read_units(records);
      return true;
    case 18:
      has_systems_18_ = true;
      return true;
    case 2420:
      has_systems_2420_ = true;
      return true;
    default:
      return false;
  }
}

bool UniversalGeometry::is_in_global_axes(const UniversalNode& node) const
{
  const auto is_global = [&](std::int64_t system) {
    return system == 0 || (system == 1 && !has_systems_18_);
  };
  const bool has_systems = has_systems_18_ || has_systems_2420_;
  return !has_systems || (is_global(node.defined_in) && is_global(node.displaced_in));
}

void UniversalGeometry::add(RecordReader& records, const std::vector<std::int64_t>& label,
                            const std::vector<double>& x)
{
  const UniversalNode node{{x[0], x[1], x[2]}, label[1], label[2]};
  if (!nodes_.emplace(label[0], node).second)
    records.fail(fmt::format("node {} is there twice", label[0]));
}

/// A line for each node, 4I10, 3E13.5.
void UniversalGeometry::read_nodes_15(RecordReader& records, const UniversalDataset& dataset)
{
  constexpr std::size_t columns = 40;
  for (const std::string& line : dataset.lines) {
    const std::vector<std::int64_t> label = records.integers("a node", 4);
    UniversalDataset place{dataset.number, dataset.first_line, {}};
    place.lines.push_back(line.size() > columns ? line.substr(columns) : "");
    const std::filesystem::path nowhere;
    RecordReader coordinates(nowhere, place);
    try {
      add(records, label, coordinates.reals("coordinates", 3, 13, 3));
    } catch (const Error&) {
      records.fail(
          "expected four whole numbers of 10 columns and three coordinates of 13, of a node "
          "that is there once");
    }
  }
}

/// Two lines for each node, 4I10 and 3D25.16.
void UniversalGeometry::read_nodes_2411(RecordReader& records)
{
  while (!records.at_end()) {
    const std::vector<std::int64_t> label = records.integers("a node", 4);
    add(records, label, records.reals("coordinates", 3, 25, 3));
  }
}

}  // namespace chladni::mbs_export
