#include "mbs_export/make_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/body_options.hpp"
#include "mbs_export/free_modes.hpp"
#include "mbs_export/held_modes.hpp"
#include "mbs_export/loaded_dofs.hpp"
#include "mbs_export/modal_body.hpp"
#include "mbs_export/response_error.hpp"
#include "mbs_export/select_by_tolerance.hpp"

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// All modes of the held body in the coordinates of the reduced system.
struct HeldModes {
  const ReducedSystem& reduced;
  const FreeModes& free;
  const HeldDofs& held;
  const VectorXd& omega;
  const MatrixXd& T;  ///< [n_FE x n]
  const MatrixXd& U;  ///< [6 n_nodes x n] of the attachment nodes
};

/// The final modes: kept ones and interface modes, in ascending order of frequency.
struct BodyModes {
  VectorXd omega;
  std::vector<ModeKind> kinds;
  MatrixXd T;  ///< [n_FE x n_modes]
};

/// The choice of the scene: kept modes, and interface modes of the others.
struct Choice {
  ModeSelection selection;
  InterfaceBasis basis;
  std::optional<SelectionTable> table;  ///< when a tolerance has chosen
};

/// The loaded attachment DOFs of one specification of interface modes.
std::vector<int> dofs_loaded_by(const HeldModes& modes, const InterfaceModes& wanted)
{
  std::vector<int> dofs;
  for (const int node : find_set(modes.reduced, wanted.at).nodes)
    for (const int component : wanted.components)
      dofs.push_back(loaded_dof(modes.reduced, modes.held, {node, component}));
  return dofs;
}

/// Omega_0 of one specification, rad/s: half the first elastic free frequency when left open.
double load_frequency(const FreeModes& free, const InterfaceModes& wanted)
{
  if (wanted.kind == InterfaceModes::Kind::irm) return 0.0;
  if (wanted.omega0) return *wanted.omega0;
  return free.n_rigid < free.omega.size() ? 0.5 * free.omega[free.n_rigid] : 0.0;
}

/// A with the columns of B beside it.
MatrixXd beside(const MatrixXd& A, const MatrixXd& B)
{
  MatrixXd both(A.rows(), A.cols() + B.cols());
  both << A, B;
  return both;
}

Choice choose_by_hand(const HeldModes& modes, const BodyOptions& options)
{
  ModeSelection selection = select_modes(modes.omega, options.keep);
  const VectorXd omega_n = modes.omega(selection.neglected);
  MatrixXd responses(omega_n.size(), 0);
  for (const InterfaceModes& one : options.interface_modes) {
    const MatrixXd g = modes.U(dofs_loaded_by(modes, one), selection.neglected).transpose();
    responses = beside(responses, response_modes(omega_n, g, load_frequency(modes.free, one)));
  }
  InterfaceBasis basis = interface_basis(omega_n, responses);
  return {std::move(selection), std::move(basis), {}};
}

/// Of the responses of the reduced system against those of the FE model, where the reduction was
/// certified for this support, these loads and this range.
std::optional<double> error_of_reduction(const Certificate& certificate, const BodyOptions& options,
                                         const LoadedDofs& loads)
{
  const std::optional<ResponseCheck>& check = certificate.responses;
  const double Omega_max = 2.0 * std::numbers::pi * options.keep.tolerance->up_to_Hz;
  constexpr double same = 1.0 + 1e-12;
  if (!check || certificate.fixed != options.fixed || check->loads != loads.names ||
      Omega_max > same * check->up_to)
    return std::nullopt;
  return check->error;
}

/// Response modes of those modes that the loads move, zero in the others: one of these may have the
/// frequency of the loads.
MatrixXd responses_of_moved(const VectorXd& omega, const MatrixXd& B, const InterfaceChoice& choice)
{
  std::vector<int> moved;
  for (int k = 0; k < int(omega.size()); ++k)
    if (!B.row(k).isZero(0.0)) moved.push_back(k);
  const MatrixXd g = B(moved, every) * choice.patterns;
  MatrixXd responses = MatrixXd::Zero(omega.size(), g.cols());
  responses(moved, every) = response_modes(omega(moved), g, choice.Omega_0);
  return responses;
}

/// All modes of a range, and the first one in any case.
Choice modes_of_range(const HeldModes& modes, const Tolerance& tolerance)
{
  const double end = 2.0 * std::numbers::pi * tolerance.up_to_Hz;
  const auto in_range = static_cast<int>((modes.omega.array() <= end).count());
  const int most = static_cast<int>(modes.omega.size());
  ModeSelection selection =
      select_modes(modes.omega, {.count = std::clamp(in_range, std::min(1, most), most)});
  InterfaceBasis none = interface_basis(modes.omega(selection.neglected),
                                        MatrixXd(std::ssize(selection.neglected), 0));
  return {std::move(selection), std::move(none), {}};
}

