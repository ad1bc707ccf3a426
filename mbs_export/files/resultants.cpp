#include <fmt/format.h>

#include <set>

#include "mbs_export/files/file_parts.hpp"

namespace chladni::mbs_export::file_parts {
namespace {

using Eigen::Index, Eigen::MatrixXd;

void write_one(files::Writer& file, const ResultantModes& resultants)
{
  const std::string group = "resultants/" + link_name(resultants.name) + "/";
  file.write(group + "kinds", resultants.kinds);
  file.write(group + "units", resultants.units);
  file.write(group + "elements", std::span<const std::int64_t>(resultants.elements), "1");
  file.write(group + "positions", MatrixXd(resultants.positions), "m");
  file.write(group + "axes", MatrixXd(resultants.axes), "1");
  file.write(group + "modes", resultants.S, "units of the kinds per unit of each coordinate");
}

/// Frames of unit vectors at right angles, to the digits of a writer of single precision.
void require_orthonormal(const files::Reader& file, const std::string& name,
                         const ResultantModes::Rows& axes)
{
  for (Index i = 0; i < axes.rows(); ++i) {
    const Eigen::Matrix3d e = Eigen::Map<const Eigen::Matrix3d>(axes.row(i).data());
    if ((e.transpose() * e - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-6)
      file.fail(name, fmt::format("is not orthonormal in row {}", i));
  }
}

ResultantModes read_one(const files::Reader& file, const std::string& name, Index n_columns)
{
  const std::string group = "resultants/" + name + "/";
  ResultantModes resultants{.name = name,
                            .kinds = file.texts(group + "kinds"),
                            .units = file.texts(group + "units"),
                            .elements = {},
                            .positions = {},
                            .axes = {},
                            .S = {}};
  const Index n_kinds = Index(resultants.kinds.size());
  if (n_kinds == 0) file.fail(group + "kinds", "names no kind");
  if (Index(resultants.units.size()) != n_kinds) {
    file.fail(group + "units",
              fmt::format("has {} values for {} kinds", resultants.units.size(), n_kinds));
  }
  resultants.positions = file.matrix(group + "positions", {files::any, 3});
  const Index n_points = resultants.positions.rows();
  resultants.elements = file.integers(group + "elements", n_points);
  resultants.axes = file.matrix(group + "axes", {n_points, 9});
  require_orthonormal(file, group + "axes", resultants.axes);
  resultants.S = file.matrix(group + "modes", {n_points * n_kinds, n_columns});
  return resultants;
}

}  // namespace

void write_resultants(files::Writer& file, const std::vector<ResultantModes>& resultants)
{
  if (resultants.empty()) return;
  std::vector<std::string> names;
  for (const ResultantModes& one : resultants) names.push_back(one.name);
  file.write("resultant_names", names);
  for (const ResultantModes& one : resultants) write_one(file, one);
}

std::vector<ResultantModes> read_resultants(const files::Reader& file, Index n_columns)
{
  std::vector<ResultantModes> resultants;
  if (!file.contains("resultant_names")) return resultants;
  std::set<std::string> names;
  for (const std::string& name : file.texts("resultant_names")) {
    if (!names.insert(name).second) file.fail("resultant_names", "names '" + name + "' twice");
    resultants.push_back(read_one(file, name, n_columns));
  }
  return resultants;
}

}  // namespace chladni::mbs_export::file_parts
