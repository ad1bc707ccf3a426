#include "scene/readers.hpp"

namespace chladni::scene {
namespace {

using mbs_export::ResponseModel;
using mbs_export::ResponseOptions;
using mbs_export::ResponsePlace;
using mbs_export::ResponseQuantity;
using mbs_export::Spacing;

ResponseModel read_model(const Table& table, const Scene& scene)
{
  if (!table.has("of")) return ResponseModel::body;
  const auto model = table.choice<ResponseModel>("of", {{"body", ResponseModel::body},
                                                        {"reduced", ResponseModel::reduced},
                                                        {"fe", ResponseModel::fe}});
  if (model != ResponseModel::fe && scene.interface_nodes.empty()) {
    table.refuse(
        "of",
        "this model needs a reduction, but the scene has no [interface]; add it, or take \"fe\"");
  }
  return model;
}

/// Names of what may be loaded or observed; empty where the mesh file was not read yet.
std::vector<std::string> names_in(const Scene& scene, ResponseModel model)
{
  return model == ResponseModel::fe ? named_sets(scene) : scene.interface_nodes;
}

std::vector<ResponsePlace> read_places(const Table& table, std::string_view key, const Scene& scene,
                                       ResponseModel model)
{
  const std::vector<std::string> names = names_in(scene, model);
  const char* const kind =
      model == ResponseModel::fe ? "group, ring or coupling" : "interface node";
  std::vector<ResponsePlace> places;
  for (const Table& one : table.tables(key)) {
    ResponsePlace place{.at = one.text("at"), .components = read_component_list(one, "dofs")};
    if (!names.empty() && !contains(names, place.at))
      one.refuse("at", no_such_name(kind, place.at, names));
    if (one.has("near")) place.near = read_vector(one, "near");
    if (one.has("measured_node")) place.measured_node = one.integer("measured_node");
    places.push_back(std::move(place));
  }
  if (places.empty()) table.refuse(key, "must name a place, as [{ at = \"tip\", dofs = [\"z\"] }]");
  return places;
}

mbs_export::FrequencyRange read_range(const Table& table)
{
  mbs_export::FrequencyRange range{.from_Hz = table.number("from_Hz"),
                                   .to_Hz = table.number("to_Hz"),
                                   .count = table.integer("count")};
  if (table.has("spacing")) {
    range.spacing = table.choice<Spacing>(
        "spacing", {{"linear", Spacing::linear}, {"logarithmic", Spacing::logarithmic}});
  }
  if (!(range.to_Hz > range.from_Hz)) table.refuse("to_Hz", "must be above from_Hz");
  if (range.spacing == Spacing::logarithmic && range.from_Hz == 0.0)
    table.refuse("from_Hz", "must be above 0 for logarithmic spacing");
  return range;
}

std::vector<std::string> read_section_forces(const Table& table, const Scene& scene,
                                             ResponseModel model)
{
  if (!table.has("section_forces")) return {};
  if (model == ResponseModel::fe) {
    table.refuse(
        "section_forces",
        "the FE model has responses of motions only; take this key out, or use the reduced "
        "system");
  }
  std::vector<std::string> groups = table.texts("section_forces");
  const std::vector<std::string>& kept = scene.resultants.groups;
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (!contains(kept, groups[i])) {
      table.refuse_element("section_forces", i,
                           no_such_name("group in reduce.resultants", groups[i], kept));
    }
  return groups;
}

}  // namespace

std::optional<ResponseOptions> read_response(const Table& root, const Scene& scene)
{
  if (!root.has("response")) return std::nullopt;
  const Table table = root.table("response");
  ResponseOptions options{.model = read_model(table, scene), .range = read_range(table)};
  if (table.has("quantity")) {
    options.quantity = table.choice<ResponseQuantity>(
        "quantity", {{"receptance", ResponseQuantity::receptance},
                     {"mobility", ResponseQuantity::mobility},
                     {"accelerance", ResponseQuantity::accelerance}});
  }
  options.loads = read_places(table, "loads", scene, options.model);
  options.outputs = read_places(table, "outputs", scene, options.model);
  if (table.has("loss_factor")) options.loss_factor = table.number("loss_factor");
  options.section_forces = read_section_forces(table, scene, options.model);
  return options;
}

}  // namespace chladni::scene
