#include "squeal/stability/stability_map.hpp"

#include <numbers>

#include "squeal/parallel.hpp"
#include "squeal/stability/column_eigenvalues.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

void fill_column(StabilityMap& map, const Brake& brake, MapParameter parameter, Eigen::Index j)
{
  const auto A = [&](Eigen::Index i) {
    return brake.with(parameter, map.values[i])->state_matrix(map.speeds[j]);
  };
  const Eigen::VectorXcd lambda = least_stable_eigenvalues(A, map.values.size()).lambda;
  map.growth.col(j) = lambda.real();
  map.frequency_Hz.col(j) = lambda.imag() / (2.0 * pi);
}

}  // namespace

StabilityMap stability_map(const Brake& brake, const MapCase& range, const SpeedRange& speeds,
                           unsigned n_threads)
{
  StabilityMap map{.parameter = key_of(range.parameter),
                   .values = Eigen::VectorXd::LinSpaced(range.count, range.from, range.to),
                   .speeds = Eigen::VectorXd::LinSpaced(speeds.count, speeds.from, speeds.to),
                   .growth = Eigen::MatrixXd(range.count, speeds.count),
                   .frequency_Hz = Eigen::MatrixXd(range.count, speeds.count)};
  for_each_index(
      speeds.count, [&](int j) { fill_column(map, brake, range.parameter, j); }, n_threads);
  return map;
}

}  // namespace chladni::squeal