Choice choose_by_tolerance(const HeldModes& modes, const BodyOptions& options)
{
  if (options.keep.count || options.keep.up_to_Hz || options.keep.list) {
    throw BodyOptionError("keep",
                          "a tolerance chooses the modes itself; give nothing else with it");
  }
  const LoadedDofs loads = loaded_dofs(modes.reduced, modes.held, options.interface_modes);
  if (loads.dofs.empty()) return modes_of_range(modes, *options.keep.tolerance);
  const MatrixXd B = loads.worked_on(modes.U(loads.dofs, every)).transpose();
  const std::optional<double> of_reduction =
      error_of_reduction(modes.reduced.certificate, options, loads);
  Tolerance left = *options.keep.tolerance;
  if (of_reduction && *of_reduction < left.error) left.error -= *of_reduction;
  ToleranceSelection chosen = select_by_tolerance(modes.omega, B, loads, left);
  chosen.table.error = options.keep.tolerance->error;
  chosen.table.of_reduction = of_reduction;
  const VectorXd omega_n = modes.omega(chosen.neglected);
  const MatrixXd B_n = B(chosen.neglected, every);
  MatrixXd responses(omega_n.size(), 0);
  for (const InterfaceChoice& one : chosen.interface)
    responses = beside(responses, responses_of_moved(omega_n, B_n, one));
  return {{std::move(chosen.kept), std::move(chosen.neglected), 0},
          interface_basis(omega_n, responses),
          std::move(chosen.table)};
}

BodyModes merge(const HeldModes& modes, const ModeSelection& selection, const InterfaceBasis& basis)
{
  const Index n_kept = Index(selection.kept.size()), n = n_kept + basis.omega.size();
  VectorXd omega(n);
  omega << modes.omega(selection.kept), basis.omega;
  MatrixXd T(modes.T.rows(), n);
  T << modes.T(every, selection.kept), modes.T(every, selection.neglected) * basis.V;
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int i) { return omega[i]; });
  BodyModes body{.omega = omega(order), .kinds = {}, .T = T(every, order)};
  for (const int i : order) {
    body.kinds.push_back(i >= n_kept         ? ModeKind::interface
                         : omega[i] == 0.0 ? ModeKind::rigid
                                             : ModeKind::constrained);
  }
  return body;
}

std::vector<ResultantModes> resultants_in_modes(std::vector<ResultantModes> resultants,
                                                const MatrixXd& T)
{
  for (ResultantModes& one : resultants) one.S = one.S * T;
  return resultants;
}

ModalBody assemble(const ReducedSystem& reduced, const BodyOptions& options, const BodyModes& modes)
{
  const RigidInertia rigid = rigid_inertia(reduced);
  BodyDamping damping = body_damping(reduced, {modes.omega, modes.T}, options.damping);
  ModalBody body{.title = reduced.title,
                 .kinds = modes.kinds,
                 .omega = modes.omega,
                 .C = std::move(damping.C),
                 .H = std::move(damping.H),
                 .attachment_nodes = reduced.attachment_nodes,
                 .sets = reduced.sets,
                 .fixed = options.fixed,
                 .attachment_modes = attachment_motion(reduced, modes.T),
                 .rings = {},
                 .picture = picture_in(reduced, modes.T),
                 .mass = rigid.mass,
                 .centre_of_mass = rigid.centre_of_mass,
                 .inertia = rigid.inertia,
                 .free_frequencies = {},
                 .n_rigid = 0,
                 .condition_Q_dd = 1.0,
                 .resultants = resultants_in_modes(reduced.resultants, modes.T),
                 .certificate = reduced.certificate,
                 .provenance = reduced.provenance};
  if (reduced.sector_harmonics)
    body.sector_harmonics = in_coordinates(*reduced.sector_harmonics, reduced.M, modes.T);
  if (reduced.mass_integrals)
    body.mass_integrals = in_coordinates(*reduced.mass_integrals, modes.T);
  if (reduced.stiffening && are_same_support(reduced, reduced.stiffening->fixed, options.fixed))
    body.stiffening = in_coordinates(*reduced.stiffening, modes.T);
  body.rings = contact_rings(reduced, body.attachment_modes);
  return body;
}

}  // namespace

