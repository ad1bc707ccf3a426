#include "squeal/brake/linear_contact.hpp"

#include <algorithm>
#include <complex>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/pad_system.hpp"

namespace chladni::squeal {

namespace {

/// Between all contact points of the pads, the rows of the disc of one point after the other.
Eigen::MatrixXd point_compliance(const RingCompliance& rings, const PadSystem& pads)
{
  const Eigen::Index m = pads.disc_rows, per_ring = m == middle_rows ? middle_rows : face_rows;
  const auto n = m * static_cast<Eigen::Index>(pads.points.size());
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(n, n);
  const auto ring_of = [&](Eigen::Index row) {
    return static_cast<Eigen::Index>(
        pads.points[static_cast<std::size_t>(row / m)].rings[row % m < per_ring ? 0 : 1]);
  };
  for (Eigen::Index i = 0; i < n; i += per_ring)
    for (Eigen::Index j = 0; j < n; j += per_ring) {
      const PointPair &at = pads.points[static_cast<std::size_t>(i / m)],
                      &of = pads.points[static_cast<std::size_t>(j / m)];
      for (std::size_t d = 0; d < rings.C.size(); ++d) {
        const int n_d = static_cast<int>(d);
        const double means = mean_over_patch(n_d, at.patch) * mean_over_patch(n_d, of.patch);
        G.block(i, j, per_ring, per_ring) +=
            means *
            (std::polar(1.0, n_d * (at.angle - of.angle)) *
             rings.C[d].block(per_ring * ring_of(i), per_ring * ring_of(j), per_ring, per_ring))
                .real();
      }
    }
  return G;
}

}  // namespace

RingCompliance ring_compliance(const Disc& disc)
{
  const RingHarmonics harmonics = ring_harmonics(disc.rings);
  Eigen::VectorXd scale(harmonics.c.front().cols());
  Eigen::Index column = 0;
  for (const DiscRing& ring : disc.rings)
    for (const RingFunction& f : functions_of(ring)) scale[column++] = 1.0 / f.scale;
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
  const Eigen::Index m = pads.rows() * static_cast<Eigen::Index>(pads.points.size());
  return {Eigen::MatrixXd::Zero(n, m), Eigen::MatrixXd::Zero(m, m), Eigen::MatrixXd::Zero(m, m)};
}

StackedContact contact_at_rest(const PadSystem& pads, Eigen::Index n, double speed)
{
  StackedContact contact = stacked_contact(pads, n);
  const Eigen::Index rows = pads.rows();
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
    : rows_(pads.rows()), disc_rows_(pads.disc_rows)
{
  if (rings.empty() || pads.points.empty()) return;
  G_ = point_compliance(rings, pads);
  const Eigen::Index n = G_.rows(), m = disc_rows_;
  Eigen::MatrixXd D_a = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n / m; ++i) {
    const PadContact& pad = pads.points[static_cast<std::size_t>(i)].contact;
    D_a.block(m * i, m * i, m, m) = pair_derivatives(pad, speed, pads.disc_rows).D_a;
    force_scale_ = std::max(force_scale_, pad.preload);
  }
  newton_ = Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n) - D_a * G_).partialPivLu().inverse();
  by_motion_ = newton_ * D_a;
  by_rate_ = G_ * by_motion_;
}

void ContactSeries::condense(StackedContact& contact) const
{
  if (empty()) return;
  const Eigen::Index m = contact.D_a.rows(), r = disc_rows_, n = G_.rows() / r;
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(m, m), with_rate = Eigen::MatrixXd::Identity(m, m);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      G.block(rows_ * i, rows_ * j, r, r) = G_.block(r * i, r * j, r, r);
      with_rate.block(rows_ * i, rows_ * j, r, r) += by_rate_.block(r * i, r * j, r, r);
    }
  const Eigen::PartialPivLU<Eigen::MatrixXd> series(
      Eigen::MatrixXd(Eigen::MatrixXd::Identity(m, m) - contact.D_a * G));
  contact.D_a = series.solve(contact.D_a).eval();
  contact.D_p = series.solve(contact.D_p * with_rate).eval();
}

StackedContact linear_contact(const InertialDisc& disc, const PadSystem& pads, double speed)
{
  StackedContact all = contact_at_rest(pads, disc.n_modes() + pads.n_modes(), speed);
  Eigen::Index at = 0;
  for (const PointPair& point : pads.points) {
    const PairShapes S = pair_shapes(shapes_at(disc, point), pads, point);
    all.S.middleCols(at, S.cols()) = S;
    at += S.cols();
  }
  ContactSeries(disc.compliance, pads, speed).condense(all);
  return all;
}

Eigen::MatrixXd state_matrix(const InertialDisc& disc, const SquealOptions& options, double speed)
{
  const PadSystem pads = pad_system(options, ring_places(disc));
  const InertialDisc brake = with_pads(disc, pads);
  const Eigen::Index n = brake.n_modes();
  const StackedContact contact = linear_contact(disc, pads, speed);
  const Eigen::MatrixXd K = -contact.S * contact.D_a * contact.S.transpose();
  const Eigen::MatrixXd C =
      brake.C + 2.0 * speed * brake.G - contact.S * contact.D_p * contact.S.transpose();
  const Eigen::MatrixXd omega = brake.omega.asDiagonal();
  const Eigen::MatrixXd by_omega = brake.omega.cwiseInverse().asDiagonal();
  Eigen::MatrixXd A(2 * n, 2 * n);
  A << -speed * brake.D, omega, -omega - K * by_omega, -speed * brake.D - C;
  return A;
}

Eigen::MatrixXd smooth_state_matrix(const InertialDisc& disc, const SquealOptions& options,
                                    double speed)
{
  const Eigen::MatrixXd A = state_matrix(disc, options, speed), Psi = pad_basis(options);
  const Eigen::Index n = A.rows() / 2, m = Psi.rows();
  if (m == 0) return A;
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  T.block(n - m, n - m, m, m) = Psi;
  T.bottomRightCorner(m, m) = Psi;
  return T * A * T.transpose();
}

}  // namespace chladni::squeal
