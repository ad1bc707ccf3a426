#include "mbs_export/reduced_system.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/error.hpp"

namespace chladni::mbs_export {

const AttachmentSet& find_set(const ReducedSystem& reduced, const std::string& name)
{
  const auto found = std::ranges::find(reduced.sets, name, &AttachmentSet::name);
  if (found != reduced.sets.end()) return *found;
  std::vector<std::string> names;
  for (const AttachmentSet& set : reduced.sets) names.push_back("'" + set.name + "'");
  throw Error(fmt::format("no attachment set '{}'; there is {}", name,
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

Picture picture_in(const ReducedSystem& reduced, const Eigen::MatrixXd& T)
{
  const auto& [positions, cells, transformation] = reduced.picture;
  if (positions.rows() == 0) return {};
  if (reduced.picture_of_sectors)
    return {positions, cells, in_coordinates(*reduced.picture_of_sectors, T)};
  return {positions, cells, transformation * T};
}

}  // namespace chladni::mbs_export
