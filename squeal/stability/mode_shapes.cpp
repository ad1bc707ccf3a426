#include "squeal/stability/mode_shapes.hpp"

#include <complex>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake/state_matrix.hpp"
#include "squeal/parallel.hpp"

namespace chladni::squeal {
namespace {

/// Of norm 1, turned in time so that the largest component is real and positive.
Eigen::VectorXcd normalised(const Eigen::VectorXcd& shape)
{
  Eigen::Index largest = 0;
  const double modulus = shape.cwiseAbs().maxCoeff(&largest);
  return shape * (std::conj(shape[largest]) / (modulus * shape.norm()));
}

}  // namespace

std::vector<Eigen::MatrixXcd> mode_shapes(const InertialDisc& disc, const SquealOptions& options,
                                          const EigenvalueMap& map)
{
  const InertialDisc brake = with_pads(disc, pad_system(options, ring_places(disc)));
  const Eigen::Index n = brake.n_modes();
  std::vector<Eigen::MatrixXcd> shapes(static_cast<std::size_t>(map.speeds.size()));
  for_each_index(static_cast<int>(map.speeds.size()), [&](int i) {
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(state_matrix(disc, options, map.speeds[i]));
    Eigen::MatrixXcd at_speed(n, map.lambda.cols());
    for (Eigen::Index j = 0; j < map.lambda.cols(); ++j) {
      Eigen::Index nearest = 0;
      (solver.eigenvalues().array() - map.lambda(i, j)).abs().minCoeff(&nearest);
      const Eigen::VectorXcd a = solver.eigenvectors().col(nearest).head(n).cwiseQuotient(
          brake.omega.cast<std::complex<double>>());
      at_speed.col(j) = normalised(brake.R.cast<std::complex<double>>() * a);
    }
    shapes[static_cast<std::size_t>(i)] = at_speed;
  });
  return shapes;
}

}  // namespace chladni::squeal
