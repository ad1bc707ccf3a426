#include "mbs_export/mode_shift.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/orthogonal_factor.hpp"
#include "mbs_export/body_option_error.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double largest_condition = 1e6;
constexpr double largest_rounding = 1e-6;  // of the lowest eigenvalue

double condition(const MatrixXd& Q_dd)
{
  if (Q_dd.size() == 0) return 1.0;
  const VectorXd s = Eigen::JacobiSVD<MatrixXd>(Q_dd).singularValues();
  const double smallest = s[s.size() - 1];
  return smallest > 0.0 ? s[0] / smallest : std::numeric_limits<double>::infinity();
}

/// Displacements and rotations of a body much smaller or larger than 1 m differ in size, which
/// costs no digits.
MatrixXd rows_of_unit_length(MatrixXd Q)
{
  for (Index i = 0; i < Q.rows(); ++i)
    if (const double norm = Q.row(i).norm(); norm > 0.0) Q.row(i) /= norm;
  return Q;
}

/// Columns of A in the order of a pivoted QR, as far as they are independent.
std::vector<int> independent_columns(const MatrixXd& A, double threshold)
{
  if (A.size() == 0) return {};
  Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
  qr.setThreshold(threshold);
  const auto& order = qr.colsPermutation().indices();
  return {order.data(), order.data() + qr.rank()};
}

/// 1 for rigid modes, omega_1 / omega for elastic ones: a high mode can follow a held displacement
/// only at the price of accuracy in all others.
VectorXd preference(const FreeModes& modes)
{
  VectorXd weight = VectorXd::Ones(modes.omega.size());
  for (Index i = modes.n_rigid; i < weight.size(); ++i)
    weight[i] = modes.omega[modes.n_rigid] / modes.omega[i];
  return weight;
}

/// Rigid modes first; what they cannot follow is left to elastic modes.
std::vector<int> rigid_then_elastic(const FreeModes& modes, const MatrixXd& Q_held)
{
  std::vector<int> chosen =
      independent_columns(Q_held.leftCols(modes.n_rigid), 1.0 / largest_condition);
  if (Index(chosen.size()) == Q_held.rows()) return chosen;
  MatrixXd rest = Q_held * preference(modes).asDiagonal();
  rest.leftCols(modes.n_rigid).setZero();
  if (!chosen.empty()) {
    const Eigen::HouseholderQR<MatrixXd> qr(Q_held(every, chosen));
    const MatrixXd V = linear::columns_of_Q(qr, Index(chosen.size()));
    rest -= V * (V.transpose() * rest).eval();
  }
  for (const int i : independent_columns(rest, 1e-14))
    if (Index(chosen.size()) < Q_held.rows()) chosen.push_back(i);
  return chosen;
}

/// The modes that are not `dependent`, ascending.
std::vector<int> complement(const std::vector<int>& dependent, Index n_modes)
{
  std::vector<int> independent;
  for (int i = 0; i < n_modes; ++i)
    if (std::ranges::find(dependent, i) == dependent.end()) independent.push_back(i);
  return independent;
}

/// Held DOFs whose rows in Q_dd depend on the others.
std::string dependent_names(const MatrixXd& Q_dd, const HeldDofs& held)
{
  const std::vector<int> independent =
      independent_columns(Q_dd.transpose(), 1.0 / largest_condition);
  std::vector<std::string> names;
  for (const int i : complement(independent, Q_dd.rows()))
    names.push_back(held.names[static_cast<std::size_t>(i)]);
  return fmt::format("{}", fmt::join(names.empty() ? held.names : names, ", "));
}

}  // namespace

MatrixXd unheld_combinations(const MatrixXd& held_displacements)
{
  const Index n_rigid = held_displacements.cols();
  if (held_displacements.size() == 0) return MatrixXd::Identity(n_rigid, n_rigid);
  Eigen::JacobiSVD<MatrixXd> svd(rows_of_unit_length(held_displacements), Eigen::ComputeFullV);
  svd.setThreshold(1.0 / largest_condition);
  return svd.matrixV().rightCols(n_rigid - svd.rank());
}

