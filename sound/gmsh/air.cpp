#include "sound/gmsh/air.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "common/error.hpp"

namespace chladni::sound {
namespace {

namespace occ = gmsh::model::occ;
using Eigen::Vector2d;
using Shapes = gmsh::vectorpair;  ///< dimension and tag of each

/// Gmsh is a process-wide singleton: one session at a time, closed also when an error leaves it.
class Session {
 public:
  Session()
  {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::option::setNumber("Mesh.Algorithm", 6);
    gmsh::option::setNumber("Mesh.ElementOrder", 1);
    gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
    gmsh::option::setNumber("Mesh.MeshSizeFromPoints", 0);
    gmsh::model::add("air");
  }
  ~Session() { gmsh::finalize(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

/// The meridian plane lies in Gmsh's xy plane for triangles and in its xz plane for solids.
enum class Plane { xy, xz };

Shapes quadrilateral(const Quadrilateral& q, Plane plane)
{
  std::vector<int> points, lines;
  for (const Vector2d& x : q) {
    points.push_back(plane == Plane::xy ? occ::addPoint(x[0], x[1], 0.0)
                                        : occ::addPoint(x[0], 0.0, x[1]));
  }
  for (std::size_t i = 0; i < 4; ++i) lines.push_back(occ::addLine(points[i], points[(i + 1) % 4]));
  return {{2, occ::addPlaneSurface({occ::addCurveLoop(lines)})}};
}

Shapes cut(const Shapes& of, const Shapes& what, bool keep_tool)
{
  Shapes rest;
  std::vector<Shapes> map;
  if (what.empty()) return of;
  occ::cut(of, what, rest, map, -1, true, !keep_tool);
  return rest;
}

Shapes common(const Shapes& a, const Shapes& b)
{
  Shapes rest;
  std::vector<Shapes> map;
  occ::intersect(a, b, rest, map);
  return rest;
}

Shapes solid_of_revolution(const Quadrilateral& q)
{
  Shapes swept, solid;
  occ::revolve(quadrilateral(q, Plane::xz), 0, 0, 0, 0, 0, 1, 2.0 * std::numbers::pi, swept);
  std::ranges::copy_if(swept, std::back_inserter(solid), [](auto& s) { return s.first == 3; });
  return solid;
}

void append(Shapes& to, const Shapes& more)
{
  to.insert(to.end(), more.begin(), more.end());
}

Shapes body_in_plane(const Outline& outline)
{
  Shapes body;
  for (const Quadrilateral& q : outline.quadrilaterals) append(body, quadrilateral(q, Plane::xy));
  for (const Ball& b : outline.balls)
    append(body, {{2, occ::addDisk(0.0, b.z, 0.0, b.radius, b.radius)}});
  return body;
}

Shapes body_in_space(const Outline& outline, double size)
{
  Shapes body, holes;
  for (const Quadrilateral& q : outline.quadrilaterals) append(body, solid_of_revolution(q));
  for (const Ball& b : outline.balls) append(body, {{3, occ::addSphere(0.0, 0.0, b.z, b.radius)}});
  for (const Holes& h : outline.holes) {
    for (int i = 0; i < h.count; ++i) {
      const double angle = h.angle + 2.0 * std::numbers::pi * i / h.count;
      append(holes, {{3, occ::addCylinder(h.circle_radius * std::cos(angle),
                                          h.circle_radius * std::sin(angle), -size, 0.0, 0.0,
                                          2.0 * size, h.radius)}});
    }
  }
  return cut(body, holes, false);
}

/// A thin disc in the plane z = 0, whose edge the elements have to meet.
Shapes sheet(const Outline& outline, int dimension)
{
  const double a = outline.sheet_radius;
  if (a == 0.0) return {};
  if (dimension == 3) return {{2, occ::addDisk(0.0, 0.0, 0.0, a, a)}};
  return {{1, occ::addLine(occ::addPoint(0.0, 0.0, 0.0), occ::addPoint(a, 0.0, 0.0))}};
}

/// Where the air is: the inner part and the absorbing shell, less the body, on common boundaries.
void build(const Shapes& body, const Shapes& sheet, const std::function<Shapes(double)>& ball,
           const AirMeshOptions& options)
{
  const double R = options.inner_radius;
  const Shapes air = cut(ball(R), body, false);
  Shapes shell = cut(ball(R + options.shell_thickness), ball(R), false);
  append(shell, sheet);
  Shapes all;
  std::vector<Shapes> map;
  occ::fragment(air, shell, all, map);
  occ::synchronize();
}

/// Distance of a point of the meridian plane to the nearest corner of the outline.
double distance_to_edges(const Outline& outline, const Vector2d& x, double inside)
{
  double distance = inside;
  if (outline.sheet_radius > 0.0)
    distance = std::min(distance, (x - Vector2d(outline.sheet_radius, 0.0)).norm());
  for (const Quadrilateral& q : outline.quadrilaterals)
    for (const Vector2d& corner : q)
      if (corner[0] > 0.0) distance = std::min(distance, (x - corner).norm());
  return distance;
}

double distance_to_holes(const Outline& outline, double x, double y, double far)
{
  for (const Holes& h : outline.holes) {
    for (int i = 0; i < h.count; ++i) {
      const double angle = h.angle + 2.0 * std::numbers::pi * i / h.count;
      const double d =
          std::hypot(x - h.circle_radius * std::cos(angle), y - h.circle_radius * std::sin(angle));
      far = std::min(far, std::abs(d - h.radius));
    }
  }
  return far;
}

double size_at(const Outline& outline, const AirMeshOptions& options, const Eigen::Vector3d& x)
{
  const double far = options.inner_radius + options.shell_thickness;
  const double d = distance_to_holes(outline, x[0], x[1], far);
  const double edge = distance_to_edges(outline, {std::hypot(x[0], x[1]), x[2]}, std::min(d, far));
  return std::min(options.element_size, options.edge_size + options.growth * edge);
}

/// The elements of the highest dimension.
AirOfGmsh read_mesh(int dimension)
{
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> numbers, nodes;
  gmsh::model::mesh::getElements(types, numbers, nodes, dimension);
  if (types.size() != 1) throw Error("sound: Gmsh made no mesh, or one of mixed elements");
  AirOfGmsh air{};
  std::string name;
  int element_dimension = 0, n_primary = 0;
  gmsh::model::mesh::getElementProperties(types[0], name, element_dimension, air.order,
                                          air.nodes_per_element, air.reference, n_primary);
  std::vector<std::size_t> tags;
  std::vector<double> x, parameters;
  gmsh::model::mesh::getNodes(tags, x, parameters);
  std::unordered_map<std::size_t, std::size_t> place;
  for (std::size_t i = 0; i < tags.size(); ++i) place[tags[i]] = i;
  std::unordered_map<std::size_t, int> index;  // only nodes that an element uses
  for (const std::size_t tag : nodes[0]) {
    const auto [it, is_new] = index.emplace(tag, static_cast<int>(index.size()));
    air.elements.push_back(it->second);
    if (!is_new) continue;
    const double* position = &x[3 * place.at(tag)];
    air.positions.insert(air.positions.end(), position, position + dimension);
  }
  return air;
}

void build_plane(const AirQuestion& air, double size, double low)
{
  build(
      body_in_plane(air.outline), sheet(air.outline, 2),
      [&](double R) {
        return common({{2, occ::addDisk(0.0, air.centre, 0.0, R, R)}},
                      {{2, occ::addRectangle(0.0, low, 0.0, size, size - low)}});
      },
      air.options);
}

void build_space(const AirQuestion& air, double size, double low)
{
  build(
      body_in_space(air.outline, size), sheet(air.outline, 3),
      [&](double R) {
        return common({{3, occ::addSphere(0.0, 0.0, air.centre, R)}},
                      {{3, occ::addBox(-size, -size, low, 2 * size, 2 * size, size - low)}});
      },
      air.options);
}

}  // namespace

AirOfGmsh air_by_gmsh(const AirQuestion& question)
{
  const auto& [outline, options, dimension, centre] = question;
  try {
    const Session session;
    const double size = 4.0 * (options.inner_radius + options.shell_thickness);
    const double low = options.half_space ? 0.0 : -size;
    dimension == 2 ? build_plane(question, size, low) : build_space(question, size, low);
    // Versions of Gmsh from 4.9 on have one argument more.
    gmsh::model::mesh::setSizeCallback([&](int, int, double x, double y, double z, auto...) {
      return size_at(
          question.outline, question.options,
          question.dimension == 2 ? Eigen::Vector3d(x, 0.0, y) : Eigen::Vector3d(x, y, z));
    });
    gmsh::model::mesh::generate(dimension);
    gmsh::model::mesh::setOrder(options.order);
    return read_mesh(dimension);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(fmt::format("sound: Gmsh cannot mesh the air: {}", error.what()));
  }
}

void answer_with_air(Unpacker& question, Packer& answer)
{
  pack(answer, air_by_gmsh(unpack_question(question)));
}

}  // namespace chladni::sound
