#include "mbs_export/held_modes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/body_options.hpp"
#include "mbs_export/free_modes.hpp"

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double largest_condition = 1e6;
constexpr double largest_rounding = 1e-6;  // of the lowest eigenvalue

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
  const double directions = linear::condition_number(rows_of_unit_length(Q_dd));
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
                  .condition_Q_dd = linear::condition_number(Q_dd),
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

/// Dependent modes for a support, ascending, and whether they hold its displacements apart.
struct DependentModes {
  std::vector<int> of_free;
  bool hold = false;
};

/// @param Q_held  [n_c x n_modes] held displacements, each row of unit length
DependentModes dependent_modes(const FreeModes& modes, const MatrixXd& Q_held)
{
  const auto hold = [&](const std::vector<int>& chosen) {
    return Index(chosen.size()) == Q_held.rows() &&
           linear::condition_number(rows_of_unit_length(Q_held(every, chosen))) <=
               largest_condition;
  };
  DependentModes found{.of_free = rigid_then_elastic(modes, Q_held)};
  found.hold = hold(found.of_free);
  if (!found.hold) {
    found.of_free = independent_columns(Q_held * preference(modes).asDiagonal(), 1e-14);
    found.hold = hold(found.of_free);
  }
  std::ranges::sort(found.of_free);
  return found;
}

}  // namespace

ModeShift shift_modes(const FreeModes& modes, const HeldDofs& held)
{
  const MatrixXd Q_held = rows_of_unit_length(held.displacements(modes.Q_e));
  const DependentModes dependent = dependent_modes(modes, Q_held);
  if (dependent.of_free.size() < held.dofs.size()) {
    throw BodyOptionError(
        "fixed", fmt::format("mode shifting: the modes cannot hold {} apart from the other held "
                             "displacements; fix fewer, or reduce with more masters or modes",
                             dependent_names(Q_held, held)));
  }
  return shift_by(modes, held, dependent.of_free);
}

ModeShift shift_modes(const FreeModes& modes, const HeldDofs& held,
                      const std::vector<int>& dependent)
{
  ModeShift shift = shift_by(modes, held, dependent);
  refuse_cancellation(shift, modes);
  return shift;
}

namespace {

constexpr double partner_gap = 1e-4;

double hertz(double omega)
{
  return omega / (2.0 * std::numbers::pi);
}

/// The modes asked for, true at each index.
std::vector<char> chosen(const Eigen::VectorXd& omega, const KeptModes& keep)
{
  const Index n = omega.size();
  std::vector<char> is_kept(static_cast<std::size_t>(n), !keep.list);
  if (keep.count) {
    if (*keep.count < 0 || *keep.count > n) {
      throw BodyOptionError(
          "keep.modes", fmt::format("{} modes asked for, the held body has {}", *keep.count, n));
    }
    std::fill(is_kept.begin() + *keep.count, is_kept.end(), false);
  } else if (keep.up_to_Hz) {
    for (Index i = 0; i < n; ++i) is_kept[i] = hertz(omega[i]) <= *keep.up_to_Hz;
  } else if (keep.list) {
    for (const int number : *keep.list) {
      if (number < 1 || number > n) {
        throw BodyOptionError("keep.list",
                              fmt::format("mode {} asked for, the modes are 1 to {}", number, n));
      }
      is_kept[number - 1] = true;
    }
  }
  return is_kept;
}

}  // namespace

ConstrainedModes constrained_modes(const ModeShift& shift)
{
  const linear::Eigenmodes elastic = linear::eigenmodes(shift.K_c, shift.M_c, shift.R_c);
  const Index n_rigid = shift.R_c.cols(), n_elastic = elastic.lambda.size();
  ConstrainedModes modes{.omega = Eigen::VectorXd::Zero(n_rigid + n_elastic),
                         .X = Eigen::MatrixXd(shift.K_c.rows(), n_rigid + n_elastic),
                         .n_rigid = static_cast<int>(n_rigid)};
  modes.omega.tail(n_elastic) = elastic.lambda.cwiseSqrt();
  modes.X << shift.R_c, elastic.X;
  return modes;
}

std::vector<ModeCluster> mode_clusters(const Eigen::VectorXd& omega)
{
  std::vector<ModeCluster> clusters;
  for (int first = 0, end; first < int(omega.size()); first = end) {
    for (end = first + 1; end < int(omega.size()); ++end)
      if (omega[end] - omega[end - 1] > partner_gap * omega[end]) break;
    clusters.push_back({first, end});
  }
  return clusters;
}

