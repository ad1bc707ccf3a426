#include "mesh/gmsh/graded_sizes.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

namespace chladni::mesh {

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
