#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>

#include "mbs_export/measured/record_reader.hpp"

namespace chladni::mbs_export {

/// A node as a universal file gives it.
struct UniversalNode {
  Eigen::Vector3d position;               ///< in the unit of the file
  std::int64_t defined_in, displaced_in;  ///< numbers of coordinate systems
};

/// SI units of what a universal file has in 1 (dataset 164).
struct UniversalUnits {
  double metres;   ///< m per unit of length
  double newtons;  ///< N per unit of force
};

/// Nodes (datasets 15 and 2411), units (164), and whether there are coordinate systems (18, 2420).
class UniversalGeometry {
 public:
  /// Reads a dataset that is one of these; returns whether it was.
  /// @throws chladni::Error naming file, line and record for a violation of the format.
  bool take(RecordReader& records, const UniversalDataset& dataset);

  const std::map<std::int64_t, UniversalNode>& nodes() const { return nodes_; }
  const std::optional<UniversalUnits>& units() const { return units_; }
  /// Whether position and directions of the node are in the axes of the model: those of system 0,
  /// and of system 1 unless dataset 18, where tests have the axes of sensors, gives systems.
  bool is_in_global_axes(const UniversalNode& node) const;

 private:
  void add(RecordReader& records, const std::vector<std::int64_t>& label,
           const std::vector<double>& x);
  void read_nodes_15(RecordReader& records, const UniversalDataset& dataset);
  void read_nodes_2411(RecordReader& records);

  std::map<std::int64_t, UniversalNode> nodes_;
  std::optional<UniversalUnits> units_;
  bool has_systems_18_ = false, has_systems_2420_ = false;
};

}  // namespace chladni::mbs_export