ModeSelection select_modes(const Eigen::VectorXd& omega, const KeptModes& keep)
{
  if (int(keep.count.has_value()) + int(keep.up_to_Hz.has_value()) + int(keep.list.has_value()) >
      1) {
    throw BodyOptionError("keep",
                          "give only one of a number of modes, a highest frequency, and a list");
  }
  const std::vector<char> asked = chosen(omega, keep);
  ModeSelection selection{.kept = {}, .neglected = {}, .n_partners = 0};
  for (const auto [first, end] : mode_clusters(omega)) {
    const auto n_asked = std::count(asked.begin() + first, asked.begin() + end, true);
    if (n_asked > 0) selection.n_partners += end - first - static_cast<int>(n_asked);
    for (int i = first; i < end; ++i)
      (n_asked > 0 ? selection.kept : selection.neglected).push_back(i);
  }
  if (selection.kept.empty()) {
    throw BodyOptionError(
        "keep", fmt::format("no mode is left; the lowest of {} has {:.6g} Hz", omega.size(),
                            omega.size() > 0 ? hertz(omega[0]) : 0.0));
  }
  return selection;
}

namespace {

/// All modes, where a held displacement is a combination of coordinates.
HeldModeShapes by_mode_shift(const ReducedSystem& reduced, const HeldDofs& held)
{
  const FreeModes free = orthogonalize(reduced);
  const ModeShift shift = shift_modes(free, held);
  const ConstrainedModes modes = constrained_modes(shift);
  const Index n_elastic = modes.omega.size() - modes.n_rigid;
  return {.omega = modes.omega.tail(n_elastic),
          .X = free.Q_e * (shift.Q_c * modes.X.rightCols(n_elastic)),
          .n_rigid = modes.n_rigid,
          .n_free_rigid = free.n_rigid};
}

std::vector<int> other_rows(const std::vector<int>& rows, Index n)
{
  std::vector<int> others;
  for (int i = 0; i < n; ++i)
    if (!std::ranges::binary_search(rows, i)) others.push_back(i);
  return others;
}

/// The rigid-body motions that a support leaves, M_r-orthonormal.
MatrixXd unheld_motions(const RigidModes& rigid, const HeldDofs& held)
{
  return rigid.R * unheld_combinations(rigid.R(held.rows, every));
}

/// Without the rows and columns of the held masters.
HeldModeShapes by_elimination(const ReducedSystem& reduced, const HeldDofs& held,
                              const RigidModes& rigid, const linear::LowestModes& wanted)
{
  const MatrixXd unheld = unheld_motions(rigid, held);
  const std::vector<int> rows = other_rows(held.rows, reduced.K.rows());
  const linear::Eigenmodes elastic = linear::lowest_eigenmodes(
      reduced.K(rows, rows), reduced.M(rows, rows), unheld(rows, every), wanted);
  HeldModeShapes shapes{.omega = elastic.lambda.cwiseSqrt(),
                        .X = MatrixXd::Zero(reduced.K.rows(), elastic.X.cols()),
                        .n_rigid = static_cast<int>(unheld.cols()),
                        .n_free_rigid = static_cast<int>(rigid.R.cols())};
  shapes.X(rows, every) = elastic.X;
  return shapes;
}

}  // namespace

HeldModeShapes held_mode_shapes(const ReducedSystem& reduced, const std::vector<std::string>& fixed,
                                const linear::LowestModes& wanted)
{
  const HeldDofs held = held_dofs(reduced, fixed);
  refuse_drilling_support(reduced, held);
  if (!held.are_masters()) return by_mode_shift(reduced, held);
  return by_elimination(reduced, held, rigid_modes(reduced), wanted);
}