ModalBody make_body(const ReducedSystem& reduced, const BodyOptions& options)
{
  const HeldBody of_support = held_body(reduced, options.fixed);
  const FreeModes& free = of_support.free;
  const HeldModes modes{reduced,          free,         of_support.held,
                        of_support.omega, of_support.T, of_support.U};
  const Choice choice =
      options.keep.tolerance ? choose_by_tolerance(modes, options) : choose_by_hand(modes, options);
  ModalBody body = assemble(reduced, options, merge(modes, choice.selection, choice.basis));
  body.free_frequencies = free.omega;
  body.n_rigid = free.n_rigid;
  body.condition_Q_dd = of_support.condition_Q_dd;
  body.n_free_rigid = of_support.n_rigid;
  body.preparation = {.n_constrained_modes = static_cast<int>(of_support.omega.size()),
                      .n_partners = choice.selection.n_partners,
                      .n_interface_dropped = choice.basis.n_dropped,
                      .n_massless = free.n_massless,
                      .rigid_residual = free.rigid_residual,
                      .condition_directions = of_support.condition_directions};
  body.selection = choice.table;
  return body;
}

namespace {

/// Linear between the frequencies of the table.
double ratio_at(double f_Hz, Index mode, const Damping& damping)
{
  const std::vector<double>& at = damping.at_Hz;
  constexpr double same = 1e-9;
  if (f_Hz < at.front() * (1.0 - same) || f_Hz > at.back() * (1.0 + same)) {
    throw BodyOptionError(
        "damping.ratio",
        fmt::format("mode {} has {:.6g} Hz, and the ratios are given from {:.6g} to {:.6g} Hz; add "
                    "a frequency, or keep fewer modes",
                    mode + 1, f_Hz, at.front(), at.back()));
  }
  const auto above = std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(at, f_Hz) - at.begin(), 1,
                                                std::ssize(at) - 1);
  const auto i = static_cast<std::size_t>(above);
  const double s = std::clamp((f_Hz - at[i - 1]) / (at[i] - at[i - 1]), 0.0, 1.0);
  return (1.0 - s) * damping.ratios[i - 1] + s * damping.ratios[i];
}

VectorXd ratios_of(const VectorXd& omega, const Damping& damping)
{
  const Index n = omega.size();
  VectorXd zeta = VectorXd::Zero(n);
  if (!damping.at_Hz.empty()) {
    for (Index i = 0; i < n; ++i)
      if (omega[i] > 0.0) zeta[i] = ratio_at(omega[i] / (2.0 * std::numbers::pi), i, damping);
    return zeta;
  }
  if (damping.ratios.size() == 1) return VectorXd::Constant(n, damping.ratios[0]);
  if (Index(damping.ratios.size()) != n) {
    throw BodyOptionError(
        "damping.ratio",
        fmt::format("{} ratios for {} modes; give one for all, one for each, or a table over the "
                    "frequency",
                    damping.ratios.size(), n));
  }
  return Eigen::Map<const VectorXd>(damping.ratios.data(), n);
}

/// Of dampers and loss factors of the model.
BodyDamping of_model(const ReducedSystem& reduced, const BodyCoordinates& modes)
{
  if (reduced.C.size() == 0 && reduced.H.size() == 0) {
    throw BodyOptionError("damping.type",
                          "'matrix' needs dampers or loss factors, and this system has none");
  }
  const Index n = modes.omega.size();
  BodyDamping damping{.C = MatrixXd::Zero(n, n)};
  if (reduced.C.size() > 0) damping.C = modes.T.transpose() * reduced.C * modes.T;
  if (reduced.H.size() == 0) return damping;
  const MatrixXd H = modes.T.transpose() * reduced.H * modes.T;
  damping.H = 0.5 * (H + H.transpose());
  damping.C += viscous_equivalent(damping.H, modes.omega);
  return damping;
}

}  // namespace

MatrixXd viscous_equivalent(const MatrixXd& H, const VectorXd& omega)
{
  const VectorXd scale =
      omega.unaryExpr([](double w) { return w > 0.0 ? 1.0 / std::sqrt(w) : 0.0; });
  return scale.asDiagonal() * H * scale.asDiagonal();
}

BodyDamping body_damping(const ReducedSystem& reduced, const BodyCoordinates& modes,
                         const Damping& damping)
{
  const auto& omega = modes.omega;
  switch (damping.type) {
    case Damping::Type::none:
      return {};
    case Damping::Type::rayleigh:
      return {.C = VectorXd(damping.alpha + damping.beta * omega.array().square()).asDiagonal()};
    case Damping::Type::matrix:
      return of_model(reduced, modes);
    case Damping::Type::modal:
      break;
  }
  return {.C = VectorXd(2.0 * ratios_of(omega, damping).array() * omega.array()).asDiagonal()};
}

