#include "reduce/mixed_interface.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "common/petsc.hpp"
#include "common/told_apart.hpp"
#include "linear/cholesky/part_solver.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/kernels/orthonormalisation.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/lanczos/parted_lanczos.hpp"
#include "reduce/partition.hpp"
#include "reduce/static_condensation.hpp"
#include "reduce/support.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// The flexibility of a body with some masters held, A = P K^+ P^T with P = I - R R^T M, where R
/// are the rigid motions that the supports leave. A f is the displacement, free of rigid motion and
/// zero at the held masters, under the forces f without the part that accelerates the body as a
/// rigid one. The only large factor is that of K_ss; beside it the small dense K_G is inverted
/// without the motions R and the held rows. A factor of K between the free DOFs would spare the
/// products with Psi; it was slower, since masters on a ring cut the mesh and with it K_ss into
/// pieces.
class Flexibility {
 public:
  /// @param body, Psi  must outlive this object
  /// @param held       rows of K_G, ascending
  /// @note   Collective, as are all members.
  /// @throws chladni::Error when a rigid motion has no mass.
  Flexibility(const WholeSystem& body, Mat Psi, const GuyanStiffness& K_G,
              const std::vector<int>& held);
  Flexibility(const Flexibility&) = delete;
  Flexibility& operator=(const Flexibility&) = delete;

  /// U = A F in all DOFs; A R = 0. This object must outlive the function, as it must those of the
  /// parts.
  linear::BlockSolve solver() const;
  /// The same for the rows of each part into which K and M fall, such as bending and motion in the
  /// plane; empty if all rows are one part, or if the factor of K_ss does not solve for parts.
  std::vector<linear::DecoupledPart> parts() const;
  /// [n x r] rigid motions in all DOFs, R^T M R = I.
  Mat R() const { return R_; }
  /// Number of elastic modes, and of those of motions without mass.
  PetscInt n_elastic() const { return n_elastic_; }

 private:
  const WholeSystem& body_;
  Mat Psi_;
  std::vector<int> held_;
  petsc::Matrix R_, MR_;
  Eigen::MatrixXd K_G_inverse_;
  PetscInt n_elastic_ = 0;
};

/// The inverse of a K_G on the complement of its r motions without energy, in units that its
/// diagonal gives; all else is as wrong as any, since the forces have no share of it.
MatrixXd pseudo_inverse(const MatrixXd& K_G, Eigen::Index r)
{
  const Eigen::Index n = K_G.rows();
  double largest = 0.0;
  for (PetscInt i = 0; i < n; ++i) largest = std::max(largest, K_G(i, i));
  std::vector<double> scale;
  for (PetscInt i = 0; i < n; ++i) {
    const double k = K_G(i, i) > 0.0 ? K_G(i, i) : largest;
    scale.push_back(k > 0.0 ? 1.0 / std::sqrt(k) : 1.0);
  }
  MatrixXd scaled = K_G;
  for (PetscInt j = 0; j < n; ++j)
    for (PetscInt i = 0; i < n; ++i) scaled(i, j) *= scale[i] * scale[j];
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(std::move(scaled));
  if (r < n && !(eigen.values[std::size_t(r)] > 0.0)) {
    throw Error(
        fmt::format("K has no digits between the masters: the energy of a motion that it resists "
                    "is round-off, {:.1e} of that of its rows; name other masters, or more digits",
                    eigen.values[std::size_t(r)]));
  }
  MatrixXd V = MatrixXd::Zero(n, n - r);  // of the others, times lambda^(-1/2)
  for (Eigen::Index k = r; k < n; ++k)
    for (PetscInt i = 0; i < n; ++i)
      V(i, k - r) = scale[i] * eigen.vectors(i, k) / std::sqrt(eigen.values[k]);
  return linear::product(V, V.transpose());
}

/// That of the rows that are not held, and zero in the others.
MatrixXd inverse(const MatrixXd& K_G, Eigen::Index r, const std::vector<int>& held)
{
  const std::vector<int> free = all_but(held, K_G.rows());
  MatrixXd inverse = MatrixXd::Zero(K_G.rows(), K_G.cols());
  if (!free.empty()) inverse(free, free) = pseudo_inverse(K_G(free, free), r);
  return inverse;
}

