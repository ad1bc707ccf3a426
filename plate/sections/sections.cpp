#include "plate/sections/sections.hpp"

#include <fmt/format.h>
#include <muParser.h>
#include <Eigen/Dense>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "common/decimal_comma.hpp"
#include "common/error.hpp"
#include "mesh/element_types.hpp"
#include "plate/elements/beam_element.hpp"
#include "plate/elements/shell_element.hpp"
#include "plate/elements/shell_strains.hpp"

namespace chladni::plate {

using Eigen::Index, Eigen::Matrix3d, Eigen::RowVector3d;

namespace {

enum class Kind { shell, beam, solid };

Kind kind_of(const mesh::ElementBlock& block)
{
  constexpr std::array kinds{Kind::beam, Kind::shell, Kind::solid};
  return kinds[std::size_t(mesh::dimension(block.shape) - 1)];
}

int index_of_section(const SectionMap& map, const mesh::ElementBlock& block, int element)
{
  const int group = block.group[element];
  if (group < 0) return -1;
  const Kind kind = kind_of(block);
  return kind == Kind::beam    ? map.beam[group]
         : kind == Kind::shell ? map.shell[group]
                               : map.solid[group];
}

/// A formula may be negative where a table cannot.
void check_thickness(const mesh::Mesh& mesh, const ShellSection& section)
{
  if (section.thickness.formula.empty()) return;
  for (const int node : mesh::find_group(mesh, section.group).nodes) {
    const double t = value_at(section.thickness, mesh.positions[node]);
    if (t > 0.0) continue;
    throw Error(fmt::format(
        "section of group \"{}\": the thickness \"{}\" is {:.6g} m at node {}; it must be > 0",
        section.group, section.thickness.formula, t, mesh.node_numbers[node]));
  }
}

/// An entry that is not a number would be found in a factor or a spectrum of all elements, if at
/// all.
void refuse_not_finite(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                       const ElementMatrices& matrices)
{
  const bool is_K = matrices.K.allFinite(), is_M = matrices.M.allFinite();
  if (is_K && is_M) return;
  const std::string group = mesh.groups[std::size_t(block.group[element])].name;
  const char* which = is_K ? "mass" : is_M ? "stiffness" : "stiffness and mass";
  const char* why =
      kind_of(block) != Kind::shell
          ? "look at its size, section and material"
          : "the two faces of the shell cross in it, because it is curved more sharply than half "
            "its "
            "thickness, or its values overflow; make the section thinner, round the corner more "
            "widely, or model it by a fold between flat parts";
  throw Error(fmt::format("element {} of group \"{}\": its {} is not a number: {}",
                          block.numbers[element], group, which, why));
}

template <class Section>
double loss_factor_of(const Section& section)
{
  return section.loss_factor.value_or(section.material.loss_factor);
}

}  // namespace

std::vector<char> nodes_on_surfaces(const mesh::Mesh& mesh)
{
  std::vector<char> on_surface(mesh.positions.size(), 0);
  for (const mesh::ElementBlock& block : mesh.blocks)
    if (mesh::is_surface(block.shape))
      for (const int node : block.nodes) on_surface[static_cast<std::size_t>(node)] = 1;
  return on_surface;
}

LineFields line_fields(const std::vector<char>& on_surface, std::span<const int> nodes)
{
  const auto is_on_surface = [&](int node) {
    return on_surface[static_cast<std::size_t>(node)] != 0;
  };
  const bool is_rib =
      nodes.size() > 2 && std::ranges::any_of(nodes.subspan(1, nodes.size() - 2), is_on_surface);
  return is_rib ? LineFields::isoparametric : LineFields::best;
}

SectionMap map_sections(const mesh::Mesh& mesh, const Structure& structure)
{
  const SectionMap map{.shell = section_of_group(mesh, structure.shells),
                       .beam = section_of_group(mesh, structure.beams),
                       .solid = section_of_group(mesh, structure.solids),
                       .on_surface = nodes_on_surfaces(mesh)};
  for (const ShellSection& section : structure.shells) check_thickness(mesh, section);
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (kind_of(block) == Kind::shell) check_element_exists(block.shape, block.order);
    if (kind_of(block) == Kind::solid) check_solid_exists(block.shape, block.order);
    for (int e = 0; e < block.n_elements(); ++e) {
      const int section = index_of_section(map, block, e);
      if (section < 0) {
        const int group = block.group[std::size_t(e)];
        throw Error(fmt::format("element {} has no section: {} in a [[section]]", block.numbers[e],
                                group < 0 ? "it is in no group; put it into one and name this"
                                          : fmt::format("name its group \"{}\"",
                                                        mesh.groups[std::size_t(group)].name)));
      }
      if (kind_of(block) == Kind::beam)
        node_axes(element_positions(mesh, block, e), structure.beams[section]);
    }
  }
  return map;
}

