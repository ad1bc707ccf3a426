#include "report/fe/mesh_page.hpp"

#include <span>

#include "report/fe/mesh_drawing.hpp"
#include "report/page/numbers.hpp"
#include "report/page/page.hpp"
#include "report/version.hpp"

namespace chladni::report {
namespace {

/// What the page says of a drawing that leaves something out.
std::string said_of(Detail detail)
{
  switch (detail) {
    case Detail::lattice:
      return "";
    case Detail::corners:
      return "Elements are drawn by their corners alone, to keep this page small.";
    case Detail::clusters:
      break;
  }
  return "Drawn coarser than the mesh is, to keep this page small: corners near to each other are "
         "one. The .vtu file has all elements.";
}

Json group_json(const mesh::Group& group, const GroupParts& parts, const GroupDrawing& drawing)
{
  std::vector<Json> extents;
  for (const std::array<double, 2>& range : parts.extents)
    extents.push_back(rounded(std::span(range)));
  return Json::object({{"name", group.name},
                       {"kind", name_of(parts.kind)},
                       {"n_nodes", group.nodes.size()},
                       {"size", rounded(parts.size)},
                       {"extents", Json::array(extents)},
                       {"lines", packed(drawing.lines)},
                       {"points", packed(drawing.points)}});
}

}  // namespace

std::string mesh_page(const std::string& title, const mesh::Mesh& mesh,
                      const std::vector<GroupParts>& parts, const TextTable& summary)
{
  const MeshDrawing drawing = draw_mesh(mesh, parts);
  std::vector<Json> groups;
  for (std::size_t g = 0; g < parts.size(); ++g)
    groups.push_back(group_json(mesh.groups[g], parts[g], drawing.groups[g]));
  const Json picture = Json::object({{"positions", packed(drawing.positions)},
                                     {"cells", packed(drawing.cells)},
                                     {"group_of_cell", packed(drawing.group_of_cell)},
                                     {"edges", packed(drawing.edges)},
                                     {"said", said_of(drawing.detail)}});
  const Json content = Json::object({{"title", title},
                                     {"version", version},
                                     {"drawing", picture},
                                     {"groups", Json::array(groups)},
                                     {"tables", Json::array({table_json("Mesh", summary)})},
                                     {"mesh_checksum", mesh::checksum(mesh)}});
  return report_page(title, content, "null");
}

}  // namespace chladni::report