namespace {

ModeShift shift_by(const FreeModes& modes, const HeldDofs& held, const std::vector<int>& dependent)
{
  if (dependent.size() != held.dofs.size()) {
    throw Error(fmt::format("mode shifting: {} dependent modes for {} held displacements",
                            dependent.size(), held.dofs.size()));
  }
  const MatrixXd Q_held = held.displacements(modes.Q_e);
  const std::vector<int> independent = complement(dependent, modes.omega.size());
  const MatrixXd Q_dd = Q_held(every, dependent);
  const double directions = condition(rows_of_unit_length(Q_dd));
  if (!(directions <= largest_condition)) {
    throw BodyOptionError(
        "fixed",
        fmt::format(
            "mode shifting: cond(Q_dd) = {:.1e} with the dependent modes {}, so {} cannot be held; "
            "choose other dependent modes or fix fewer displacements",
            directions, fmt::join(dependent, ", "), dependent_names(Q_dd, held)));
  }

  // q_d = G q_i,  K_c = G^T Lambda_d G + Lambda_i,  M_c = G^T G + I
  const VectorXd lambda = modes.omega.cwiseAbs2();
  const MatrixXd G = -Q_dd.partialPivLu().solve(MatrixXd(Q_held(every, independent)));
  const Index n_i = Index(independent.size());
  ModeShift shift{.Q_c = MatrixXd::Zero(modes.omega.size(), n_i),
                  .K_c = G.transpose() * lambda(dependent).asDiagonal() * G,
                  .M_c = G.transpose() * G,
                  .R_c = {},
                  .dependent = dependent,
                  .condition_Q_dd = condition(Q_dd),
                  .condition_directions = directions};
  shift.Q_c(dependent, every) = G;
  shift.Q_c(independent, every).setIdentity();
  shift.K_c.diagonal() += lambda(independent);
  shift.M_c.diagonal().array() += 1.0;
  const MatrixXd left = unheld_combinations(Q_held.leftCols(modes.n_rigid));
  MatrixXd q = MatrixXd::Zero(modes.omega.size(), left.cols());
  q.topRows(modes.n_rigid) = left;
  shift.R_c = q(independent, every);
  return shift;
}

/// Stiff dependent modes that move a lot bury the soft modes of the result in rounding.
void refuse_cancellation(const ModeShift& shift, const FreeModes& modes)
{
  if (modes.n_rigid >= modes.omega.size() || shift.Q_c.cols() == 0) return;
  const MatrixXd G = shift.Q_c(shift.dependent, every);
  const VectorXd lambda = modes.omega(shift.dependent).cwiseAbs2();
  const double stiffest = (G.cwiseAbs2().transpose() * lambda).maxCoeff();
  const double softest = modes.omega[modes.n_rigid] * modes.omega[modes.n_rigid];
  const double lost = std::numeric_limits<double>::epsilon() * stiffest / softest;
  if (lost > largest_rounding) {
    throw Error(fmt::format(
        "mode shifting: with the dependent modes {} the lowest eigenvalues are rounded by {:.0e}; "
        "choose dependent modes of lower frequency",
        fmt::join(shift.dependent, ", "), lost));
  }
}

}  // namespace

ModeShift shift_modes(const FreeModes& modes, const HeldDofs& held)
{
  const MatrixXd Q_held = rows_of_unit_length(held.displacements(modes.Q_e));
  std::vector<int> dependent = rigid_then_elastic(modes, Q_held);
  const bool complete = Index(dependent.size()) == Q_held.rows();
  if (!complete || condition(rows_of_unit_length(Q_held(every, dependent))) > largest_condition) {
    dependent = independent_columns(Q_held * preference(modes).asDiagonal(), 1e-14);
    if (dependent.size() < held.dofs.size()) {
      throw BodyOptionError("fixed", fmt::format("mode shifting: the modes cannot hold {} apart "
                                                 "from the other held displacements; fix "
                                                 "fewer, or reduce with more masters or modes",
                                                 dependent_names(Q_held, held)));
    }
  }
  std::ranges::sort(dependent);
  return shift_by(modes, held, dependent);
}

ModeShift shift_modes(const FreeModes& modes, const HeldDofs& held,
                      const std::vector<int>& dependent)
{
  ModeShift shift = shift_by(modes, held, dependent);
  refuse_cancellation(shift, modes);
  return shift;
}

}  // namespace chladni::mbs_export
