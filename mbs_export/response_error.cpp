#include "mbs_export/response_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "common/eigen_every.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/rank_update.hpp"
#include "mbs_export/body_options.hpp"

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

namespace {

constexpr double dependent = 1e-8;  // what is left of a vector after orthogonalisation

/// [n x k] vectors of modal amplitudes seen by the basis: V^T D v and v^T D v need only these.
struct Addition {
  MatrixXd v;
  MatrixXd outputs;     ///< B^T v
  MatrixXd V_K_v, V_v;  ///< V^T diag(omega^2) v, V^T v
  MatrixXd v_K_v, v_v;
};

Addition addition(const ReferenceResponse& reference, const TrialBasis& basis, MatrixXd v)
{
  const MatrixXd K_v = reference.omega.cwiseAbs2().asDiagonal() * v;
  return {.v = v,
          .outputs = reference.B.transpose() * v,
          .V_K_v = basis.V.transpose() * K_v,
          .V_v = basis.V.transpose() * v,
          .v_K_v = v.transpose() * K_v,
          .v_v = v.transpose() * v};
}

/// Galerkin with one more vector v: w = v - V (V^T D V)^-1 V^T D v is D-orthogonal to the basis, so
/// that H of the basis grows by B^T w (v^T D w)^-1 w^T B.
/// @param use  takes g, B^T w and (v^T D w)^-1 w^T B
template <typename Use>
void for_growth(const ReferenceResponse& reference, const TrialBasis& basis, const Addition& added,
                const Use& use)
{
  const Index n_g = reference.Omega.size(), n = added.v.cols();
  MatrixXd scaled(basis.V.cols(), 2 * n * n_g);  // (V^T D V)^-1 V^T D v, real | imaginary
  std::vector<MatrixXcd> v_D_w(std::size_t(n_g), MatrixXcd(n, n));
  for (Index g = 0; g < n_g; ++g) {
    const double Omega_squared = reference.Omega[g] * reference.Omega[g];
    const VectorXcd d = damped_stiffness(basis.omega_p, reference.Omega[g]);
    const MatrixXcd V_D_v = stiffness_factor() * added.V_K_v - Omega_squared * added.V_v;
    const MatrixXcd scaled_g = d.cwiseInverse().asDiagonal() * V_D_v;
    scaled.middleCols(2 * n * g, n) = scaled_g.real();
    scaled.middleCols(2 * n * g + n, n) = scaled_g.imag();
    v_D_w[std::size_t(g)] =
        stiffness_factor() * added.v_K_v - Omega_squared * added.v_v - V_D_v.transpose() * scaled_g;
  }
  const MatrixXd of_V = basis.outputs * scaled;
  for (Index g = 0; g < n_g; ++g) {
    MatrixXcd outputs_w(reference.B.cols(), n);
    outputs_w.real() = added.outputs - of_V.middleCols(2 * n * g, n);
    outputs_w.imag() = -of_V.middleCols(2 * n * g + n, n);
    use(g, outputs_w, MatrixXcd(v_D_w[std::size_t(g)].inverse() * outputs_w.transpose()));
  }
}

void extend(const ReferenceResponse& reference, TrialBasis& basis, const Addition& added)
{
  for_growth(reference, basis, added, [&](Index g, const MatrixXcd& U, const MatrixXcd& S) {
    basis.error.col(g) = linear::subtract_from_symmetric(U, S, basis.remainder[std::size_t(g)])
                             .cwiseQuotient(reference.size.col(g));
  });
}

/// The error of the basis with v.
MatrixXd error_with(const ReferenceResponse& reference, const TrialBasis& basis, MatrixXd v)
{
  const Addition added = addition(reference, basis, std::move(v));
  MatrixXd error(basis.error.rows(), basis.error.cols());
  for_growth(reference, basis, added, [&](Index g, const MatrixXcd& U, const MatrixXcd& S) {
    error.col(g) = linear::norms_without(U, S, basis.remainder[std::size_t(g)])
                       .cwiseQuotient(reference.size.col(g));
  });
  return error;
}

MatrixXd unit_vectors(const ReferenceResponse& reference, const ModeCluster& cluster)
{
  MatrixXd v = MatrixXd::Zero(reference.omega.size(), cluster.end - cluster.first);
  for (int k = cluster.first; k < cluster.end; ++k) v(k, k - cluster.first) = 1.0;
  return v;
}

/// The interface modes of a basis, [all modes x p].
InterfaceBasis interface_of(const ReferenceResponse& reference, const TrialBasis& basis)
{
  std::vector<int> neglected;
  for (std::size_t k = 0; k < basis.is_kept.size(); ++k)
    if (!basis.is_kept[k]) neglected.push_back(static_cast<int>(k));
  MatrixXd responses(Index(neglected.size()), 0);
  for (const InterfaceChoice& choice : basis.interface) {
    const MatrixXd x = undamped_response(reference, basis, choice);
    responses.conservativeResize(Eigen::NoChange, responses.cols() + x.cols());
    responses.rightCols(x.cols()) = x(neglected, every);
  }
  InterfaceBasis interface = interface_basis(reference.omega(neglected), responses);
  MatrixXd V = MatrixXd::Zero(reference.omega.size(), interface.omega.size());
  V(neglected, every) = interface.V;
  interface.V = std::move(V);
  return interface;
}

void set_interface(TrialBasis& basis, InterfaceBasis interface)
{
  basis.omega_p = std::move(interface.omega);
  basis.V = std::move(interface.V);
  basis.outputs.resize(basis.outputs.rows(), 0);
}

/// Columns of X made orthonormal to V and to each other, without those that depend on them.
MatrixXd independent(const MatrixXd& V, const MatrixXd& X)
{
  MatrixXd Q(X.rows(), 0);
  for (Index j = 0; j < X.cols(); ++j) {
    VectorXd x = X.col(j).normalized();
    for (int pass = 0; pass < 2; ++pass) {
      x -= V * (V.transpose() * x);
      x -= Q * (Q.transpose() * x);
    }
    if (!(x.norm() > dependent)) continue;
    Q.conservativeResize(Eigen::NoChange, Q.cols() + 1);
    Q.col(Q.cols() - 1) = x.normalized();
  }
  return Q;
}

}  // namespace

