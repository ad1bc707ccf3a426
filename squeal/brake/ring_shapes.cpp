#include "squeal/brake/ring_shapes.hpp"
#include "common/eigen_every.hpp"

#include <cmath>

namespace chladni::squeal {
namespace {

/// Part of the largest coefficient of a function below which another one is rounding.
constexpr double negligible = 1e-15;

Eigen::VectorXd column_of(const Eigen::MatrixXd& W, const Eigen::MatrixXd& W_r,
                          const Eigen::MatrixXd& W_t, Eigen::Index k)
{
  Eigen::VectorXd column(3 * W.cols());
  column << W.row(k).transpose(), W_r.row(k).transpose(), W_t.row(k).transpose();
  return column;
}

}  // namespace

RingShapes::RingShapes(const DiscRing& ring) : shapes_(ring.W.cosine.cols(), 3)
{
  const Eigen::Index n_orders = ring.W.cosine.rows(), n = ring.W.cosine.cols();
  Eigen::MatrixXd all(3 * n, 2 * n_orders);
  for (Eigen::Index k = 0; k < n_orders; ++k) {
    all.col(2 * k) = column_of(ring.W.cosine, ring.W_r.cosine, ring.W_t.cosine, k);
    all.col(2 * k + 1) = column_of(ring.W.sine, ring.W_r.sine, ring.W_t.sine, k);
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

const Eigen::MatrixX3d& RingShapes::at(double theta)
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
