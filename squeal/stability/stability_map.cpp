#include "squeal/stability/stability_map.hpp"

#include <complex>
#include <numbers>

#include "squeal/parallel.hpp"
#include "squeal/stability/stability.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

void fill_row(StabilityMap& map, const Brake& brake, Eigen::Index i)
{
  for (Eigen::Index j = 0; j < map.speeds.size(); ++j) {
    const std::complex<double> lambda = least_stable_eigenvalue(brake.state_matrix(map.speeds[j]));
    map.growth(i, j) = lambda.real();
    map.frequency_Hz(i, j) = lambda.imag() / (2.0 * pi);
  }
}

}  // namespace

const char* name_of(MapParameter parameter)
{
  switch (parameter) {
    case MapParameter::friction:
      return "friction";
    case MapParameter::preload:
      return "preload";
    case MapParameter::stiffness:
      return "stiffness";
  }
  return "";
}

StabilityMap stability_map(const Brake& brake, const MapCase& range, const SpeedRange& speeds,
                           unsigned n_threads)
{
  StabilityMap map{.parameter = name_of(range.parameter),
                   .values = Eigen::VectorXd::LinSpaced(range.count, range.from, range.to),
                   .speeds = Eigen::VectorXd::LinSpaced(speeds.count, speeds.from, speeds.to),
                   .growth = Eigen::MatrixXd(range.count, speeds.count),
                   .frequency_Hz = Eigen::MatrixXd(range.count, speeds.count)};
  for_each_index(
      range.count, [&](int i) { fill_row(map, *brake.with(range.parameter, map.values[i]), i); },
      n_threads);
  return map;
}

}  // namespace chladni::squeal