int TrialBasis::n_kept() const
{
  return static_cast<int>(std::ranges::count(is_kept, char{1}));
}

TrialBasis rigid_basis(const ReferenceResponse& reference)
{
  const Index n = reference.omega.size();
  TrialBasis basis{.is_kept = std::vector<char>(std::size_t(n), 0),
                   .interface = {},
                   .V = MatrixXd(n, 0),
                   .omega_p = {},
                   .outputs = MatrixXd(reference.B.cols(), 0),
                   .remainder = reference.H,
                   .error = reference.size};
  for (Index g = 0; g < reference.Omega.size(); ++g) {
    basis.error.col(g) = reference.H[std::size_t(g)].colwise().norm().transpose().cwiseQuotient(
        reference.size.col(g));
  }
  if (n > 0 && reference.omega[0] == 0.0)
    return with_cluster(reference, basis, reference.clusters.front());
  return basis;
}

TrialBasis with_outputs(const ReferenceResponse& reference, TrialBasis basis)
{
  if (basis.outputs.cols() != basis.V.cols()) basis.outputs = reference.B.transpose() * basis.V;
  return basis;
}

TrialBasis with_cluster(const ReferenceResponse& reference, TrialBasis basis,
                        const ModeCluster& cluster)
{
  basis = with_outputs(reference, std::move(basis));
  extend(reference, basis, addition(reference, basis, unit_vectors(reference, cluster)));
  for (int k = cluster.first; k < cluster.end; ++k) basis.is_kept[std::size_t(k)] = 1;
  if (!basis.interface.empty()) set_interface(basis, interface_of(reference, basis));
  return basis;
}

TrialBasis with_interface(const ReferenceResponse& reference, TrialBasis basis,
                          const InterfaceChoice& choice)
{
  basis = with_outputs(reference, std::move(basis));
  MatrixXd v = independent(basis.V, undamped_response(reference, basis, choice));
  if (v.cols() == 0) return basis;
  basis.interface.push_back(choice);
  InterfaceBasis interface = interface_of(reference, basis);
  if (interface.omega.size() <= basis.omega_p.size()) {
    basis.interface.pop_back();
    return basis;
  }
  extend(reference, basis, addition(reference, basis, std::move(v)));
  set_interface(basis, std::move(interface));
  return basis;
}

