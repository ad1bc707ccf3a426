#include "mesh/gmsh/gmsh.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>

#include "common/error.hpp"
#include "mesh/element_types.hpp"
#include "mesh/mesh_repair.hpp"
#include "mesh/quality.hpp"

namespace chladni::mesh {

namespace {

/// Gmsh is a process-wide singleton: one session at a time, closed also when an error leaves it.
class Session {
 public:
  /// Without the user's ~/.gmshrc, for the same mesh everywhere.
  Session() { gmsh::initialize(0, nullptr, false); }
  ~Session()
  {
    gmsh::model::mesh::removeSizeCallback();  // of set_local_sizes; it would outlive the session
    gmsh::finalize();
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

void set_meshing_options()
{
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::option::setNumber("General.AbortOnError", 0);
  // Frontal-Delaunay with Blossom recombination is nearly free of triangles on discs. Algorithm 8
  // (frontal-Delaunay for quads) crashes in Gmsh 4.8.4 on a circle of 60 arcs.
  gmsh::option::setNumber("Mesh.Algorithm", 6);
  gmsh::option::setNumber("Mesh.RecombineAll", 1);
  gmsh::option::setNumber("Mesh.RecombinationAlgorithm", 1);
  gmsh::option::setNumber("Mesh.ElementOrder", 1);
  gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 0);
}

/// A type of element of Gmsh, and the element of ours that it is or becomes.
struct ElementType {
  Shape shape;
  int order;
  int n_nodes;               ///< that Gmsh lists
  std::vector<int> lattice;  ///< Gmsh's place of each node of our order, -1 where it has none
};

/// A line has its nodes from end to end.
/// @param local  parent coordinates of Gmsh's nodes, from -1 to 1
ElementType line_type(ElementType line, const std::vector<double>& local)
{
  line.shape = Shape::line;
  line.lattice.resize(local.size());
  for (std::size_t k = 0; k < local.size(); ++k) {
    const auto place = static_cast<std::size_t>(std::lround((local[k] + 1.0) / 2.0 * line.order));
    line.lattice[place] = static_cast<int>(k);
  }
  return line;
}

/// A solid has nodes at its corners and on its edges; those of faces and of the inside are left
/// out.
/// @param local  parent coordinates of Gmsh's nodes
/// @param what   element and type, for an error
ElementType solid_type(ElementType solid, int n_primary, const std::string& what,
                       const std::vector<double>& local)
{
  const std::map<int, Shape> shapes{
      {4, Shape::tetrahedron}, {6, Shape::wedge}, {8, Shape::hexahedron}};
  const auto shape = shapes.find(n_primary);
  if (shape == shapes.end() || solid.order > 3) {
    throw Error(fmt::format(
        "{}; Chladni takes hexahedra of order 1 to 3, tetrahedra of order 1 and 2, and wedges of "
        "order 2: mesh the volume there with tetrahedra",
        what));
  }
  solid.shape = shape->second;
  constexpr double near = 1e-6;
  for (const std::array<double, 3>& wanted : solid_nodes(solid.shape, solid.order)) {
    for (int k = 0; k < solid.n_nodes; ++k) {
      const std::size_t at = 3 * std::size_t(k);
      if (std::abs(local[at] - wanted[0]) + std::abs(local[at + 1] - wanted[1]) +
              std::abs(local[at + 2] - wanted[2]) <
          near)
        solid.lattice.push_back(k);
    }
  }
  return solid;
}

/// @param first  number of an element of the type, for an error
ElementType element_type(int type, std::size_t first)
{
  std::string name;
  int dimension = 0;
  ElementType element{};
  int n_primary = 0;
  std::vector<double> local;  // parent coordinates, `dimension` for each node
  gmsh::model::mesh::getElementProperties(type, name, dimension, element.order, element.n_nodes,
                                          local, n_primary);
  if (dimension == 1) return line_type(element, local);
  const std::string what = fmt::format("element {} is of the type \"{}\"", first, name);
  if (dimension == 3) return solid_type(element, n_primary, what, local);
  if (n_primary < 3 || n_primary > 4 || element.order > 4) {
    throw Error(
        fmt::format("{}; Chladni takes triangles and quadrilaterals of order 1 to 4", what));
  }
  const bool quadrilateral = n_primary == 4;
  const int p = element.order;
  element.shape = quadrilateral ? Shape::quadrilateral : Shape::triangle;
  std::map<std::pair<int, int>, int> place;  // (row, column) -> Gmsh's index
  for (int k = 0; k < element.n_nodes; ++k) {
    const auto lattice = [&](double x) {
      return static_cast<int>(std::lround((quadrilateral ? (x + 1.0) / 2.0 : x) * p));
    };
    place[{lattice(local[2 * k + 1]), lattice(local[2 * k])}] = k;
  }
  for (int row = 0; row <= p; ++row) {
    for (int column = 0; column <= (quadrilateral ? p : p - row); ++column) {
      const auto found = place.find({row, column});
      element.lattice.push_back(found == place.end() ? -1 : found->second);
    }
  }
  return element;
}

std::vector<std::pair<int, int>> physical_entities(int dimension)
{
  std::vector<std::pair<int, int>> tags;
  gmsh::model::getPhysicalGroups(tags, dimension);
  return tags;
}

std::string physical_name(int dimension, int tag)
{
  std::string name;
  gmsh::model::getPhysicalName(dimension, tag, name);
  return name.empty() ? fmt::format("{}", tag) : name;
}

using NodeIndex = std::unordered_map<std::size_t, int>;

NodeIndex read_nodes(Mesh& mesh)
{
  std::vector<std::size_t> tags;
  std::vector<double> coordinates;
  std::vector<double> parametric;
  gmsh::model::mesh::getNodes(tags, coordinates, parametric, -1, -1, false, false);
  std::vector<std::size_t> order(tags.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return tags[i]; });
  NodeIndex index;
  for (const std::size_t i : order) {
    if (!index.emplace(tags[i], mesh.n_nodes()).second) continue;
    mesh.node_numbers.push_back(static_cast<std::int64_t>(tags[i]));
    mesh.positions.push_back({coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]});
  }
  return index;
}

/// (dimension, tag) of the entities with elements -> index of their physical group in mesh.groups:
/// surfaces and the curves of the line groups. The group with a section counts, else the first one.
using GroupOfEntity = std::map<std::pair<int, int>, int>;

/// Physical groups of one dimension and one name, which are one group.
struct NamedGroup {
  int dimension;
  std::string name;
  std::vector<int> tags;
};

/// The groups of all dimensions. Where groups of several dimensions have one name, that of the
/// highest keeps it, and the others are called NAME_lines and NAME_nodes.
std::vector<NamedGroup> named_groups(std::vector<std::string>& notes)
{
  constexpr std::array suffixes{"_nodes", "_lines", "_faces", ""};
  constexpr std::array entities{"points", "curves", "surfaces", "volumes"};
  std::vector<NamedGroup> groups;
  for (int dimension = 0; dimension <= 3; ++dimension) {
    for (const auto& [dim, tag] : physical_entities(dimension)) {
      const std::string name = physical_name(dim, tag);
      const auto same = std::ranges::find_if(groups, [&](const NamedGroup& group) {
        return group.dimension == dimension && group.name == name;
      });
      if (same == groups.end())
        groups.push_back({dimension, name, {tag}});
      else
        same->tags.push_back(tag);
    }
  }
  for (NamedGroup& group : groups) {
    const auto is_higher = [&](const NamedGroup& other) {
      return other.name == group.name && other.dimension > group.dimension;
    };
    if (std::ranges::none_of(groups, is_higher)) continue;
    const std::string name = group.name;
    while (std::ranges::count(groups, group.name, &NamedGroup::name) > 1)
      group.name += suffixes[std::size_t(group.dimension)];
    notes.push_back(fmt::format("the group \"{}\" of {} is called \"{}\" here", name,
                                entities[std::size_t(group.dimension)], group.name));
  }
  return groups;
}

bool has_name(const std::vector<std::string>& names, const std::string& name)
{
  return std::ranges::find(names, name) != names.end();
}

/// A group with the nodes of its entities, ascending.
Group nodes_of(const NamedGroup& named, const NodeIndex& index)
{
  Group group{.name = named.name, .dimension = named.dimension, .nodes = {}};
  for (const int tag : named.tags) {
    std::vector<std::size_t> tags;
    std::vector<double> coordinates;
    gmsh::model::mesh::getNodesForPhysicalGroup(named.dimension, tag, tags, coordinates);
    for (const std::size_t t : tags) group.nodes.push_back(index.at(t));
  }
  std::ranges::sort(group.nodes);
  group.nodes.erase(std::unique(group.nodes.begin(), group.nodes.end()), group.nodes.end());
  return group;
}

/// Puts the entities of a group into it, unless another one with a section has them.
/// @param with_section  names of the groups with a section
void take_entities(const Mesh& mesh, const NamedGroup& named,
                   const std::vector<std::string>& with_section, GroupOfEntity& group_of_entity)
{
  const auto group = static_cast<int>(mesh.groups.size());
  for (const int tag : named.tags) {
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(named.dimension, tag, entities);
    for (const int e : entities) {
      const auto [taken, is_new] = group_of_entity.emplace(std::pair{named.dimension, e}, group);
      if (is_new || taken->second == group || !has_name(with_section, named.name)) continue;
      const std::string& other = mesh.groups[std::size_t(taken->second)].name;
      if (has_name(with_section, other)) {
        throw Error(fmt::format(
            "{} {} is in the groups \"{}\" and \"{}\", which have a section each; take it out of "
            "one",
            named.dimension == 1   ? "curve"
            : named.dimension == 2 ? "surface"
                                   : "volume",
            e, other, named.name));
      }
      taken->second = group;
    }
  }
}

/// @return number of elements of this dimension
std::size_t n_elements(int dimension)
{
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> numbers;
  std::vector<std::vector<std::size_t>> nodes;
  gmsh::model::mesh::getElements(types, numbers, nodes, dimension, -1);
  std::size_t n = 0;
  for (const auto& of_type : numbers) n += of_type.size();
  return n;
}

/// Whether the model is one of solids: a section is, or there are some, and no section says of what
/// the mesh is.
bool is_of_solids(const MeshOptions& options)
{
  if (!options.solid_groups.empty()) return true;
  return options.shell_groups.empty() && options.line_groups.empty() && n_elements(3) > 0;
}

GroupOfEntity read_groups(Mesh& mesh, const NodeIndex& index, const MeshOptions& options)
{
  const int of_body = is_of_solids(options) ? 3 : 2;
  GroupOfEntity group_of_entity;
  for (const NamedGroup& named : named_groups(mesh.notes)) {
    const auto& with_section = named.dimension == 3   ? options.solid_groups
                               : named.dimension == 2 ? options.shell_groups
                                                      : options.line_groups;
    // Surfaces beside volumes are faces of these, and all surfaces are shells otherwise.
    const bool has_section = named.dimension > 0 && has_name(with_section, named.name);
    if (named.dimension == of_body || has_section)
      take_entities(mesh, named, with_section, group_of_entity);
    mesh.groups.push_back(nodes_of(named, index));
  }
  return group_of_entity;
}

ElementBlock& block_of(Mesh& mesh, const ElementType& type)
{
  const auto same = [&](const ElementBlock& b) {
    return b.shape == type.shape && b.order == type.order;
  };
  const auto it = std::ranges::find_if(mesh.blocks, same);
  if (it != mesh.blocks.end()) return *it;
  mesh.blocks.push_back(ElementBlock{.shape = type.shape,
                                     .order = type.order,
                                     .nodes_per_element = static_cast<int>(type.lattice.size()),
                                     .numbers = {},
                                     .nodes = {},
                                     .group = {}});
  return mesh.blocks.back();
}

/// @param entity  dimension and tag
void read_elements(Mesh& mesh, const NodeIndex& index, std::pair<int, int> entity, int group)
{
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> numbers;
  std::vector<std::vector<std::size_t>> nodes;
  gmsh::model::mesh::getElements(types, numbers, nodes, entity.first, entity.second);
  for (std::size_t t = 0; t < types.size(); ++t) {
    const ElementType type = element_type(types[t], numbers[t].front());
    ElementBlock& block = block_of(mesh, type);
    for (std::size_t e = 0; e < numbers[t].size(); ++e) {
      block.numbers.push_back(static_cast<std::int64_t>(numbers[t][e]));
      block.group.push_back(group);
      for (const int k : type.lattice)
        block.nodes.push_back(k < 0 ? -1 : index.at(nodes[t][e * type.n_nodes + k]));
    }
  }
}

[[noreturn]] void refuse_wrong_dimension()
{
  const std::size_t n_solids = n_elements(3);
  const std::size_t n_lines = n_elements(1);
  if (n_solids == 0 && n_lines == 0) throw Error("the mesh has no elements");
  throw Error(fmt::format(
      "the mesh has {} solid and {} line elements, but neither surface elements (triangles, quads) "
      "nor lines of the group of a beam section: give the group of the volume a section of type = "
      "\"solid\", or mesh the mid-surface in two dimensions, and save its elements (with physical "
      "groups Gmsh "
      "saves only elements that are in one)",
      n_solids, n_lines));
}

void note_what_is_left_out(Mesh& mesh, const MeshOptions& options)
{
  const std::size_t n_solids = n_elements(3);
  if (n_solids > 0 && !is_of_solids(options))
    mesh.notes.push_back(fmt::format("{} solid elements are left out", n_solids));
  const auto empty = [](const Group& group) { return group.nodes.empty(); };
  for (const Group& group : mesh.groups) {
    if (!empty(group)) continue;
    mesh.notes.push_back(
        fmt::format("group \"{}\" is left out: no element has a node of it", group.name));
  }
}

/// The file of Gmsh's library.
std::string path_of_gmsh()
{
  void* function = dlsym(RTLD_DEFAULT, "gmshInitialize");  // of its interface to C
  Dl_info home{};
  return function != nullptr && dladdr(function, &home) != 0 ? home.dli_fname : "";
}

/// Tetrahedra and wedges with four and six nodes are far too stiff.
void raise_linear_solids(Mesh& mesh)
{
  std::vector<int> types;
  gmsh::model::mesh::getElementTypes(types, 3);
  constexpr int tetrahedron = 4, wedge = 6;
  const bool is_linear =
      std::ranges::count(types, tetrahedron) + std::ranges::count(types, wedge) > 0;
  if (!is_linear) return;
  gmsh::model::mesh::setOrder(2);
  mesh.notes.emplace_back(solids_are_raised);
}

Mesh current_model(const MeshOptions& options)
{
  Mesh mesh;
  const bool of_solids = is_of_solids(options);
  if (of_solids) raise_linear_solids(mesh);
  const NodeIndex index = read_nodes(mesh);
  GroupOfEntity group_of_entity = read_groups(mesh, index, options);
  std::vector<std::pair<int, int>> others;
  gmsh::model::getEntities(others, of_solids ? 3 : 2);
  for (const auto& other : others) group_of_entity.emplace(other, -1);  // in no group
  for (const auto& [entity, group] : group_of_entity) read_elements(mesh, index, entity, group);
  if (!options.solid_groups.empty() && n_elements(3) == 0) {
    throw Error(fmt::format(
        "the mesh has no solid elements: give \"{}\" as a physical volume, and save its elements",
        options.solid_groups.front()));
  }
  if (mesh.blocks.empty()) refuse_wrong_dimension();
  merge_doubled_elements(mesh, options);
  add_inner_nodes(mesh);
  drop_unused_nodes(mesh, options.coupled_groups);
  note_what_is_left_out(mesh, options);
  return mesh;
}

/// Options of Gmsh with their values.
using Way = std::vector<std::pair<const char*, double>>;

/// What to try, one after the other, when elements lie on one another or are folded: other random
/// shifts of the points, other algorithms, triangles joined otherwise.
const std::vector<Way> other_ways{
    {{"Mesh.RandomSeed", 2.0}},
    {{"Mesh.RandomSeed", 3.0}},
    {{"Mesh.Algorithm", 5.0}},
    {{"Mesh.Algorithm", 5.0}, {"Mesh.RandomSeed", 2.0}},
    {{"Mesh.Algorithm", 1.0}},
    {{"Mesh.RecombinationAlgorithm", 0.0}},
    {{"Mesh.Algorithm", 5.0}, {"Mesh.RecombinationAlgorithm", 0.0}},
};

/// Meshes the open model in two dimensions.
Mesh generated_elements(int order, const MeshOptions& options)
{
  gmsh::model::mesh::generate(options.solid_groups.empty() ? 2 : 3);
  if (order > 1) gmsh::model::mesh::setOrder(order);
  return split_flat_corners(current_model(options));
}

/// The mesh by another way, with a note; absent if its elements are no better.
std::optional<Mesh> mended(const Way& way, int order, const MeshOptions& options)
{
  std::string words;
  for (const auto& [option, value] : way) {
    gmsh::option::setNumber(option, value);
    words += fmt::format("{}{} = {}", words.empty() ? "" : ", ", option, value);
  }
  try {
    gmsh::model::mesh::clear();
    Mesh mesh = generated_elements(order, options);
    if (!complaint_about(mesh).empty()) return std::nullopt;
    mesh.notes.push_back(fmt::format(
        "Gmsh's first elements lay on one another or were folded; with {} they do not", words));
    return mesh;
  } catch (const std::exception&) {  // this way leads to no mesh
    return std::nullopt;
  } catch (const std::string&) {
    return std::nullopt;
  }
}

/// Meshes the open model, anew if the elements cannot be used. If no way helps, these are returned.
Mesh best_elements(int order, const MeshOptions& options)
{
  Mesh first = generated_elements(order, options);
  if (complaint_about(first).empty()) return first;
  std::map<std::string, double> before;
  for (const Way& way : other_ways)
    for (const auto& [option, value] : way) gmsh::option::getNumber(option, before[option]);
  for (const Way& way : other_ways) {
    for (const auto& [option, value] : before) gmsh::option::setNumber(option, value);
    if (std::optional<Mesh> mesh = mended(way, order, options)) return *std::move(mesh);
  }
  return first;
}

}  // namespace

