#include "reduce/mixed_interface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/told_apart.hpp"
#include "linear/kernels/orthonormalisation.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/kernels/symmetric_eigen.hpp"
#include "linear/lanczos/parted_lanczos.hpp"
#include "reduce/block_rows.hpp"
#include "reduce/flexibility.hpp"
#include "reduce/guyan_stiffness.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// Of the modes: their rows stand in the reduced matrices, so that no run may differ from another
/// by more than round-off.
constexpr double tolerance = 1e-11;

/// The first n modes and those partners of the last one that follow.
PetscInt complete_cluster(const std::vector<double>& lambda, PetscInt n)
{
  constexpr double pair_gap = 2e-4;
  while (n > 0 && n < std::ssize(lambda) && lambda[n] - lambda[n - 1] < pair_gap * lambda[n]) ++n;
  return n;
}

double lambda_max(const ReduceOptions& wanted)
{
  const double f_Hz = wanted.tolerance ? wanted.tolerance->up_to_Hz : wanted.cutoff_Hz.value();
  return std::pow(2.0 * std::numbers::pi * f_Hz, 2);
}

/// How many of the eigenvalues found are wanted.
PetscInt n_wanted(const ReduceOptions& wanted, const std::vector<double>& lambda)
{
  if (wanted.modes) return *wanted.modes;
  return static_cast<PetscInt>(std::ranges::lower_bound(lambda, lambda_max(wanted)) -
                               lambda.begin());
}

/// The lambda up to which no pair may be missing.
double lambda_wanted(const ReduceOptions& wanted, const std::vector<double>& lambda)
{
  if (!wanted.modes) return lambda_max(wanted);
  if (*wanted.modes > std::ssize(lambda)) return linear::all_of_them;
  return *wanted.modes > 0 ? lambda[std::size_t(*wanted.modes - 1)] : 0.0;
}

struct ElasticPairs {
  linear::EigenPairs pairs;
  double lambda_left_out = std::numeric_limits<double>::infinity();
};

linear::PartedLanczos parted(const Flexibility& flexibility, Mat M, const std::string& scratch)
{
  const linear::BlockLanczosOptions options{
      .n_pairs = 0, .tolerance = tolerance, .scratch = scratch};
  std::vector<linear::DecoupledPart> parts = flexibility.parts();
  if (parts.empty()) return {flexibility.solver(), flexibility.n_elastic(), M, options};
  return {std::move(parts), M, options};
}

/// The lowest elastic modes, as many or as far up as wanted, with all partners of the last one:
/// which combinations of some of them came first would be chance.
ElasticPairs elastic_pairs(const WholeSystem& body, const Flexibility& flexibility,
                           const ReduceOptions& wanted)
{
  linear::PartedLanczos lanczos = parted(flexibility, body.M, body.K_ss.options().scratch);
  if (wanted.modes)
    lanczos.converge(*wanted.modes + 2);
  else
    lanczos.converge_beyond(lambda_max(wanted));
  ElasticPairs found;
  linear::EigenPairs& pairs = found.pairs;
  constexpr PetscInt more = 4;
  for (;; lanczos.converge(lanczos.n_pairs() + more)) {
    pairs.lambda.clear();
    for (PetscInt i = 0; i < lanczos.n_pairs(); ++i) pairs.lambda.push_back(lanczos.lambda(i));
    const PetscInt n_found = lanczos.n_pairs(), n_taken = n_wanted(wanted, pairs.lambda);
    lanczos.require_resolved(lambda_wanted(wanted, pairs.lambda));
    if (n_taken > n_found) {  // all there are
      throw Error(fmt::format(
          "mixed_interface_modes: {} of {} elastic modes found; there are no more: ask for fewer",
          n_found, n_taken));
    }
    const bool is_nothing = n_taken == 0 && linear::LocalRows(flexibility.R()).n_cols() == 0;
    if (is_nothing && !pairs.lambda.empty() && wanted.cutoff_Hz && !wanted.may_have_none) {
      const auto [first_Hz, cutoff_Hz] = told_apart(
          std::sqrt(pairs.lambda.front()) / (2.0 * std::numbers::pi), *wanted.cutoff_Hz, 6);
      throw Error(
          fmt::format("mixed_interface_modes: no elastic mode below {} Hz (the first is at {} Hz); "
                      "raise cutoff_Hz or use Guyan",
                      cutoff_Hz, first_Hz));
    }
    const PetscInt n_complete = complete_cluster(pairs.lambda, n_taken);
    // The cluster of the last one may go on.
    if (n_complete == n_found && !lanczos.has_all()) continue;
    if (n_complete < n_found) found.lambda_left_out = pairs.lambda[std::size_t(n_complete)];
    pairs.lambda.resize(n_complete);
    pairs.X = lanczos.vectors(0, n_complete);
    return found;
  }
}

/// T^T A T
MatrixXd gram(Mat T, Mat A)
{
  const petsc::Matrix AT = linear::uninitialized_dense(A, linear::LocalRows(T).n_cols());
  linear::SparseProduct(A).apply(T, AT);
  return linear::inner_product(T, AT);
}

/// Shapes with the forces that hold them, F = K T. Energies are products of the two: K times a
/// bending shape is rounded by the stretching that the shape does not have.
struct LoadedShapes {
  petsc::Matrix T, F;
};

MatrixXd energies(const LoadedShapes& shapes)
{
  const MatrixXd G = linear::inner_product(shapes.T, shapes.F);
  return 0.5 * (G + G.transpose());
}