PlacedMatrices element_matrices(const mesh::Mesh& mesh, const mesh::ElementBlock& block,
                                int element, const ElementContext& context)
{
  const int index = index_of_section(context.sections, block, element);
  const NodeVectors x = element_positions(mesh, block, element);
  if (kind_of(block) == Kind::beam) {
    const LineFields fields =
        line_fields(context.sections.on_surface, block.element_nodes(element));
    PlacedMatrices line{.matrices = beam_matrices(x, context.structure.beams[index], fields),
                        .arms = {}};
    refuse_not_finite(mesh, block, element, line.matrices);
    return line;
  }
  if (kind_of(block) == Kind::solid) {
    PlacedMatrices solid{.matrices = solid_matrices(solid_of_mesh(mesh, block, element),
                                                    context.structure.solids[index].material),
                         .arms = {}};
    refuse_not_finite(mesh, block, element, solid.matrices);
    return solid;
  }
  const ShellSection& section = context.structure.shells[index];
  const ShellNodes shell = shell_nodes(mesh, block, element, context.directors, section);
  PlacedMatrices placed{
      .matrices = shell_matrices(block.shape, block.order, shell, section.material), .arms = {}};
  refuse_not_finite(mesh, block, element, placed.matrices);
  if (section.offset != Profile(0.0)) placed.arms = shell.x - x;
  return placed;
}

double loss_factor(const mesh::ElementBlock& block, int element, const ElementContext& context)
{
  const int index = index_of_section(context.sections, block, element);
  const Kind kind = kind_of(block);
  return kind == Kind::beam    ? loss_factor_of(context.structure.beams[index])
         : kind == Kind::shell ? loss_factor_of(context.structure.shells[index])
                               : loss_factor_of(context.structure.solids[index]);
}

bool has_loss_factors(const Structure& structure)
{
  const auto is_lossy = [](const auto& section) { return loss_factor_of(section) > 0.0; };
  return std::ranges::any_of(structure.shells, is_lossy) ||
         std::ranges::any_of(structure.beams, is_lossy) ||
         std::ranges::any_of(structure.solids, is_lossy) ||
         std::ranges::any_of(structure.springs,
                             [](const Spring& spring) { return spring.loss_factor > 0.0; });
}

namespace {

template <typename Section, typename IsOfKind>
std::vector<int> find_sections(const mesh::Mesh& mesh, std::span<const Section> sections,
                               const IsOfKind& is_of_kind, const char* kind)
{
  std::vector<int> section(mesh.groups.size(), -1);
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const mesh::Group& group = mesh::find_group(mesh, sections[s].group);
    const auto index = static_cast<std::size_t>(&group - mesh.groups.data());
    const auto in_group = [&](const mesh::ElementBlock& block) {
      return is_of_kind(block.shape) &&
             std::ranges::count(block.group, static_cast<int>(index)) > 0;
    };
    if (std::ranges::none_of(mesh.blocks, in_group)) {
      throw Error(
          fmt::format("section of group \"{}\": the group has no {} elements", group.name, kind));
    }
    section[index] = static_cast<int>(s);
  }
  return section;
}

}  // namespace