Mesh mesh_with_gmsh(const std::function<void()>& build, int order, const MeshOptions& options)
{
  const Session session;
  try {
    set_meshing_options();
    build();
    // Quadrilaterals around a volume of tetrahedra would need pyramids between them.
    if (!options.solid_groups.empty()) gmsh::option::setNumber("Mesh.RecombineAll", 0);
    const int dimension = options.solid_groups.empty() ? 2 : 3;
    Mesh mesh = order > 0 && n_elements(dimension) == 0
                    ? best_elements(order, options)
                    : split_flat_corners(current_model(options));
    mesh.made_by = path_of_gmsh();
    return mesh;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(fmt::format("Gmsh: {}", e.what()));
  } catch (const std::string& text) {  // the 4.8 API throws strings in places
    throw Error(fmt::format("Gmsh: {}", text));
  }
}

namespace {

constexpr double growth = 0.4;  ///< of the size with the distance

double distance(const std::array<double, 3>& x, const std::array<double, 3>& y)
{
  return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
}

}  // namespace

GradedSizes::GradedSizes(std::vector<SizeAt> places) : places_(std::move(places))
{
  std::ranges::sort(places_, {}, [](const SizeAt& place) { return place.x[0]; });
  smallest_ = std::ranges::min(places_, {}, &SizeAt::size).size;
}