Growth growth_with(const ReferenceResponse& reference, const TrialBasis& basis,
                   const ModeCluster& cluster)
{
  return {.n_modes = cluster.end - cluster.first,
          .error = error_with(reference, basis, unit_vectors(reference, cluster))};
}

Growth growth_with(const ReferenceResponse& reference, const TrialBasis& basis,
                   const InterfaceChoice& choice)
{
  MatrixXd v = independent(basis.V, undamped_response(reference, basis, choice));
  const auto n = static_cast<int>(v.cols());
  return {.n_modes = n, .error = n == 0 ? basis.error : error_with(reference, basis, std::move(v))};
}

MatrixXd undamped_response(const ReferenceResponse& reference, const TrialBasis& basis,
                           const InterfaceChoice& choice)
{
  MatrixXd x = reference.B * choice.patterns;
  for (Index k = 0; k < x.rows(); ++k) {
    const double gap = reference.omega[k] * reference.omega[k] - choice.Omega_0 * choice.Omega_0;
    x.row(k) *= basis.is_kept[std::size_t(k)] ? 0.0 : 1.0 / gap;
  }
  return x;
}

VectorXcd missing_response(const ReferenceResponse& reference, const TrialBasis& basis, Index j,
                           Index g)
{
  const double Omega = reference.Omega[g];
  const VectorXd b = reference.B.col(j);
  VectorXcd x = damped_stiffness(reference.omega, Omega).cwiseInverse().cwiseProduct(b);
  for (Index k = 0; k < x.size(); ++k)
    if (basis.is_kept[std::size_t(k)]) x[k] = 0.0;
  const VectorXd b_p = basis.V.transpose() * b;
  const VectorXcd q_p = damped_stiffness(basis.omega_p, Omega).cwiseInverse().cwiseProduct(b_p);
  return x - basis.V * q_p;
}