std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const ShellSection> sections)
{
  return find_sections(mesh, sections, mesh::is_surface, "shell");
}

std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const BeamSection> sections)
{
  const auto is_line = [](mesh::Shape shape) { return shape == mesh::Shape::line; };
  return find_sections(mesh, sections, is_line, "line");
}

std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const SolidSection> sections)
{
  return find_sections(mesh, sections, mesh::is_solid, "solid");
}

namespace {

/// A surface element at one of its edges.
struct EdgeSide {
  const ShellSection* section;
  Eigen::Vector3d inward, normal;  ///< unit vectors
};

/// An edge with the elements that share it.
struct SharedEdge {
  Eigen::Vector3d from, to;
  std::vector<EdgeSide> sides;

  double value(const Profile& profile) const
  {
    const Eigen::Vector3d middle = 0.5 * (from + to);
    return value_at(profile, {middle[0], middle[1], middle[2]});
  }
};

/// What the ribs on an edge hold twice, kg.
double overlap_at(const SharedEdge& edge)
{
  const double goes_on = -std::cos(std::numbers::pi / 4.5);  // a fold of 40 degrees, as in a sheet
  constexpr double least_sine = 0.3;                         // a flatter one is no rib
  double least = goes_on, overlap = 0.0;
  std::pair<std::size_t, std::size_t> plate{0, 0};
  for (std::size_t i = 0; i < edge.sides.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double cosine = edge.sides[i].inward.dot(edge.sides[j].inward);
      if (!(cosine < least)) continue;
      least = cosine;
      plate = {i, j};
    }
  if (plate.first == plate.second) return 0.0;
  const EdgeSide& of_plate = edge.sides[plate.first];
  const double t = edge.value(of_plate.section->thickness);
  for (std::size_t k = 0; k < edge.sides.size(); ++k) {
    const EdgeSide& rib = edge.sides[k];
    const double sine = of_plate.normal.dot(rib.inward);
    if (k == plate.first || k == plate.second || std::abs(sine) < least_sine) continue;
    // From the edge to the face of the plate on the rib's side.
    const double offset = edge.value(of_plate.section->offset) * (sine > 0.0 ? 1.0 : -1.0);
    const double depth = std::clamp(0.5 * t + offset, 0.0, t) / std::abs(sine);
    overlap += (edge.to - edge.from).norm() * depth * edge.value(rib.section->thickness) *
               rib.section->material.density;
  }
  return overlap;
}

}  // namespace

