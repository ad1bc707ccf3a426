#include "squeal/brake/ring_shapes.hpp"
#include "common/eigen_every.hpp"

#include <cmath>

namespace chladni::squeal {
namespace {

/// Part of the largest coefficient of a function below which another one is rounding.
constexpr double negligible = 1e-15;

}  // namespace

RingShapes::RingShapes(const DiscRing& ring)
{
  const std::vector<RingFunction> functions = functions_of(ring);
  const auto n_functions = static_cast<Eigen::Index>(functions.size());
  shapes_.resize(ring.W.cosine.cols(), n_functions);
  const Eigen::Index n_orders = ring.W.cosine.rows(), n = ring.W.cosine.cols();
  Eigen::MatrixXd all(n_functions * n, 2 * n_orders);
  for (Eigen::Index j = 0; j < n_functions; ++j) {
    const Harmonics& f = *functions[static_cast<std::size_t>(j)].values;
    for (Eigen::Index k = 0; k < n_orders; ++k) {
      all.col(2 * k).segment(n * j, n) = f.cosine.row(k).transpose();
      all.col(2 * k + 1).segment(n * j, n) = f.sine.row(k).transpose();
    }
  }
  const Eigen::ArrayXd limit = negligible * all.cwiseAbs().rowwise().maxCoeff();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < n_orders; ++k) {
    const auto magnitude = all.middleCols(2 * k, 2).cwiseAbs().rowwise().maxCoeff().array();
    if (!(magnitude > limit).any()) continue;
    orders_.push_back(static_cast<int>(k));
    kept.insert(kept.end(), {2 * k, 2 * k + 1});
  }
  coefficients_ = all(every, kept);
  waves_.resize(coefficients_.cols());
}

const Eigen::MatrixXd& RingShapes::at(double theta)
{
  const double c_1 = std::cos(theta), s_1 = std::sin(theta);
  double c = 1.0, s = 0.0;
  int k = 0;
  for (std::size_t i = 0; i < orders_.size(); ++i) {
    for (; k < orders_[i]; ++k) {
      const double next = c * c_1 - s * s_1;
      s = s * c_1 + c * s_1;
      c = next;
    }
    waves_[static_cast<Eigen::Index>(2 * i)] = c;
    waves_[static_cast<Eigen::Index>(2 * i + 1)] = s;
  }
  Eigen::Map<Eigen::VectorXd>(shapes_.data(), shapes_.size()).noalias() = coefficients_ * waves_;
  return shapes_;
}

}  // namespace chladni::squeal