double GradedSizes::at(const std::array<double, 3>& x) const
{
  double least = std::numeric_limits<double>::infinity();
  // From the nearest by the first coordinate to those that are too far even for the smallest size.
  const auto take = [&](const SizeAt& place) {
    if (smallest_ + growth * std::abs(place.x[0] - x[0]) >= least) return false;
    least = std::min(least, place.size + growth * distance(x, place.x));
    return true;
  };
  const auto first =
      std::ranges::lower_bound(places_, x[0], {}, [](const SizeAt& place) { return place.x[0]; });
  for (auto place = first; place != places_.end() && take(*place); ++place) {
  }
  for (auto place = first; place != places_.begin() && take(*std::prev(place)); --place) {
  }
  return least;
}

void set_local_sizes(const MeshOptions& options, double unit)
{
  if (options.sizes.empty()) return;
  double factor = 1.0;  // by which Gmsh multiplies what it is told
  gmsh::option::getNumber("Mesh.MeshSizeFactor", factor);
  const auto sizes = std::make_shared<const GradedSizes>(options.sizes);
  // Versions of Gmsh from 4.9 on tell the size that they would take themselves.
  gmsh::model::mesh::setSizeCallback([=](int, int, double x, double y, double z, auto... own) {
    const double said = sizes->at({unit * x, unit * y, unit * z}) / (unit * factor);
    return std::min({said, static_cast<double>(own)...});
  });
}

}  // namespace chladni::mesh
