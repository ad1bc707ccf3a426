#include "squeal/stability/stability_map.hpp"

#include <numbers>

#include "common/error.hpp"
#include "squeal/parallel.hpp"
#include "squeal/stability/stability.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

void fill_row(StabilityMap& map, const StateMatrixAt& A, Eigen::Index i)
{
  for (Eigen::Index j = 0; j < map.speeds.size(); ++j) {
    const std::complex<double> lambda = least_stable_eigenvalue(A(map.speeds[j]));
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

SquealOptions with_parameter(SquealOptions options, MapParameter parameter, double value)
{
  if (parameter == MapParameter::friction) options.friction.kinetic = value;
  for (PadPair& pad : options.pads) {
    if (parameter == MapParameter::preload) pad.preload = value;
    if (parameter == MapParameter::stiffness) pad.stiffness = value;
  }
  return options;
}

StabilityMap stability_map(const std::function<StateMatrixAt(double)>& A_of, const MapCase& range,
                           const SpeedRange& speeds, unsigned n_threads)
{
  StabilityMap map{.parameter = name_of(range.parameter),
                   .values = Eigen::VectorXd::LinSpaced(range.count, range.from, range.to),
                   .speeds = Eigen::VectorXd::LinSpaced(speeds.count, speeds.from, speeds.to),
                   .growth = Eigen::MatrixXd(range.count, speeds.count),
                   .frequency_Hz = Eigen::MatrixXd(range.count, speeds.count)};
  for_each_index(
      range.count, [&](int i) { fill_row(map, A_of(map.values[i]), i); }, n_threads);
  return map;
}

StabilityMap stability_map(const InertialDisc& disc, const SquealOptions& options,
                           unsigned n_threads)
{
  if (!options.study.map) throw Error("stability map: no second parameter is given");
  const auto A_of = [&](double value) -> StateMatrixAt {
    return [&disc, changed = with_parameter(options, options.study.map->parameter, value)](
               double speed) { return state_matrix(disc, changed, speed); };
  };
  return stability_map(A_of, *options.study.map, options.study.speeds, n_threads);
}

}  // namespace chladni::squeal