double form(const MatrixXd& G, const MatrixXd& S, PetscInt i, PetscInt j)
{
  double sum = 0.0;
  for (PetscInt b = 0; b < G.cols(); ++b)
    for (PetscInt a = 0; a < G.rows(); ++a) sum += S(a, i) * G(a, b) * S(b, j);
  return sum;
}

/// The combinations S of motions with the mass matrix G that make S^T G S = I.
MatrixXd orthonormal_in(const MatrixXd& G)
{
  constexpr double no_mass = 1e-14;  // of that of the motion before the others are taken out
  MatrixXd S = MatrixXd::Zero(G.rows(), G.cols());
  for (PetscInt j = 0; j < G.cols(); ++j) {
    S(j, j) = 1.0;
    for (int pass = 0; pass < 2; ++pass) {
      for (PetscInt k = 0; k < j; ++k) {
        const double share = form(G, S, k, j);
        for (PetscInt i = 0; i < G.rows(); ++i) S(i, j) -= share * S(i, k);
      }
    }
    const double mass = form(G, S, j, j);
    if (!(mass > no_mass * G(j, j))) {
      throw Error(
          "free-interface modes: a rigid-body motion has no mass; has every part of the body a "
          "density?");
    }
    for (PetscInt i = 0; i < G.rows(); ++i) S(i, j) /= std::sqrt(mass);
  }
  return S;
}

/// Rigid motions of all DOFs, R^T M R = I.
petsc::Matrix rigid_motions(const WholeSystem& body, Mat Psi, const MatrixXd& R_m)
{
  const petsc::Matrix R_s = linear::uninitialized_dense(Psi, R_m.cols());
  petsc::check(MatZeroEntries(R_s));
  linear::add_product(1.0, Psi, R_m, R_s);
  const petsc::Matrix R = linear::uninitialized_dense(body.K, R_m.cols());
  set_rows(R, body.dofs, R_m, R_s);
  petsc::Matrix normal = linear::uninitialized_dense(body.K, R_m.cols());
  petsc::check(MatZeroEntries(normal));
  linear::add_product(
      1.0, R, orthonormal_in(linear::inner_product(R, linear::sparse_product(body.M, R))), normal);
  return normal;
}

/// The number of elastic modes of a part: its rows without those that are held and its rigid
/// motions, of which R R^T M is the projector.
PetscInt n_elastic_in(const petsc::Matrix& R, const petsc::Matrix& MR,
                      const std::vector<PetscInt>& masters, const std::vector<int>& held)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(R, &n, nullptr));
  const auto n_held = std::ranges::count_if(
      masters, [&](PetscInt master) { return std::ranges::binary_search(held, master); });
  const std::vector<double> shares = linear::column_products(R, MR);
  const double n_rigid = std::accumulate(shares.begin(), shares.end(), 0.0);
  return n - static_cast<PetscInt>(n_held + std::lround(n_rigid));
}

/// All rows, or those of a part, and what A needs of them; refers to its matrices.
struct Rows {
  const linear::BlockSolve& solve;  ///< with K_ss
  const DofPartition& dofs;
  Mat K_sm, Psi, R, MR;
  const MatrixXd& K_G_inverse;
};

/// U = A F.
void apply(const Rows& rows, Mat F, Mat U)
{
  petsc::Matrix f;
  petsc::check(MatDuplicate(F, MAT_COPY_VALUES, f.put()));
  linear::add_product(-1.0, rows.MR, linear::inner_product(rows.R, f), f);
  const petsc::Matrix f_s = slave_rows(f, rows.dofs, rows.K_sm);
  const petsc::Matrix u_s = linear::uninitialized_dense(rows.K_sm, linear::LocalRows(f_s).n_cols());
  rows.solve(f_s, u_s);
  const MatrixXd held = linear::inner_product_sparse(u_s, rows.K_sm);
  const MatrixXd u_m =
      linear::product(rows.K_G_inverse, master_rows(f, rows.dofs) - held.transpose());
  linear::add_product(1.0, rows.Psi, u_m, u_s);
  set_rows(U, rows.dofs, u_m, u_s);
  linear::add_product(-1.0, rows.R, linear::inner_product(rows.MR, U), U);
}

/// Copies of the rows of a part.
struct PartRows {
  linear::BlockSolve solve;
  DofPartition dofs;  ///< counted within the part
  petsc::Matrix K_sm, Psi, R, MR;
  MatrixXd K_G_inverse;
};

