#include "mesh/graded_sizes.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace chladni::mesh {

namespace {

constexpr double growth = 0.4;  ///< of the size with the distance

double distance(const std::array<double, 3>& x, const std::array<double, 3>& y)
{
  return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
}

}  // namespace

GradedSizes::GradedSizes(std::vector<SizeAt> places)
{
  std::ranges::sort(places, {}, &SizeAt::size);
  for (const SizeAt& place : places)
    if (place.size < at(place.x)) places_.push_back(place);
}

double GradedSizes::at(const std::array<double, 3>& x) const
{
  double least = std::numeric_limits<double>::infinity();
  for (const SizeAt& place : places_) {
    if (place.size >= least) break;
    least = std::min(least, place.size + growth * distance(x, place.x));
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
