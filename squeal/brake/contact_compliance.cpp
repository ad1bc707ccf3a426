#include "squeal/brake/contact_compliance.hpp"

#include <algorithm>
#include <complex>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/pads.hpp"
#include "squeal/brake/rotation_generator.hpp"

namespace chladni::squeal {
namespace {

/// Between all contact points of the pads, (w, g_r, g_t) of one point after the other.
Eigen::MatrixXd point_compliance(const RingCompliance& rings, const PadSystem& pads)
{
  const auto n = static_cast<Eigen::Index>(3 * pads.points.size());
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < pads.points.size(); ++i)
    for (std::size_t j = 0; j < pads.points.size(); ++j) {
      const PointPair &a = pads.points[i], &b = pads.points[j];
      for (std::size_t d = 0; d < rings.C.size(); ++d)
        G.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) +=
            (std::polar(1.0, double(d) * (a.angle - b.angle)) *
             rings.C[d].block<3, 3>(static_cast<Eigen::Index>(3 * a.ring),
                                    static_cast<Eigen::Index>(3 * b.ring)))
                .real();
    }
  return G;
}

Eigen::Index pad_rows(const PadSystem& pads)
{
  return pads.n_modes() == 0 ? 3 : pair_rows_max;
}

}  // namespace

RingCompliance ring_compliance(const Disc& disc)
{
  const RingHarmonics harmonics = ring_harmonics(disc.rings);
  const auto n_columns = harmonics.c.front().cols();
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(n_columns);
  for (std::size_t k = 0; k < disc.rings.size(); ++k)
    scale.segment<2>(static_cast<Eigen::Index>(3 * k + 1)).setConstant(1.0 / disc.rings[k].radius);
  RingCompliance result{
      .C = {}, .mode_numbers = disc.mode_numbers, .lowest_omega = disc.omega.minCoeff()};
  for (std::size_t d = 0; d < harmonics.c.size(); ++d) {
    // Re(c exp(i d theta)) Re(c exp(i d alpha)) has the mean Re(c c^* exp(i d (theta - alpha)))
    // / 2.
    const Eigen::MatrixXcd c =
        disc.omega.cwiseInverse().asDiagonal() * harmonics.c[d] * scale.asDiagonal();
    result.C.emplace_back((d == 0 ? 1.0 : 0.5) * (c.transpose() * c.conjugate()));
  }
  return result;
}

StackedContact stacked_contact(const PadSystem& pads, Eigen::Index n)
{
  const Eigen::Index m = pad_rows(pads) * static_cast<Eigen::Index>(pads.points.size());
  return {Eigen::MatrixXd::Zero(n, m), Eigen::MatrixXd::Zero(m, m), Eigen::MatrixXd::Zero(m, m)};
}

StackedContact contact_at_rest(const PadSystem& pads, Eigen::Index n, double speed)
{
  StackedContact contact = stacked_contact(pads, n);
  const Eigen::Index rows = pad_rows(pads);
  Eigen::Index at = 0;
  for (const PointPair& point : pads.points) {
    const PairDerivatives d = pair_derivatives(point.contact, speed, static_cast<int>(rows));
    contact.D_a.block(at, at, rows, rows) = d.D_a;
    contact.D_p.block(at, at, rows, rows) = d.D_p;
    at += rows;
  }
  return contact;
}

ContactSeries::ContactSeries(const RingCompliance& rings, const PadSystem& pads, double speed)
    : rows_(pad_rows(pads))
{
  if (rings.empty() || pads.points.empty()) return;
  G_ = point_compliance(rings, pads);
  const Eigen::Index n = G_.rows();
  Eigen::MatrixXd D_a = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n / 3; ++i) {
    const PadContact& pad = pads.points[static_cast<std::size_t>(i)].contact;
    D_a.block<3, 3>(3 * i, 3 * i) = contact_derivatives(pad, speed).D_a;
    force_scale_ = std::max(force_scale_, pad.preload);
  }
  newton_ = Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n) - D_a * G_).partialPivLu().inverse();
  by_motion_ = newton_ * D_a;
  by_rate_ = G_ * by_motion_;
}

void ContactSeries::condense(StackedContact& contact) const
{
  if (empty()) return;
  const Eigen::Index m = contact.D_a.rows(), n = G_.rows() / 3;
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(m, m), with_rate = Eigen::MatrixXd::Identity(m, m);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      G.block<3, 3>(rows_ * i, rows_ * j) = G_.block<3, 3>(3 * i, 3 * j);
      with_rate.block<3, 3>(rows_ * i, rows_ * j) += by_rate_.block<3, 3>(3 * i, 3 * j);
    }
  const Eigen::PartialPivLU<Eigen::MatrixXd> series(
      Eigen::MatrixXd(Eigen::MatrixXd::Identity(m, m) - contact.D_a * G));
  contact.D_a = series.solve(contact.D_a).eval();
  contact.D_p = series.solve(contact.D_p * with_rate).eval();
}

}  // namespace chladni::squeal