namespace {

constexpr double zeta = 0.01;  // of critical, in the comparison only

/// Units in which forces and moments count alike: each of the two divided by the square root of its
/// mean static flexibility.
VectorXd commensurable_units(const VectorXd& omega, const MatrixXd& B,
                             const std::vector<char>& is_moment)
{
  const VectorXd flexibility_k =
      (omega.array() > 0.0).select(omega.array().max(1e-300).square().inverse(), 0.0);
  const VectorXd flexibility = B.cwiseAbs2().transpose() * flexibility_k;
  double sum[2] = {0.0, 0.0};
  Index n[2] = {0, 0};
  for (Index j = 0; j < B.cols(); ++j) {
    const int unit = is_moment[std::size_t(j)] ? 1 : 0;
    sum[unit] += flexibility[j];
    ++n[unit];
  }
  VectorXd units = VectorXd::Ones(B.cols());
  for (Index j = 0; j < B.cols(); ++j) {
    const int unit = is_moment[std::size_t(j)] ? 1 : 0;
    if (sum[unit] > 0.0) units[j] = std::sqrt(static_cast<double>(n[unit]) / sum[unit]);
  }
  return units;
}

/// [m x n] squares of what each mode contributes to the response to each load.
MatrixXd contributions(const VectorXd& omega, const MatrixXd& B, double Omega)
{
  const VectorXd weight =
      B.rowwise().squaredNorm().array() / damped_stiffness(omega, Omega).array().abs2().max(1e-300);
  return B.cwiseAbs2().transpose() * weight.asDiagonal();
}

MatrixXcd flexibility(const VectorXd& omega, const MatrixXd& B, double Omega)
{
  const VectorXcd of_modes = damped_stiffness(omega, Omega).cwiseInverse();
  MatrixXcd H(B.cols(), B.cols());
  H.real() = B.transpose() * (of_modes.real().asDiagonal() * B);
  H.imag() = B.transpose() * (of_modes.imag().asDiagonal() * B);
  return H;
}

constexpr double no_size = 1e-300;  // of a load that moves nothing

VectorXd response_size(const MatrixXcd& H, const VectorXd& omega, const MatrixXd& B, double Omega)
{
  const VectorXd incoherent = contributions(omega, B, Omega).rowwise().sum().cwiseSqrt();
  return H.colwise().norm().transpose().cwiseMax(incoherent).cwiseMax(no_size);
}

/// Clusters that respond at their own frequency with more than `error` of what all modes do.
std::vector<int> resonances(const ReferenceResponse& reference, const Tolerance& tolerance)
{
  std::vector<int> excited;
  for (std::size_t c = 0; c < reference.clusters.size(); ++c) {
    const auto [first, end] = reference.clusters[c];
    const double Omega = reference.omega[first];
    if (Omega == 0.0 || Omega > 2.0 * std::numbers::pi * tolerance.up_to_Hz) continue;
    const MatrixXd squares = contributions(reference.omega, reference.B, Omega);
    const VectorXd own = squares.middleCols(first, end - first).rowwise().sum();
    const VectorXd all = squares.rowwise().sum();
    if ((own.array() > tolerance.error * tolerance.error * all.array()).any())
      excited.push_back(static_cast<int>(c));
  }
  return excited;
}

/// Ascending, without neighbours closer than a tenth of a resonance's width.
VectorXd thinned(std::vector<double> Omega)
{
  std::ranges::sort(Omega);
  std::vector<double> grid;
  for (const double x : Omega)
    if (grid.empty() || x - grid.back() > 0.1 * zeta * x) grid.push_back(x);
  return Eigen::Map<const VectorXd>(grid.data(), Index(grid.size()));
}

VectorXd frequency_grid(const ReferenceResponse& reference, double Omega_max)
{
  // A free body answers static loads with infinite motion; its range begins above zero.
  double lowest = reference.omega[0] == 0.0 ? 1e-2 * Omega_max : 0.0;
  if (!reference.resonances.empty()) {
    lowest = std::min(
        lowest,
        0.1 * reference.omega[reference.clusters[std::size_t(reference.resonances[0])].first]);
  }
  std::vector<double> knots{lowest}, grid{lowest, Omega_max};
  for (const int c : reference.resonances)
    knots.push_back(reference.omega[reference.clusters[std::size_t(c)].first]);
  for (std::size_t i = 1; i < knots.size(); ++i)
    for (const double x : {1.0 - zeta, 1.0, 1.0 + zeta})
      if (x * knots[i] <= Omega_max) grid.push_back(x * knots[i]);
  knots.push_back(Omega_max);
  for (std::size_t i = 1; i < knots.size(); ++i)
    for (const double part : {0.25, 0.5, 0.75})
      if (knots[i] > knots[i - 1]) grid.push_back(knots[i - 1] + part * (knots[i] - knots[i - 1]));
  std::erase_if(grid, [&](double x) { return x < lowest; });
  return thinned(std::move(grid));
}

}  // namespace

std::complex<double> stiffness_factor()
{
  return {1.0, 2.0 * zeta};
}

VectorXcd damped_stiffness(const VectorXd& omega, double Omega)
{
  return stiffness_factor() * omega.cwiseAbs2().cast<std::complex<double>>().array() -
         Omega * Omega;
}

std::vector<int> moved_modes(const VectorXd& omega, const MatrixXd& B)
{
  std::vector<int> moved;
  for (int k = 0; k < int(omega.size()); ++k)
    if (omega[k] == 0.0 || !B.row(k).isZero(0.0)) moved.push_back(k);
  if (moved.empty()) moved.push_back(0);
  return moved;
}

ReferenceResponse reference_modes(const VectorXd& omega, const MatrixXd& B, const LoadedDofs& loads)
{
  const VectorXd unit = commensurable_units(omega, B, loads.is_moment);
  return {.omega = omega,
          .B = B * unit.asDiagonal(),
          .unit = unit,
          .clusters = {},
          .resonances = {},
          .Omega = {},
          .H = {},
          .size = {}};
}

ReferenceResponse reference_response(const VectorXd& omega, const MatrixXd& B,
                                     const LoadedDofs& loads, const Tolerance& tolerance)
{
  ReferenceResponse reference = reference_modes(omega, B, loads);
  reference.clusters = mode_clusters(omega);
  reference.resonances = resonances(reference, tolerance);
  reference.Omega = frequency_grid(reference, 2.0 * std::numbers::pi * tolerance.up_to_Hz);
  reference.size.resize(B.cols(), reference.Omega.size());
  for (Index g = 0; g < reference.Omega.size(); ++g) {
    MatrixXcd H = flexibility(omega, reference.B, reference.Omega[g]);
    reference.size.col(g) = response_size(H, omega, reference.B, reference.Omega[g]);
    reference.H.push_back(std::move(H));
  }
  return reference;
}

