#include "linear/cholesky/sylvester.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "linear/cholesky/elimination_order.hpp"
#include "linear/cholesky/factorization.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "linear/kernels/sparse_matrices.hpp"

namespace chladni::linear {

namespace {

/// Own rows that are not held.
petsc::IndexSet free_rows(Mat K, std::vector<PetscInt> held)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  std::ranges::sort(held);
  std::vector<PetscInt> rows;
  for (PetscInt i = first; i < last; ++i)
    if (!std::ranges::binary_search(held, i)) rows.push_back(i);
  petsc::IndexSet set;
  petsc::check(ISCreateGeneral(petsc::communicator(K), static_cast<PetscInt>(rows.size()),
                               rows.data(), PETSC_COPY_VALUES, set.put()));
  return set;
}

constexpr PetscInt icntl_root_on_one_rank = 13;  // ICNTL

/// Keeps the last front on one rank: of one that ScaLAPACK shares among ranks MUMPS does not count
/// the negative pivots.
void count_every_pivot(Mat factor, const OptionSource& source)
{
  MatSolverType package = nullptr;
  petsc::check(MatFactorGetSolverType(factor, &package));
  if (std::string_view(package) != MATSOLVERMUMPS) {
    throw Error(fmt::format(
        "-{}pc_factor_mat_solver_type {}: eigenvalues are counted by the pivots of mumps; "
        "leave the option out",
        source.prefix, package));
  }
  petsc::check(MatMumpsSetIcntl(factor, icntl_root_on_one_rank, 1));
}

/// @throws chladni::Error when options had the last word.
void check_every_pivot(Mat factor, const OptionSource& source)
{
  PetscInt control = 0;
  petsc::check(MatMumpsGetIcntl(factor, icntl_root_on_one_rank, &control));
  if (control == 1) return;
  throw Error(
      fmt::format("-{}mat_mumps_icntl_13 {}: negative pivots are counted only where the last front "
                  "is on one rank; leave the option out",
                  source.prefix, control));
}

/// Diagonals of K and M in the rows that are counted.
struct Diagonals {
  petsc::Vector k, m;
};

/// @param rows  null: all of them
petsc::Vector diagonal_of(Mat A, IS rows)
{
  petsc::Vector all = diagonal(A);
  if (rows == nullptr) return all;
  petsc::Vector some;
  Vec view = nullptr;
  petsc::check(VecGetSubVector(all, rows, &view));
  petsc::check(VecDuplicate(view, some.put()));
  petsc::check(VecCopy(view, some));
  petsc::check(VecRestoreSubVector(all, rows, &view));
  return some;
}

/// The largest K_jj / M_jj.
double stiffest(const Diagonals& diagonals)
{
  petsc::Vector ratio;
  petsc::check(VecDuplicate(diagonals.k, ratio.put()));
  petsc::check(VecPointwiseDivide(ratio, diagonals.k, diagonals.m));  // 0 where M_jj is
  PetscReal largest = 0.0;
  petsc::check(VecMax(ratio, nullptr, &largest));
  return largest;
}

/// Refuses a sigma so far above all stiffness that none of it is left in K - sigma M: where M is
/// singular the signs of the pivots would be those of round-off.
void check_stiffness_is_seen(const Diagonals& diagonals, double sigma)
{
  constexpr double two_digits = 100.0 * std::numeric_limits<double>::epsilon();
  if (two_digits * sigma <= stiffest(diagonals)) return;
  throw Error(fmt::format(
      "eigenvalues_below: at sigma = {:.3e} rad^2/s^2 no digits of K are left in K - "
      "sigma M; the mass of a coordinate is round-off: ask for a range that ends lower, "
      "or for no count",
      sigma));
}

/// Whether the solver that counts was chosen by an option.
bool is_chosen(const OptionSource& own)
{
  const auto is_given = [&](const std::string& name) {
    PetscBool given = PETSC_FALSE;
    petsc::check(PetscOptionsHasName(own.database, own.prefix.c_str(), name.c_str(), &given));
    return given == PETSC_TRUE;
  };
  constexpr int n_integer = 40, n_real = 15;
  for (const char* name : {"-ksp_type", "-pc_type", "-pc_factor_mat_solver_type"})
    if (is_given(name)) return true;
  for (int i = 1; i <= n_integer; ++i)
    if (is_given(fmt::format("-mat_mumps_icntl_{}", i))) return true;
  for (int i = 1; i <= n_real; ++i)
    if (is_given(fmt::format("-mat_mumps_cntl_{}", i))) return true;
  return false;
}

double n_entries(Mat A)
{
  MatInfo info{};
  petsc::check(MatGetInfo(A, MAT_GLOBAL_SUM, &info));
  return info.nz_used;
}

/// The place in the elimination of a factor of each row of A that is not held; -1 where the factor
/// lacks it.
std::vector<int> known_places(const AssemblyTree& tree, const CountedRows& rows, PetscInt n)
{
  std::vector<PetscInt> held = rows.held;
  std::ranges::sort(held);
  std::vector<int> places(static_cast<std::size_t>(n), -1);
  for (std::size_t i = 0; i < tree.position.size(); ++i) {
    const PetscInt row = rows.factored.empty() ? static_cast<PetscInt>(i) : rows.factored[i];
    const auto behind = std::ranges::lower_bound(held, row);
    if (behind == held.end() || *behind != row)
      places[std::size_t(row - (behind - held.begin()))] = tree.position[i];
  }
  return places;
}

/// By the elimination of a factor of K, as far as it is known.
PivotSigns pivot_signs(Mat A, Vec size, const CountedRows& rows)
{
  const SupernodalFactor* known = rows.factor == nullptr ? nullptr : supernodal_of(rows.factor);
  SupernodalFactor factor(petsc::communicator(A));
  if (known == nullptr) {
    factor.analyze(A);
    return factor.pivot_signs(A, size);
  }
  const bool has_all = rows.held.empty() && rows.factored.empty();
  // A has all entries of K.
  if (has_all && n_entries(A) == known->n_entries()) return known->pivot_signs(A, size);
  PetscInt n = 0;
  petsc::check(MatGetSize(A, &n, nullptr));
  factor.analyze(A, extended_order(A, known_places(known->tree(), rows, n)));
  return factor.pivot_signs(A, size);
}

/// The negative pivots of A = K - sigma M by our own elimination, which chooses none, where their
/// signs are as good. They are those of A + E with |x^T E x| up to growth eps sum_j (K_jj + sigma
/// M_jj) x_j^2, which moves eigenvalues near sigma by growth eps (1 + max K_jj / (sigma M_jj)),
/// relatively.
std::optional<PetscInt> n_negative_without_choice(Mat A, const Diagonals& diagonals,
                                                  const CountShift& shift, const CountedRows& rows)
{
  constexpr double eps = std::numeric_limits<double>::epsilon();
  const double harmless = shift.gap / 30.0, sigma = shift.sigma;
  const double round_off = eps * (1.0 + stiffest(diagonals) / sigma);
  if (!(round_off < harmless)) return std::nullopt;
  petsc::Vector size;
  petsc::check(VecDuplicate(diagonals.k, size.put()));
  petsc::check(VecWAXPY(size, sigma, diagonals.m, diagonals.k));
  const PivotSigns signs = pivot_signs(A, size, rows);
  if (!(signs.growth * round_off < harmless)) return std::nullopt;
  return signs.n_negative;
}

/// The negative pivots of A, by MUMPS, which chooses them.
PetscInt n_negative_by_mumps(Mat A, double sigma, const OptionSource& own)
{
  const petsc::LinearSolver solver = new_solver(petsc::communicator(A), own);
  PC pc = nullptr;
  petsc::check(KSPSetOperators(solver, A, A));
  petsc::check(KSPSetType(solver, KSPPREONLY));
  petsc::check(KSPGetPC(solver, &pc));
  petsc::check(PCSetType(pc, PCCHOLESKY));
  petsc::check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  petsc::check(KSPSetFromOptions(solver));
  Mat factor = set_up_factor(pc, own);
  count_every_pivot(factor, own);
  petsc::check(KSPSetUp(solver));
  check_every_pivot(factor, own);
  MatFactorError error = MAT_FACTOR_NOERROR;
  petsc::check(MatFactorGetError(factor, &error));
  if (error != MAT_FACTOR_NOERROR) {
    PetscInt code = 0;
    petsc::check(MatMumpsGetInfog(factor, 1, &code));
    throw SingularShift(
        fmt::format("eigenvalues_below: K - sigma M has no factor at sigma = {:.15g} (MUMPS: "
                    "INFOG(1) = {}); sigma is an eigenvalue, or the memory does not suffice",
                    sigma, code));
  }
  PetscInt negative = 0;
  petsc::check(MatMumpsGetInfog(factor, 12, &negative));
  return negative;
}

}  // namespace

PetscInt eigenvalues_below(Mat K, Mat M, const CountShift& shift, const CountedRows& rows,
                           const OptionSource& source)
{
  const double sigma = shift.sigma;
  const petsc::IndexSet free = rows.held.empty() ? petsc::IndexSet() : free_rows(K, rows.held);
  const Diagonals diagonals{.k = diagonal_of(K, free), .m = diagonal_of(M, free)};
  check_stiffness_is_seen(diagonals, sigma);
  petsc::Matrix A = shifted(K, M, sigma);
  if (free) {
    A = own_submatrix(A, free, free);
    petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  }
  const OptionSource own = source.part("sylvester_");
  if (!is_chosen(own))
    if (const auto n = n_negative_without_choice(as_aij(A), diagonals, shift, rows)) return *n;
  return n_negative_by_mumps(A, sigma, own);
}

}  // namespace chladni::linear