namespace {

/// An orthonormal basis of the columns, each of which counts alike.
MatrixXd orthonormal(MatrixXd shapes)
{
  constexpr double independent = 1e-10;
  Index n = 0;
  for (Index j = 0; j < shapes.cols(); ++j)
    if (const double norm = shapes.col(j).norm(); norm > 0.0)
      shapes.col(n++) = shapes.col(j) / norm;
  if (n == 0) return MatrixXd(shapes.rows(), 0);
  const MatrixXd unit = shapes.leftCols(n);
  Eigen::ColPivHouseholderQR<MatrixXd> qr(unit);
  qr.setThreshold(independent);
  return linear::columns_of_Q(qr, qr.rank());
}

/// Frequencies and kinds of the vectors that take the place of the modes.
struct Condensed {
  VectorXd omega;
  std::vector<ModeKind> kinds;
  MatrixXd V;  ///< [n_modes x k]
};

Condensed ritz_vectors(const ModalBody& body, const MatrixXd& Q)
{
  constexpr double same = 1e-6, at_rest = 1e-13;  // of the squares of frequencies
  const VectorXd lambda = body.omega.cwiseAbs2();
  const MatrixXd K = Q.transpose() * lambda.asDiagonal() * Q;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(K);
  Condensed modes{ritz.eigenvalues(), {}, Q * ritz.eigenvectors()};
  const double largest = modes.omega.cwiseAbs().maxCoeff();
  for (Index j = 0; j < modes.omega.size(); ++j) {
    double& value = modes.omega[j];
    const bool is_rigid = value <= at_rest * largest && body.n_free_rigid > 0;
    if (is_rigid) value = 0.0;
    const double residual = (lambda.cwiseProduct(modes.V.col(j)) - value * modes.V.col(j)).norm();
    modes.kinds.push_back(is_rigid                   ? ModeKind::rigid
                          : residual <= same * value ? ModeKind::constrained
                                                     : ModeKind::interface);
  }
  modes.omega = modes.omega.cwiseMax(0.0).cwiseSqrt();
  return modes;
}

/// A V; of what the body does not have, nothing.
MatrixXd along(const MatrixXd& A, const MatrixXd& V)
{
  if (A.cols() == 0) return {};
  return A * V;
}

MatrixXd projected(const MatrixXd& A, const MatrixXd& V)
{
  if (A.size() == 0) return {};
  return V.transpose() * A * V;
}

}  // namespace

ModalBody condensed(const ModalBody& body, const MatrixXd& shapes)
{
  if (shapes.rows() != body.n_modes()) {
    throw Error(fmt::format("shapes of {} rows cannot condense a body of {} modes", shapes.rows(),
                            body.n_modes()));
  }
  const MatrixXd Q = orthonormal(shapes);
  if (Q.cols() == 0) throw Error("a body cannot be condensed to no shape at all");
  Condensed modes = ritz_vectors(body, Q);
  const MatrixXd& V = modes.V;
  ModalBody result = body;
  result.omega = modes.omega;
  result.kinds = std::move(modes.kinds);
  result.C = projected(body.C, V);
  result.H = projected(body.H, V);
  result.attachment_modes = along(body.attachment_modes, V);
  for (ContactRing& ring : result.rings) {
    ring.W = along(ring.W, V);
    ring.W_r = along(ring.W_r, V);
    ring.W_t = along(ring.W_t, V);
  }
  result.picture.transformation = along(body.picture.transformation, V);
  for (ResultantModes& one : result.resultants) one.S = one.S * V;
  if (body.mass_integrals) result.mass_integrals = in_coordinates(*body.mass_integrals, V);
  if (body.stiffening) result.stiffening = in_coordinates(*body.stiffening, V);
  if (body.sector_harmonics) {
    const MatrixXd I = MatrixXd::Identity(body.n_modes(), body.n_modes());
    result.sector_harmonics = in_coordinates(*body.sector_harmonics, I, V);
  }
  result.selection = {};
  return result;
}

std::string name_of(Damping::Type type)
{
  switch (type) {
    case Damping::Type::modal:
      return "modal";
    case Damping::Type::rayleigh:
      return "rayleigh";
    case Damping::Type::matrix:
      return "matrix";
    case Damping::Type::none:
      break;
  }
  return "none";
}

}  // namespace chladni::mbs_export