/// The square roots of the diagonal; 1 where there is none.
std::vector<double> lengths(const MatrixXd& G)
{
  std::vector<double> lengths;
  for (PetscInt i = 0; i < G.rows(); ++i)
    lengths.push_back(G(i, i) > 0.0 ? std::sqrt(G(i, i)) : 1.0);
  return lengths;
}

petsc::Matrix combined(Mat X, const MatrixXd& S)
{
  petsc::Matrix XS = linear::uninitialized_dense(X, S.cols());
  petsc::check(MatZeroEntries(XS));
  linear::add_product(1.0, X, S, XS);
  return XS;
}

/// A basis of the shapes with energies I. The first Gram matrix squares the condition of the
/// shapes, the second one is near I. Directions that are dependent are left out.
LoadedShapes orthonormal(LoadedShapes shapes)
{
  constexpr double dependent = 1e-6;  // of the columns' lengths: what a Gram matrix resolves
  for (int pass = 0; pass < 2; ++pass) {
    const MatrixXd G = energies(shapes);
    const linear::Orthonormalisation o =
        linear::orthonormalisation(G, lengths(G), dependent, petsc::communicator(shapes.T));
    shapes = {.T = combined(shapes.T, o.to_Q), .F = combined(shapes.F, o.to_Q)};
  }
  return shapes;
}

/// Ritz vectors of (K_ss, M_ss) among some shapes, from M x = mu K x, which keeps the lowest
/// accurate.
FixedInterfaceModes ritz_modes(LoadedShapes shapes, const WholeSystem& body)
{
  const petsc::Matrix Q = orthonormal(std::move(shapes)).T;
  const linear::SymmetricEigen ritz =
      linear::symmetric_eigen(gram(Q, body.M_blocks.ss), petsc::communicator(Q));
  const auto n = static_cast<PetscInt>(ritz.values.size());
  FixedInterfaceModes modes;
  MatrixXd V = MatrixXd::Zero(n, n);
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt at = n - 1 - k;
    if (!(ritz.values[at] > 0.0)) break;  // shapes without mass
    for (PetscInt i = 0; i < n; ++i) V(i, k) = ritz.vectors(i, at) / std::sqrt(ritz.values[at]);
    modes.omega.push_back(1.0 / std::sqrt(ritz.values[at]));
  }
  V = V.leftCols(std::ssize(modes.omega)).eval();
  modes.Phi = combined(Q, V);
  return modes;
}

}  // namespace

MixedInterfaceModes mixed_interface_modes(const WholeSystem& body, Mat Psi,
                                          const ReduceOptions& wanted, const std::vector<int>& held)
{
  const Flexibility flexibility(body, Psi, guyan_stiffness(Psi, body.K_blocks), held);
  const auto [elastic, lambda_left_out] = elastic_pairs(body, flexibility, wanted);
  const petsc::Matrix X =
      beside(flexibility.R(), elastic.X, static_cast<PetscInt>(elastic.lambda.size()));
  MixedInterfaceModes modes{.X_s = slave_rows(X, body.dofs, body.K_blocks.ss),
                            .X_m = master_rows(X, body.dofs),
                            .omega = {},
                            .n_rigid = linear::LocalRows(flexibility.R()).n_cols(),
                            .lambda_left_out = lambda_left_out};
  modes.omega.resize(modes.n_rigid, 0.0);
  for (const double lambda : elastic.lambda) modes.omega.push_back(std::sqrt(lambda));
  return modes;
}

FixedInterfaceModes residual_modes(const WholeSystem& body, const MixedInterfaceModes& modes)
{
  const PetscInt n = linear::LocalRows(modes.X_s).n_cols();
  LoadedShapes shapes{.T = linear::uninitialized_dense(body.K_blocks.ss, n),
                      .F = linear::uninitialized_dense(body.K_blocks.ss, n)};
  linear::SparseProduct(body.M_blocks.ss).apply(modes.X_s, shapes.F);
  linear::add_sparse_product(body.M_blocks.sm, modes.X_m, shapes.F);
  petsc::check(MatMatSolve(body.K_ss.factor(), shapes.F, shapes.T));
  return ritz_modes(std::move(shapes), body);
}

MatrixXd macneal_mass(const CraigBamptonBasis& Q, const Blocks& M, const MixedInterfaceModes& modes)
{
  // Z of the masters: X_s^T (M_ss Psi + M_sm) + X_m^T (M_ms Psi + M_mm)
  const MatrixXd at_slaves = inertial_coupling(modes.X_s, Q.Psi, M);
  const MatrixXd M_of_masters =
      linear::replicate(M.mm) + linear::inner_product_sparse(Q.Psi, M.sm).transpose();
  const MatrixXd at_masters = linear::product(modes.X_m.transpose(), M_of_masters);
  // and of the modes: (M_ss X_s + M_sm X_m)^T Phi
  petsc::Matrix momentum = linear::uninitialized_dense(M.ss, modes.n_modes());
  linear::SparseProduct(M.ss).apply(modes.X_s, momentum);
  linear::add_sparse_product(M.sm, modes.X_m, momentum);
  const MatrixXd of_modes = linear::inner_product(momentum, Q.modes->Phi);
  MatrixXd Z(modes.n_modes(), at_masters.cols() + of_modes.cols());
  Z.leftCols(at_masters.cols()) = at_slaves + at_masters;
  Z.rightCols(of_modes.cols()) = of_modes;
  return linear::product(Z.transpose(), Z);
}

}  // namespace chladni::reduce