RibOverlap rib_overlap(const mesh::Mesh& mesh, std::span<const ShellSection> sections)
{
  const std::vector<int> section_of = section_of_group(mesh, sections);
  std::map<std::pair<int, int>, SharedEdge> edges;
  RibOverlap found{0.0, 0.0};
  const auto at = [&](int node) { return Eigen::Vector3d(mesh.positions[node].data()); };
  for (const mesh::ElementBlock& block : mesh.blocks)
    for (int e = 0; mesh::is_surface(block.shape) && e < block.n_elements(); ++e) {
      const int group = block.group[e], index = group < 0 ? -1 : section_of[group];
      if (index < 0) continue;
      const ShellSection& section = sections[index];
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      const std::vector<int> corners = mesh::corner_places(block);
      for (const int place : corners)
        centre += at(block.element_nodes(e)[place]) / double(corners.size());
      const auto corner = [&](std::size_t i) { return at(block.element_nodes(e)[corners[i]]); };
      const Eigen::Vector3d normal =
          (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
      double area = 0.0;
      for (const std::vector<int>& nodes : mesh::edges_of(block, e)) {
        const Eigen::Vector3d from = at(nodes.front()), to = at(nodes.back()),
                              along = (to - from).normalized(), away = centre - from;
        area += 0.5 * (to - from).cross(away).norm();
        SharedEdge& edge = edges[std::minmax(nodes.front(), nodes.back())];
        edge.from = from;
        edge.to = to;
        const Eigen::Vector3d inward = (away - along * along.dot(away)).normalized();
        edge.sides.push_back({&section, inward, normal});
      }
      const double t = value_at(section.thickness, {centre[0], centre[1], centre[2]});
      found.mass += section.material.density * area * t;
    }
  for (const auto& [nodes, edge] : edges)
    if (edge.sides.size() > 2) found.twice += overlap_at(edge);
  return found;
}

SolidFrame solid_of_mesh(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element)
{
  SolidFrame frame = solid_frame(block.shape, block.order, element_positions(mesh, block, element));
  if (frame.dV.minCoeff() > 0.0) return frame;
  throw Error(
      fmt::format("element {} is degenerate or turned inside out (its Jacobian is not positive at "
                  "an integration point); repair the mesh there, or mesh it with straight edges or "
                  "smaller elements",
                  block.numbers[element]));
}

namespace {

/// A formula of x, y, z, radius (from the z axis) and angle (about it, rad), read once.
class Formula {
 public:
  explicit Formula(const std::string& text) : text_(text)
  {
    if (const std::string wrong = decimal_comma_in(text); !wrong.empty())
      throw Error(fmt::format("formula \"{}\": {}", text, wrong));
    try {
      parser_.DefineVar("x", &x_);
      parser_.DefineVar("y", &y_);
      parser_.DefineVar("z", &z_);
      parser_.DefineVar("radius", &radius_);
      parser_.DefineVar("angle", &angle_);
      parser_.SetExpr(text);
      parser_.Eval();
    } catch (const mu::Parser::exception_type& e) {
      throw Error(fmt::format(
          "formula \"{}\": {}; it may use x, y, z and radius (m), angle (rad), numbers, + - * / ^ "
          "and functions such as sin, cos, sqrt, min, max",
          text, e.GetMsg()));
    }
  }
  Formula(const Formula&) = delete;  // the parser points at the variables
  Formula& operator=(const Formula&) = delete;

  double at(const std::array<double, 3>& position)
  {
    std::tie(x_, y_, z_) = std::tie(position[0], position[1], position[2]);
    radius_ = std::hypot(x_, y_);
    angle_ = std::atan2(y_, x_);
    const double value = parser_.Eval();
    if (std::isfinite(value)) return value;
    throw Error(fmt::format("formula \"{}\" is {} at ({:.6g}, {:.6g}, {:.6g}) m", text_, value, x_,
                            y_, z_));
  }

 private:
  std::string text_;
  mu::Parser parser_;
  double x_ = 0.0, y_ = 0.0, z_ = 0.0, radius_ = 0.0, angle_ = 0.0;
};

std::array<double, 3> turned_about_z(const std::array<double, 3>& x, double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
}

Formula& formula(const std::string& text)
{
  static std::map<std::string, std::unique_ptr<Formula>> known;
  std::unique_ptr<Formula>& found = known[text];
  if (!found) found = std::make_unique<Formula>(text);
  return *found;
}

}  // namespace

double value_at(const Profile& profile, const std::array<double, 3>& place)
{
  const std::array<double, 3> position =
      profile.turned == 0.0 ? place : turned_about_z(place, profile.turned);
  if (!profile.formula.empty()) return formula(profile.formula).at(position);
  if (profile.at.empty()) return profile.values.front();
  const double s = profile.over == Coordinate::radius
                       ? std::hypot(position[0], position[1])
                       : position[static_cast<std::size_t>(profile.over)];
  const auto above = std::ranges::upper_bound(profile.at, s) - profile.at.begin();
  if (above == 0) return profile.values.front();
  if (above == std::ssize(profile.at)) return profile.values.back();
  const auto i = static_cast<std::size_t>(above);
  const double share = (s - profile.at[i - 1]) / (profile.at[i] - profile.at[i - 1]);
  return std::lerp(profile.values[i - 1], profile.values[i], share);
}

namespace {

// A fold of exactly 40 degrees, as in a prism of nine sides, is smooth in spite of round-off.
constexpr double degree = std::numbers::pi / 180.0;
constexpr double smooth_fold = (40.0 + 1e-6) * degree;
const double smooth_cosine = std::cos(0.5 * smooth_fold);

/// The slopes of the shape functions at the nodes, computed once for a type of element.
const mesh::ShapeDerivatives& nodal_derivatives(const mesh::ElementBlock& block)
{
  static std::map<std::pair<mesh::Shape, int>, mesh::ShapeDerivatives> cache;
  const std::pair key{block.shape, block.order};
  const auto it = cache.find(key);
  return it != cache.end()
             ? it->second
             : cache.emplace(key, mesh::node_derivatives(block.shape, block.order)).first->second;
}

/// Unit normals at the nodes of one element.
NodeVectors element_normals(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element)
{
  const mesh::ShapeDerivatives& derivatives = nodal_derivatives(block);
  NodeVectors normals(block.nodes_per_element, 3);
  for (int k = 0; k < block.nodes_per_element; ++k) {
    const auto [a_1, a_2] = mesh::tangents(mesh, block.element_nodes(element), derivatives, k);
    normals.row(k) = RowVector3d(mesh::cross(a_1, a_2).data()).normalized();
  }
  return normals;
}

/// A normal that vanishes or turns over inside an element is the end of any result.
void check_normals(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                   const NodeVectors& normals)
{
  for (Index i = 0; i < normals.rows(); ++i) {
    if (normals.row(i).dot(normals.row(0)) > 0.0) continue;
    throw Error(fmt::format(
        "element {} is degenerate or folded over at its node {} (its Jacobian is not positive); "
        "repair or refine the mesh there",
        block.numbers[element], mesh.node_numbers[block.element_nodes(element)[i]]));
  }
}

/// The cut edges of a sector are one: its nodes stand for both, seen from the low edge.
struct CutEdges {
  std::unordered_map<int, int> low_of;   ///< of the nodes of the high edge
  Matrix3d turn = Matrix3d::Identity();  ///< row vectors from low to high

  explicit CutEdges(const mesh::Sectors& sectors)
  {
    const double angle = 2.0 * std::numbers::pi / sectors.count;
    turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).matrix().transpose();
    for (const auto& [low, high] : sectors.pairs) low_of.emplace(high, low);
  }
  /// The node that stands for this one.
  int place(int node) const
  {
    const auto found = low_of.find(node);
    return found == low_of.end() ? node : found->second;
  }
  /// The name of a neighbour of a node: along the cut the same from both sides. Beside it, the high
  /// edge has neighbours in another sector than the low one.
  int neighbour(int node, int next) const
  {
    if (!low_of.contains(node)) return next;
    return low_of.contains(next) ? place(next) : -2 - next;
  }
  RowVector3d from_place(int node, const RowVector3d& v) const
  {
    return low_of.contains(node) ? RowVector3d(v * turn) : v;
  }
  RowVector3d to_place(int node, const RowVector3d& v) const
  {
    return low_of.contains(node) ? RowVector3d(v * turn.transpose()) : v;
  }
};

/// Both nodes of a pair on the cut edges of a sector, where one is wanted.
NodeMask with_partners(const mesh::Mesh& mesh, NodeMask wanted)
{
  if (wanted.empty()) return NodeMask(std::size_t(mesh.n_nodes()), 1);
  for (const auto& [low, high] : mesh.sectors.pairs)
    if (wanted[low] != 0 || wanted[high] != 0) wanted[low] = wanted[high] = 1;
  return wanted;
}

/// Calls visit(block, element) for the surface elements with a node that is wanted.
template <typename Visit>
void for_elements(const mesh::Mesh& mesh, const NodeMask& wanted, const Visit& visit)
{
  for (const mesh::ElementBlock& block : mesh.blocks) {
    if (!mesh::is_surface(block.shape)) continue;
    for (int e = 0; e < block.n_elements(); ++e) {
      const auto is_wanted = [&](int node) { return wanted[std::size_t(node)] != 0; };
      if (std::ranges::any_of(block.element_nodes(e), is_wanted)) visit(block, e);
    }
  }
}

/// An element at one of its nodes, seen from the low cut edge.
struct Face {
  int place;  ///< the node, or that which stands for it
  int node;
  std::size_t block, slot;  ///< nodes_per_element * element + place in the element
  mesh::FaceAtNode at;
};

RowVector3d row(const mesh::Vector& v)
{
  return {v[0], v[1], v[2]};
}

mesh::Vector vector(const RowVector3d& v)
{
  return {v[0], v[1], v[2]};
}

Face seen_from_low(Face face, const CutEdges& cut)
{
  const auto turn = [&](mesh::Vector& v) { v = vector(cut.to_place(face.node, row(v))); };
  turn(face.at.normal);
  for (mesh::EdgeAtNode& edge : face.at.edges) {
    turn(edge.along);
    turn(edge.inward);
    edge.next = cut.neighbour(face.node, edge.next);
    if (edge.other < 0) continue;  // at an end of the edge
    edge.other = cut.neighbour(face.node, edge.other);
    if (edge.next < edge.other) continue;
    std::swap(edge.next, edge.other);
    edge.along = vector(-row(edge.along));
  }
  return face;
}

/// Two faces that share an edge at a node.
struct Fold {
  std::size_t a, b;
  int edge;      ///< its neighbour
  double angle;  ///< rad, between one face and the continuation of the other
  double side;   ///< -1: they are oriented to opposite sides
};

/// Positive if the edge goes around the element as its normal tells.
double handedness(const mesh::EdgeAtNode& edge, const Face& face)
{
  return mesh::dot(mesh::cross(edge.along, edge.inward), face.at.normal);
}

std::vector<Fold> folds_between(std::span<const Face> faces)
{
  std::vector<Fold> folds;
  for (std::size_t b = 0; b < faces.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      for (const mesh::EdgeAtNode& of_a : faces[a].at.edges) {
        for (const mesh::EdgeAtNode& of_b : faces[b].at.edges) {
          if (of_a.next != of_b.next || of_a.other != of_b.other) continue;
          const double side = handedness(of_a, faces[a]) * handedness(of_b, faces[b]);
          folds.push_back({.a = a,
                           .b = b,
                           .edge = of_a.next,
                           .angle = mesh::fold_angle(of_a.inward, of_b.inward),
                           .side = side < 0.0 ? 1.0 : -1.0});
        }
      }
    }
  }
  return folds;
}

