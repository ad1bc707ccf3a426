#include "mbs_export/responses/response_dofs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "mbs_export/attachment_motion.hpp"
#include "mbs_export/responses/response_option_error.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Vector3d;

/// A place of the scene with the keys that name it.
struct KeyedPlace {
  const ResponsePlace& place;
  std::string key;  ///< "loads[1]"
};

const AttachmentSet& set_of(const NamedNodes& model, const KeyedPlace& asked)
{
  const auto found = std::ranges::find(model.sets, asked.place.at, &AttachmentSet::name);
  if (found == model.sets.end()) {
    std::vector<std::string> names;
    for (const AttachmentSet& set : model.sets) names.push_back(set.name);
    throw ResponseOptionError(
        asked.key + ".at",
        fmt::format("the model has no nodes of this name; there are {}", fmt::join(names, ", ")));
  }
  if (found->nodes.empty()) throw ResponseOptionError(asked.key + ".at", "the set has no nodes");
  return *found;
}

/// The node of a set that is nearest to the place.
int nearest(const NamedNodes& model, const AttachmentSet& set, const KeyedPlace& asked)
{
  const Vector3d x{(*asked.place.near)[0], (*asked.place.near)[1], (*asked.place.near)[2]};
  const auto distance = [&](int node) {
    return (model.nodes[static_cast<std::size_t>(node)].position - x).norm();
  };
  const int best = *std::ranges::min_element(set.nodes, {}, distance);
  constexpr double alike = 1.0 + 1e-6;
  for (const int node : set.nodes) {
    if (node == best || distance(node) > alike * distance(best)) continue;
    throw ResponseOptionError(
        asked.key + ".near",
        fmt::format("nodes {} and {} of \"{}\" are equally near, {:.4g} m; move it towards one",
                    model.nodes[static_cast<std::size_t>(best)].number,
                    model.nodes[static_cast<std::size_t>(node)].number, set.name, distance(best)));
  }
  return best;
}

std::vector<int> nodes_of(const NamedNodes& model, const KeyedPlace& asked)
{
  const AttachmentSet& set = set_of(model, asked);
  if (!asked.place.near) return set.nodes;
  return {nearest(model, set, asked)};
}

/// "track.z", and which of its nodes where the set has others.
std::string name_of(const NamedNodes& model, const KeyedPlace& asked, int component, int node)
{
  const std::string name = fmt::format("{}.{}", asked.place.at, component_name(component));
  if (set_of(model, asked).nodes.size() == 1) return name;
  return fmt::format("{} (node {})", name, model.nodes[static_cast<std::size_t>(node)].number);
}

/// A moment about the normal of a shell acts on a stiffness that elements invent.
void refuse_drilling_moment(const NamedNodes& model, const ResponseDof& load)
{
  if (load.component < 3) return;
  for (const int node : load.nodes) {
    const AttachmentNode& one = model.nodes[static_cast<std::size_t>(node)];
    constexpr double tilt = 1e-2;  // rad, as is_drilling
    if (std::abs(one.drilling_axis[load.component - 3]) <= tilt) continue;
    throw ResponseOptionError(
        load.key,
        fmt::format("the moment {} turns node {} about the normal of a shell, which only a "
                    "numerical stiffness resists; load a coupling, or another component",
                    load.name, one.number));
  }
}

void refuse_twins(const std::vector<ResponseDof>& dofs)
{
  std::set<std::string> names;
  for (const ResponseDof& dof : dofs)
    if (!names.insert(dof.name).second)
      throw ResponseOptionError(dof.key, fmt::format("{} is asked for twice", dof.name));
}

}  // namespace

std::vector<ResponseDof> response_loads(const NamedNodes& model,
                                        const std::vector<ResponsePlace>& places)
{
  std::vector<ResponseDof> loads;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const KeyedPlace asked{places[i], fmt::format("loads[{}]", i + 1)};
    const std::vector<int> nodes = nodes_of(model, asked);
    for (const int component : asked.place.components) {
      const std::string name =
          nodes.size() == 1 ? name_of(model, asked, component, nodes.front())
                            : fmt::format("{}.{}", asked.place.at, component_name(component));
      loads.push_back({name, asked.key + ".dofs", component, nodes, asked.place.measured_node});
      refuse_drilling_moment(model, loads.back());
    }
  }
  refuse_twins(loads);
  return loads;
}

std::vector<ResponseDof> response_outputs(const NamedNodes& model,
                                          const std::vector<ResponsePlace>& places)
{
  std::vector<ResponseDof> outputs;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const KeyedPlace asked{places[i], fmt::format("outputs[{}]", i + 1)};
    const std::vector<int> nodes = nodes_of(model, asked);
    if (asked.place.measured_node && nodes.size() > 1) {
      throw ResponseOptionError(
          asked.key + ".measured_node",
          fmt::format("\"{}\" has {} nodes, and one node was measured; choose "
                      "the nearest by `near`",
                      asked.place.at, nodes.size()));
    }
    for (const int node : nodes)
      for (const int component : asked.place.components) {
        outputs.push_back({name_of(model, asked, component, node),
                           asked.key + ".dofs",
                           component,
                           {node},
                           asked.place.measured_node});
      }
  }
  refuse_twins(outputs);
  return outputs;
}

}  // namespace chladni::mbs_export