petsc::IndexSet index_set(const std::vector<PetscInt>& own, MPI_Comm comm)
{
  petsc::IndexSet set;
  petsc::check(ISCreateGeneral(comm, static_cast<PetscInt>(own.size()), own.data(),
                               PETSC_COPY_VALUES, set.put()));
  return set;
}

/// Rows of a part that are masters, or slaves.
struct Members {
  std::vector<PetscInt> places;   ///< among all masters or slaves of this rank
  std::vector<PetscInt> in_part;  ///< global rows within the part
};

/// @param rows   of the part, own ones
/// @param among  all masters, or slaves
Members members(const std::vector<PetscInt>& rows, PetscInt first_row, IS among)
{
  const std::vector<PetscInt> all = petsc::own_indices(among);
  Members some;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto found = std::ranges::lower_bound(rows, all[i]);
    if (found == rows.end() || *found != all[i]) continue;
    some.places.push_back(static_cast<PetscInt>(i));
    some.in_part.push_back(first_row + static_cast<PetscInt>(found - rows.begin()));
  }
  return some;
}

std::vector<PetscInt> numbers_shifted(std::vector<PetscInt> numbers, PetscInt by)
{
  for (PetscInt& number : numbers) number += by;
  return numbers;
}

petsc::Matrix rows_of(Mat X, IS part, Mat like)
{
  const linear::LocalRows x(X);
  std::vector<int> columns(static_cast<std::size_t>(x.n_cols()));
  std::iota(columns.begin(), columns.end(), 0);
  return block_of(x, petsc::own_rows(part, X), columns, like);
}

Flexibility::Flexibility(const WholeSystem& body, Mat Psi, const GuyanStiffness& K_G,
                         const std::vector<int>& held)
    : body_(body), Psi_(Psi), held_(held)
{
  const MatrixXd R_m = at_rest(K_G.R, held);
  R_ = rigid_motions(body, Psi, R_m);
  MR_ = linear::sparse_product(body.M, R_);
  K_G_inverse_ = inverse(K_G.K, R_m.cols(), held);
  PetscInt n = 0;
  petsc::check(MatGetSize(body.K, &n, nullptr));
  n_elastic_ = n - static_cast<PetscInt>(std::ssize(held) + R_m.cols());
}

linear::BlockSolve Flexibility::solver() const
{
  const linear::BlockSolve solve = [factor = body_.K_ss.factor()](Mat B, Mat X) {
    petsc::check(MatMatSolve(factor, B, X));
  };
  return [this, solve](Mat F, Mat U) {
    apply({.solve = solve,
           .dofs = body_.dofs,
           .K_sm = body_.K_blocks.sm,
           .Psi = Psi_,
           .R = R_,
           .MR = MR_,
           .K_G_inverse = K_G_inverse_},
          F, U);
  };
}

std::vector<linear::DecoupledPart> Flexibility::parts() const
{
  if (!linear::solves_for_parts(body_.K_ss.factor())) return {};
  const MPI_Comm comm = petsc::communicator(body_.K);
  std::vector<linear::DecoupledPart> parts;
  for (petsc::IndexSet& rows : linear::decoupled_rows(body_.K, body_.M)) {
    const std::vector<PetscInt> own = petsc::own_indices(rows);
    const PetscInt first_row = petsc::indices_before(rows);
    const Members masters = members(own, first_row, body_.dofs.masters),
                  slaves = members(own, first_row, body_.dofs.slaves);
    const std::vector<PetscInt> numbers = linear::gather_on_all(
        numbers_shifted(masters.places, petsc::indices_before(body_.dofs.masters)), MPIU_INT, comm);
    const petsc::IndexSet slave_numbers =
        index_set(numbers_shifted(slaves.places, petsc::indices_before(body_.dofs.slaves)), comm);
    const petsc::IndexSet master_numbers =
        index_set(numbers_shifted(masters.places, petsc::indices_before(body_.dofs.masters)), comm);
    auto part = std::make_shared<PartRows>();
    part->solve = linear::part_solver(body_.K_ss.factor(), slave_numbers);
    part->dofs = {.masters = index_set(masters.in_part, comm),
                  .slaves = index_set(slaves.in_part, comm)};
    petsc::check(MatCreateSubMatrix(body_.K_blocks.sm, slave_numbers, master_numbers,
                                    MAT_INITIAL_MATRIX, part->K_sm.put()));
    part->Psi = block_of(linear::LocalRows(Psi_), slaves.places, numbers, part->K_sm);
    petsc::Matrix M;
    petsc::check(MatCreateSubMatrix(body_.M, rows, rows, MAT_INITIAL_MATRIX, M.put()));
    part->R = rows_of(R_, rows, M);
    part->MR = rows_of(MR_, rows, M);
    part->K_G_inverse = K_G_inverse_(numbers, numbers);
    const PetscInt most = n_elastic_in(part->R, part->MR, numbers, held_);
    const linear::BlockSolve solve = [part](Mat F, Mat U) {
      apply({.solve = part->solve,
             .dofs = part->dofs,
             .K_sm = part->K_sm,
             .Psi = part->Psi,
             .R = part->R,
             .MR = part->MR,
             .K_G_inverse = part->K_G_inverse},
            F, U);
    };
    parts.push_back({.rows = std::move(rows), .solve = solve, .most = most});
  }
  return parts;
}

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
  if (wanted.modes && *wanted.modes > flexibility.n_elastic()) {
    throw Error(fmt::format(
        "mixed_interface_modes: {} modes asked of a body that has {} at most: ask for fewer",
        *wanted.modes, flexibility.n_elastic()));
  }
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