/// True if `other` is the same fold but for a face that lies on one of its faces.
bool is_double_of(const Fold& other, const Fold& fold, std::span<const Fold> folds)
{
  constexpr double flat = 179.0 * degree;
  const bool has_a = other.a == fold.a || other.b == fold.a;
  const std::size_t common = has_a ? fold.a : fold.b, replaced = has_a ? fold.b : fold.a;
  const std::size_t by = other.a == common ? other.b : other.a;
  return std::ranges::any_of(folds, [&](const Fold& between) {
    return between.a == std::min(replaced, by) && between.b == std::max(replaced, by) &&
           between.angle > flat;
  });
}

/// True if the surface goes on over this fold.
bool is_smooth(const Fold& fold, std::span<const Fold> folds)
{
  if (fold.angle > smooth_fold) return false;
  return std::ranges::all_of(folds, [&](const Fold& other) {
    const bool is_rival =
        &other != &fold && other.edge == fold.edge &&
        (other.a == fold.a || other.b == fold.a || other.a == fold.b || other.b == fold.b);
    return !is_rival || fold.angle <= 0.5 * other.angle || is_double_of(other, fold, folds);
  });
}

/// The sheet of each face, and its side of it.
struct Sheets {
  std::vector<int> of_face;
  std::vector<double> side;
  int n = 0;
};

