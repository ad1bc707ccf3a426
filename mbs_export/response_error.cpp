#include "mbs_export/response_error.hpp"

#include <algorithm>
#include <utility>

#include "common/eigen_every.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/rank_update.hpp"
#include "mbs_export/interface_modes.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

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

}  // namespace chladni::mbs_export