petsc::Matrix combined(Mat X, const MatrixXd& S)
{
  petsc::Matrix XS = linear::uninitialized_dense(X, S.cols());
  petsc::check(MatZeroEntries(XS));
  linear::add_product(1.0, X, S, XS);
  return XS;
}

/// A basis of the shapes with energies I. The first Gram matrix squares the condition of the
/// shapes, the second one is near I. Directions that are dependent are left out.
/// @param sizes  what round-off in each shape is relative to, the root of an energy
LoadedShapes orthonormal(LoadedShapes shapes, std::vector<double> sizes)
{
  constexpr double dependent = 1e-6;  // of the sizes: what a Gram matrix resolves
  for (int pass = 0; pass < 2; ++pass) {
    const MatrixXd G = energies(shapes);
    const linear::Orthonormalisation o =
        linear::orthonormalisation(G, sizes, dependent, petsc::communicator(shapes.T));
    shapes = {.T = combined(shapes.T, o.to_Q), .F = combined(shapes.F, o.to_Q)};
    sizes.assign(std::size_t(o.to_Q.cols()), 1.0);
  }
  return shapes;
}

/// Ritz vectors of (K_ss, M_ss) among some shapes, from M x = mu K x, which keeps the lowest
/// accurate.
FixedInterfaceModes ritz_modes(LoadedShapes shapes, const std::vector<double>& sizes,
                               const WholeSystem& body)
{
  const petsc::Matrix Q = orthonormal(std::move(shapes), sizes).T;
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

/// Of the shapes K_ss^-1 (M_ss X_s + M_sm X_m) of modes X: their own lengths where a mode is a
/// rigid motion, else 1 / omega, the length of a mode that does not move the masters. A mode that
/// the constraint modes hold, as one of a master that nothing couples, leaves a shape of round-off;
/// a share of 1e-6 left out changes its eigenvalue by 1e-12.
std::vector<double> sizes_of_shapes(const LoadedShapes& shapes, const std::vector<double>& omega)
{
  const MatrixXd G = energies(shapes);
  std::vector<double> sizes;
  for (PetscInt k = 0; k < G.cols(); ++k) {
    const double own = G(k, k) > 0.0 ? std::sqrt(G(k, k)) : 1.0;
    sizes.push_back(omega[std::size_t(k)] > 0.0 ? 1.0 / omega[std::size_t(k)] : own);
  }
  return sizes;
}

}  // namespace

MixedInterfaceModes mixed_interface_modes(const WholeSystem& body, Mat Psi,
                                          const ReduceOptions& wanted, const std::vector<int>& held)
{
  const Flexibility flexibility(body, Psi, guyan_stiffness(Psi, body.K_blocks, body.M_blocks),
                                held);
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
  const std::vector<double> sizes = sizes_of_shapes(shapes, modes.omega);
  return ritz_modes(std::move(shapes), sizes, body);
}

}  // namespace chladni::reduce