Sheets sheets_of(std::span<const Face> faces)
{
  const std::vector<Fold> folds = folds_between(faces);
  std::vector<Fold> smooth;
  std::ranges::copy_if(folds, std::back_inserter(smooth),
                       [&](const Fold& fold) { return is_smooth(fold, folds); });
  Sheets sheets{.of_face = std::vector<int>(faces.size(), -1),
                .side = std::vector<double>(faces.size(), 1.0)};
  for (std::size_t first = 0; first < faces.size(); ++first) {
    if (sheets.of_face[first] >= 0) continue;
    std::vector<std::size_t> reached{first};
    sheets.of_face[first] = sheets.n;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      for (const Fold& fold : smooth) {
        if (fold.a != reached[i] && fold.b != reached[i]) continue;
        const std::size_t other = fold.a == reached[i] ? fold.b : fold.a;
        if (sheets.of_face[other] >= 0) continue;
        sheets.of_face[other] = sheets.n;
        sheets.side[other] = sheets.side[reached[i]] * fold.side;
        reached.push_back(other);
      }
    }
    ++sheets.n;
  }
  return sheets;
}

/// Writes the directors of the faces at one node.
void add_directors(std::span<const Face> faces, const CutEdges& cut, Directors& directors)
{
  const Sheets sheets = sheets_of(faces);
  NodeVectors mean = NodeVectors::Zero(sheets.n, 3);
  for (std::size_t i = 0; i < faces.size(); ++i)
    mean.row(sheets.of_face[i]) += sheets.side[i] * faces[i].at.angle * row(faces[i].at.normal);
  mean.rowwise().normalize();
  std::vector<RowVector3d> of_face(faces.size());
  bool is_common = sheets.n == 1;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    of_face[i] = sheets.side[i] * mean.row(sheets.of_face[i]);
    const RowVector3d normal = row(faces[i].at.normal);
    if (of_face[i].dot(normal) > smooth_cosine) continue;
    of_face[i] = normal;
    is_common = false;
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const RowVector3d here =
        cut.from_place(faces[i].node, is_common ? RowVector3d(mean.row(0)) : of_face[i]);
    if (is_common)
      directors.common.row(faces[i].node) = here;
    else
      directors.own[faces[i].block].emplace(faces[i].slot, here);
  }
}