SizesInBand sizes_in_band(const ReferenceResponse& reference, double from, double to)
{
  const VectorXd& omega = reference.omega;
  const MatrixXd& B = reference.B;
  const double s_from = from * from, s_to = to * to, s_middle = 0.5 * (s_from + s_to);
  const Eigen::ArrayXd lambda = omega.array().square(), norms = B.rowwise().norm();
  // |d|^2 of the modes, which is convex in s = Omega^2.
  const auto squares = [&](const auto& s) -> Eigen::ArrayXd {
    return (lambda - s).square() + (stiffness_factor().imag() * lambda).square();
  };
  const Eigen::ArrayXd largest = squares(s_from).max(squares(s_to));
  const VectorXd least_shares = (largest > 0.0).select(norms.square() / largest.max(no_size), 0.0);
  VectorXd at_least = (B.cwiseAbs2().transpose() * least_shares).cwiseSqrt().cwiseMax(no_size);
  const MatrixXcd H = flexibility(omega, B, std::sqrt(s_middle));
  const Eigen::ArrayXd smallest = squares(lambda.max(s_from).min(s_to));
  if (smallest.minCoeff() > 0.0) {  // |dH/ds| <= |B|^T |d|^-2 |B|
    const VectorXd slope = B.cwiseAbs().transpose() * (norms / smallest).matrix();
    at_least = at_least.cwiseMax(H.colwise().norm().transpose() - (s_to - s_middle) * slope);
  }
  return {.at_least = std::move(at_least),
          .in_middle = response_size(H, omega, B, std::sqrt(s_middle))};
}

namespace {

constexpr double closest_gap = 1e-8;  // relative to omega^2; below it a response is round-off

/// The middle between neglected mode i and the next one below that differs, or above the rigid
/// ones.
double other_frequency(const VectorXd& omega_n, Index i)
{
  for (Index below = i - 1; below >= 0; --below)
    if (omega_n[below] < (1.0 - 1e-4) * omega_n[i]) return 0.5 * (omega_n[below] + omega_n[i]);
  if (omega_n[i] > 0.0) return 0.5 * omega_n[i];
  const auto elastic = (omega_n.array() > 0.0);
  return elastic.any() ? 0.5 * elastic.select(omega_n.array(), omega_n.maxCoeff()).minCoeff() : 1.0;
}

}  // namespace

MatrixXd response_modes(const VectorXd& omega_n, const MatrixXd& g, double Omega_0)
{
  const VectorXd gap = omega_n.array().square() - Omega_0 * Omega_0;
  for (Index i = 0; i < gap.size(); ++i)
    if (std::abs(gap[i]) <= closest_gap * omega_n[i] * omega_n[i]) {
      throw BodyOptionError(
          "interface_modes",
          fmt::format("omega0 = {:.9g} rad/s is the frequency of a neglected mode; take "
                      "omega0 = {:.6g}",
                      Omega_0, other_frequency(omega_n, i)));
    }
  return gap.cwiseInverse().asDiagonal() * g;
}

InterfaceBasis interface_basis(const VectorXd& omega_n, const MatrixXd& responses)
{
  MatrixXd P = responses;
  for (Index j = 0; j < P.cols(); ++j)
    if (const double norm = P.col(j).norm(); norm > 0.0) P.col(j) /= norm;
  if (P.size() == 0) return {MatrixXd(omega_n.size(), 0), VectorXd(0), static_cast<int>(P.cols())};
  Eigen::ColPivHouseholderQR<MatrixXd> qr(P);
  qr.setThreshold(1e-8);
  const MatrixXd V = linear::columns_of_Q(qr, qr.rank());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(
      MatrixXd(V.transpose() * omega_n.cwiseAbs2().asDiagonal() * V));
  return {V * solver.eigenvectors(), solver.eigenvalues().cwiseMax(0.0).cwiseSqrt(),
          static_cast<int>(P.cols() - qr.rank())};
}

}  // namespace chladni::mbs_export