HeldBody held_body(const ReducedSystem& reduced, const std::vector<std::string>& fixed)
{
  HeldBody body{.free = orthogonalize(reduced), .held = held_dofs(reduced, fixed)};
  refuse_drilling_support(reduced, body.held);
  const MatrixXd Q_held = rows_of_unit_length(body.held.displacements(body.free.Q_e));
  const DependentModes dependent = dependent_modes(body.free, Q_held);
  if (body.held.are_masters() && !dependent.hold) {
    const RigidModes rigid = rigid_modes(reduced);
    const HeldModeShapes elastic = by_elimination(reduced, body.held, rigid, {});
    body.n_rigid = elastic.n_rigid;
    body.omega = VectorXd::Zero(elastic.n_rigid + elastic.omega.size());
    body.omega.tail(elastic.omega.size()) = elastic.omega;
    body.T.resize(reduced.K.rows(), body.omega.size());
    body.T << unheld_motions(rigid, body.held), elastic.X;
  } else {
    const ModeShift shift = dependent.hold ? shift_by(body.free, body.held, dependent.of_free)
                                           : shift_modes(body.free, body.held);
    ConstrainedModes constrained = constrained_modes(shift);
    body.n_rigid = constrained.n_rigid;
    body.omega = std::move(constrained.omega);
    body.condition_Q_dd = shift.condition_Q_dd;
    body.condition_directions = shift.condition_directions;
    body.T = body.free.Q_e * (shift.Q_c * constrained.X);
  }
  body.U = attachment_motion(reduced, body.T);
  return body;
}

double rigid_residual(const ReducedSystem& reduced)
{
  const RigidModes rigid = rigid_modes(reduced);
  if (rigid.R.cols() == 0) return 0.0;
  const double first = linear::first_eigenvalue(reduced.K, reduced.M, rigid.R);
  return first > 0.0 ? rigid.largest_energy / first : 0.0;
}

namespace {

/// `node 17 belongs to ... by a numerical stiffness alone`
std::string words_of(const ReducedSystem& reduced, int node, int component)
{
  const AttachmentNode& at = reduced.attachment_nodes[static_cast<std::size_t>(node)];
  return fmt::format(
      "node {} belongs to a smooth shell, whose elements resist the rotation {} about its normal "
      "by a numerical stiffness alone",
      at.number, component_name(component));
}

constexpr const char* couple_instead =
    "or couple a group of nodes rigidly ([[coupling]], type \"rigid\") and take the coupling's "
    "name";

/// What the held DOFs show of each held node's rotation about its own drilling axis, in which it
/// may go along with the body as if it were not held; of the size of the axis.
MatrixXd drilling_spins(const ReducedSystem& reduced, const HeldDofs& held)
{
  const auto n = static_cast<Index>(held.dofs.size());
  std::map<int, Eigen::VectorXd> spins;
  for (Index i = 0; i < n; ++i) {
    const int dof = held.dofs[static_cast<std::size_t>(i)];
    if (!is_drilling(reduced, dof / 6, dof % 6)) continue;
    const auto& axis = reduced.attachment_nodes[static_cast<std::size_t>(dof / 6)].drilling_axis;
    Eigen::VectorXd& spin = spins.try_emplace(dof / 6, Eigen::VectorXd::Zero(n)).first->second;
    spin[i] = axis[dof % 6 - 3];
  }
  MatrixXd columns(n, std::ssize(spins));
  Index j = 0;
  for (const auto& [node, spin] : spins) columns.col(j++) = spin;
  return columns;
}

}  // namespace

bool is_drilling(const ReducedSystem& reduced, int node, int component)
{
  constexpr double tilt = 1e-2;  // rad: normals of a mesh of a curved shell are as exact as that
  if (component < 3) return false;
  const AttachmentNode& at = reduced.attachment_nodes[static_cast<std::size_t>(node)];
  return std::abs(at.drilling_axis[component - 3]) > tilt;
}

void refuse_drilling_load(const ReducedSystem& reduced, int node, int component)
{
  if (!is_drilling(reduced, node, component)) return;
  throw BodyOptionError(
      "interface_modes",
      fmt::format("{}, so that a moment about it would only turn this node; take {} out of "
                  "\"dofs\", {}",
                  words_of(reduced, node, component), component_name(component), couple_instead));
}

void refuse_drilling_support(const ReducedSystem& reduced, const HeldDofs& held)
{
  const auto first = std::ranges::find_if(
      held.dofs, [&](int dof) { return is_drilling(reduced, dof / 6, dof % 6); });
  if (first == held.dofs.end()) return;
  const MatrixXd motion = attachment_motion(reduced, rigid_modes(reduced).R)(held.dofs, every);
  const MatrixXd spins = drilling_spins(reduced, held);
  MatrixXd both(motion.rows(), motion.cols() + spins.cols());
  both << motion, spins;
  const Index n_free = unheld_combinations(motion).cols();
  if (unheld_combinations(both).cols() == n_free) return;
  throw BodyOptionError(
      "fixed", fmt::format("{}, and nothing else holds the body there; hold displacements of "
                           "another node as "
                           "well, {}",
                           words_of(reduced, *first / 6, *first % 6), couple_instead));
}

}  // namespace chladni::mbs_export