/// Nodes whose elements have normals that are not parallel. The normal of the first element of each
/// node becomes the common director.
NodeMask find_folds(const mesh::Mesh& mesh, const NodeMask& wanted, const CutEdges& cut,
                    Directors& directors)
{
  constexpr double round_off = 1e-14;
  NodeMask is_fold(std::size_t(mesh.n_nodes()), 0);
  for_elements(mesh, wanted, [&](const mesh::ElementBlock& block, int e) {
    const NodeVectors normals = element_normals(mesh, block, e);
    check_normals(mesh, block, e, normals);
    const std::span<const int> nodes = block.element_nodes(e);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const int node = nodes[k], place = cut.place(node);
      if (wanted[node] == 0) continue;
      const RowVector3d normal = cut.to_place(node, normals.row(Index(k)));
      auto first = directors.common.row(place);
      if (first.isZero(0.0)) first = normal;
      if (!(first.cross(normal).squaredNorm() <= round_off * round_off)) is_fold[place] = 1;
    }
  });
  for (const auto& [low, high] : mesh.sectors.pairs) {
    is_fold[high] = is_fold[low];
    directors.common.row(high) = cut.from_place(high, directors.common.row(low));
  }
  return is_fold;
}

}  // namespace

NodeVectors element_positions(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element)
{
  NodeVectors x(block.nodes_per_element, 3);
  for (Index i = 0; i < x.rows(); ++i) {
    const auto& p = mesh.positions[block.element_nodes(element)[i]];
    x.row(i) << p[0], p[1], p[2];
  }
  return x;
}

