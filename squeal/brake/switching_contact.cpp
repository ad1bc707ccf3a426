#include "squeal/brake/switching_contact.hpp"

#include <complex>
#include <span>
#include <utility>

#include "squeal/brake/contact.hpp"
#include "squeal/numerics.hpp"

namespace chladni::squeal {

Eigen::MatrixXd force_derivative(const BrakePoint& point, const PairVector<double>& g,
                                 const PairVector<double>& g_dot,
                                 const std::pair<double, std::span<const double>>& at)
{
  using Complex = std::complex<double>;
  const Eigen::Index rows = g.size();
  Eigen::MatrixXd D(rows, 2 * rows);
  for (Eigen::Index j = 0; j < 2 * rows; ++j) {
    PairVector<Complex> x = g.cast<Complex>(), v = g_dot.cast<Complex>();
    (j < rows ? x[j] : v[j - rows]) += Complex(0.0, complex_step);
    D.col(j) = force_on_branch<Complex>(point, pair_motion(x, v), at.first, at.second).imag() /
               complex_step;
  }
  return D;
}

SwitchingContact::SwitchingContact(const RingCompliance& compliance, PadSystem pads, ContactLaw law,
                                   double speed)
    : speed_(speed),
      pulled_(pulled_branch(law)),
      pads_(std::move(pads)),
      series_(compliance, pads_, speed),
      motions_(pads_.points.size()),
      branches_(2 * pads_.points.size(), 1.0),
      S_(law == ContactLaw::signed_force
             ? Eigen::VectorXd()
             : Eigen::VectorXd::Zero(static_cast<Eigen::Index>(branches_.size())))
{}

void SwitchingContact::follow_on_branches()
{
  series_.add_to(motions_, [&](std::size_t i, const PointMotion& at) {
    return force_on_branch<double>(points_[i], pair_motion(at.g, at.g_dot), speed_,
                                   std::span(branches_).subspan(2 * i, 2));
  });
}

void SwitchingContact::add_forces(Eigen::Ref<Eigen::VectorXd> p_dot)
{
  follow_on_branches();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PairShapes& S = points_[i].S;
    const PadContact& pad = points_[i].contact;
    const PairMotion<double> motion = pair_motion(motions_[i].g, motions_[i].g_dot);
    const ContactResult<double> at =
        contact_on_branch(pad, motion, speed_, std::span(branches_).subspan(2 * i, 2));
    if (S_.size() > 0) {
      const auto first = static_cast<Eigen::Index>(2 * i);
      S_[first] = pressure(pad, at.upper, motion.upper.upper, 1.0);
      S_[first + 1] = pressure(pad, at.lower, motion.lower.lower, -1.0);
    }
    p_dot.noalias() +=
        S * pair_forces(pad, motion, at, points_[i].at_rest, static_cast<int>(S.cols()));
  }
}

StackedContact SwitchingContact::derivatives(Eigen::Index n)
{
  follow_on_branches();
  StackedContact contact = stacked_contact(pads_, n);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PairShapes& S = points_[i].S;
    const Eigen::MatrixXd D = force_derivative(points_[i], motions_[i].g, motions_[i].g_dot,
                                               {speed_, std::span(branches_).subspan(2 * i, 2)});
    const Eigen::Index at = S.cols() * static_cast<Eigen::Index>(i);
    contact.S.middleCols(at, S.cols()) = S;
    contact.D_a.block(at, at, S.cols(), S.cols()) = D.leftCols(S.cols());
    contact.D_p.block(at, at, S.cols(), S.cols()) = D.rightCols(S.cols());
  }
  series_.condense(contact);
  return contact;
}

std::vector<ContactResult<double>> SwitchingContact::contacts()
{
  series_.add_to(motions_, [&](std::size_t i, const PointMotion& at) {
    return contact_at(points_[i], at, speed_).force;
  });
  std::vector<ContactResult<double>> results;
  for (std::size_t i = 0; i < points_.size(); ++i)
    results.push_back(contact_at(points_[i], motions_[i], speed_).states);
  return results;
}

double SwitchingContact::side(Eigen::Index i) const
{
  return branches_[static_cast<std::size_t>(i)] == 1.0 ? 1.0 : -1.0;
}

void SwitchingContact::set_side(Eigen::Index i, double side)
{
  branches_[static_cast<std::size_t>(i)] = side > 0.0 ? 1.0 : pulled_;
}

}  // namespace chladni::squeal