Directors shell_directors(const mesh::Mesh& mesh, NodeMask wanted)
{
  wanted = with_partners(mesh, std::move(wanted));
  const CutEdges cut(mesh.sectors);
  Directors directors{.common = NodeVectors::Zero(mesh.n_nodes(), 3), .own = {}};
  directors.own.resize(mesh.blocks.size());
  const NodeMask is_fold = find_folds(mesh, wanted, cut, directors);
  std::vector<Face> faces;
  for_elements(mesh, is_fold, [&](const mesh::ElementBlock& block, int e) {
    const std::span<const int> nodes = block.element_nodes(e);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (is_fold[nodes[k]] == 0) continue;
      directors.common.row(nodes[k]).setZero();
      faces.push_back(seen_from_low(
          {.place = cut.place(nodes[k]),
           .node = nodes[k],
           .block = std::size_t(&block - mesh.blocks.data()),
           .slot = std::size_t(e) * nodes.size() + k,
           .at = mesh::face_at_node(mesh, block, e, int(k), nodal_derivatives(block))},
          cut));
    }
  });
  std::ranges::stable_sort(faces, {}, &Face::place);
  for (std::size_t first = 0; first < faces.size();) {
    std::size_t last = first;
    while (last < faces.size() && faces[last].place == faces[first].place) ++last;
    add_directors(std::span(faces).subspan(first, last - first), cut, directors);
    first = last;
  }
  return directors;
}

namespace {

/// Of an element at all its nodes, to the side to which it is oriented.
NodeVectors unit_directors(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                           const Directors& directors, const NodeVectors& normals)
{
  NodeVectors d = normals;
  const auto& own = directors.own[std::size_t(&block - mesh.blocks.data())];
  for (Index i = 0; i < d.rows(); ++i) {
    const RowVector3d common = directors.common.row(block.element_nodes(element)[i]);
    const double cosine = common.dot(normals.row(i));
    if (cosine != 0.0) {
      d.row(i) = cosine < 0.0 ? RowVector3d(-common) : common;
      continue;
    }
    const auto found = own.find(std::size_t(element) * std::size_t(d.rows()) + std::size_t(i));
    if (found != own.end()) d.row(i) = found->second;
  }
  return d;
}

/// Thickness and offset along unit directors.
ShellNodes with_thickness(const mesh::Mesh& mesh, std::span<const int> nodes, NodeVectors d,
                          const ShellSection& section)
{
  ShellNodes shell{.x = NodeVectors(d.rows(), 3), .D = std::move(d), .surface = {}};
  for (Index i = 0; i < shell.D.rows(); ++i) {
    const auto& x = mesh.positions[nodes[i]];
    shell.x.row(i) = RowVector3d(x.data()) + value_at(section.offset, x) * shell.D.row(i);
    shell.D.row(i) *= 0.5 * value_at(section.thickness, x);
  }
  return shell;
}

/// The faces of the element cross, or nearly so, at an integration point.
bool faces_cross(const mesh::ElementBlock& block, const ShellNodes& nodes)
{
  constexpr double little = 0.1;
  const ShellFrame frame = shell_frame(rules_of(block.shape, block.order).full.basis, nodes);
  for (Index q = 0; q < frame.d.rows(); ++q) {
    const RowVector3d area = frame.a_1.row(q).cross(frame.a_2.row(q));
    const double middle = area.dot(frame.d.row(q));
    for (const double zeta : thickness_points)
      if (!(volume_element(frame, q, zeta) > little * middle)) return true;
  }
  return false;
}

}  // namespace

ShellNodes shell_nodes(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                       const Directors& directors, const ShellSection& section)
{
  const std::span<const int> nodes = block.element_nodes(element);
  const NodeVectors normals = element_normals(mesh, block, element);
  const NodeVectors d = unit_directors(mesh, block, element, directors, normals);
  const bool is_offset = section.offset != Profile(0.0);
  ShellNodes shell = with_thickness(mesh, nodes, d, section);
  if (!(d - normals).isZero(1e-6) && faces_cross(block, shell))
    shell = with_thickness(mesh, nodes, normals, section);
  if (is_offset) shell.surface = element_positions(mesh, block, element);
  return shell;
}

}  // namespace chladni::plate
