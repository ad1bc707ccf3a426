// Reduction of badly scaled, nearly singular and degenerate systems. The exact values come from
// dense matrices in long double.
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/petsc.hpp"
#include "hard_case.hpp"
#include "linear/cholesky/sylvester.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "reduce/completeness.hpp"
#include "reduce/craig_bampton.hpp"
#include "reduce/partition.hpp"
#include "tests/linear/chain.hpp"

namespace chladni::hard_cases {
namespace {

using namespace reduce;
using linear::testing::master_set;
using Dense = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// Masses in a row, a spring between each and the next.
struct Chain {
  std::vector<double> mass, spring;  ///< [n], [n - 1]

  PetscInt size() const { return static_cast<PetscInt>(mass.size()); }
};

Chain uniform_chain(int n)
{
  return {std::vector<double>(n, 1.0), std::vector<double>(n - 1, 1.0)};
}

struct Pencil {
  petsc::Matrix K, M;
};

Pencil pencil(const Chain& chain)
{
  Pencil A{.K = linear::testing::empty(chain.size()), .M = linear::testing::empty(chain.size())};
  for (PetscInt i = 0; i < chain.size(); ++i) {
    const double left = i > 0 ? chain.spring[i - 1] : 0.0;
    const double right = i + 1 < chain.size() ? chain.spring[i] : 0.0;
    petsc::check(MatSetValue(A.K, i, i, left + right, INSERT_VALUES));
    if (i > 0) petsc::check(MatSetValue(A.K, i, i - 1, -left, INSERT_VALUES));
    if (i + 1 < chain.size()) petsc::check(MatSetValue(A.K, i, i + 1, -right, INSERT_VALUES));
    petsc::check(MatSetValue(A.M, i, i, chain.mass[i], INSERT_VALUES));
  }
  linear::testing::finish(A.K);
  linear::testing::finish(A.M);
  return A;
}

/// A chain cut into masters and slaves, its factor and its fixed-interface modes.
struct Reduction {
  DofPartition dofs;
  Blocks K, M;
  linear::Factorization K_ss;

  Reduction(const Pencil& A, const std::vector<PetscInt>& masters)
      : dofs(partition(A.K, master_set(A.K, masters))),
        K(split(A.K, dofs)),
        M(split(A.M, dofs)),
        K_ss(linear::factorize(K.ss))
  {}
  FixedInterfaceModes modes(int n) const
  {
    return fixed_interface_modes(K_ss, M.ss, {.modes = n, .cutoff_Hz = {}});
  }
};

/// Frequencies of the chain with masters held, ascending, in long double: the inverse of the
/// stiffness of a held chain of positive springs has no cancellation.
Eigen::VectorXd exact_frequencies(const Chain& chain, PetscInt held)
{
  const auto n = static_cast<Eigen::Index>(chain.size()) - 1;  // without the held end
  Dense flexibility(n, n);
  std::vector<long double> reach(n);  // static displacement of each mass by a force on it
  long double sum = 0.0L;
  for (Eigen::Index i = 0; i < n; ++i) {
    sum += 1.0L / chain.spring[held == 0 ? i : n - 1 - i];
    reach[i] = sum;
  }
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto mass = [&](Eigen::Index k) -> long double {
        return chain.mass[held == 0 ? k + 1 : n - 1 - k];
      };
      flexibility(i, j) = reach[std::min(i, j)] * std::sqrt(mass(i) * mass(j));
    }
  const Eigen::SelfAdjointEigenSolver<Dense> solver(flexibility, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().reverse().cwiseInverse().cwiseSqrt().cast<double>();
}

double frequency_error(const Chain& chain, int n_modes)
{
  const Eigen::VectorXd exact = exact_frequencies(chain, 0);
  const FixedInterfaceModes modes = Reduction(pencil(chain), {0}).modes(n_modes);
  double worst = 0.0;
  for (int i = 0; i < n_modes; ++i)
    worst = std::max(worst, relative_error(modes.omega[i], exact[i]));
  return worst;
}

/// Largest deviation of the constraint modes from the rigid translation that their sum must be.
double translation_error(const Chain& chain, const std::vector<PetscInt>& masters)
{
  const Reduction r(pencil(chain), masters);
  std::vector<PetscInt> all(chain.size());
  std::iota(all.begin(), all.end(), 0);
  const Eigen::MatrixXd Q =
      basis_rows({.Psi = constraint_modes(r.K_ss, r.K), .modes = {}}, r.dofs, all);
  double worst = 0.0;
  for (PetscInt i = 0; i < Q.rows(); ++i) {
    double sum = 0.0;
    for (PetscInt j = 0; j < Q.cols(); ++j) sum += Q(i, j);
    worst = std::max(worst, std::abs(sum - 1.0));
  }
  return worst;
}

Chain contrast_chain(double contrast)
{
  Chain chain = uniform_chain(60);
  for (std::size_t i = 0; i < chain.spring.size(); i += 2) chain.spring[i] = contrast;
  return chain;
}

/// Departure of modes from M-orthonormality.
double orthonormality_error(const FixedInterfaceModes& modes, Mat M_ss)
{
  petsc::Matrix M_Phi;
  petsc::check(MatMatMult(M_ss, modes.Phi, MAT_INITIAL_MATRIX, petsc::automatic, M_Phi.put()));
  const Eigen::MatrixXd I = linear::inner_product(modes.Phi, M_Phi);
  double worst = 0.0;
  for (PetscInt i = 0; i < I.rows(); ++i)
    for (PetscInt j = 0; j < I.cols(); ++j)
      worst = std::max(worst, std::abs(I(i, j) - (i == j ? 1.0 : 0.0)));
  return worst;
}

/// Five equal chains between masters: all frequencies are fivefold.
struct EqualChains {
  Chain chain = uniform_chain(201);
  std::vector<PetscInt> masters{0, 40, 80, 120, 160, 200};
};

/// The error of Ritz values of 1 and 1.0001 over its bound; their vectors lean each towards one of
/// two eigenvalues of 10, below which no other lies.
double error_over_bound_in_a_cluster()
{
  const double theta[] = {1.0, 1.0 / 1.0001, 0.1};
  std::vector<double> lambda;
  Eigen::MatrixXd residuals = Eigen::MatrixXd::Zero(2, 2);
  for (int i = 0; i < 2; ++i) {
    const double c = std::cos(0.02), s = std::sin(0.02);
    const double rho = theta[i] * c * c + theta[2] * s * s;
    const double r2 = std::pow((theta[i] - rho) * c, 2) + std::pow((theta[2] - rho) * s, 2);
    lambda.push_back(1.0 / rho);
    residuals(i, i) = r2 / (rho * rho);
  }
  const auto bounds = error_bounds(lambda, residuals, 9.0);
  double worst = 0.0;
  for (int i = 0; i < 2; ++i) worst = std::max(worst, (lambda[i] * theta[i] - 1.0) / bounds[i]);
  return worst;
}

/// Eigenvalues counted too many or too few on both sides of a fivefold one, 1e-9 of it away.
double miscount_beside_fivefold_eigenvalues()
{
  const EqualChains five;
  const Pencil A = pencil(five.chain);
  double wrong = 0.0;
  for (const int k : {1, 2, 20}) {
    const double lambda = std::pow(2.0 * std::sin(0.5 * k * std::numbers::pi / 40.0), 2);
    for (const int side : {-1, 1}) {
      const PetscInt expected = 5 * (side < 0 ? k - 1 : k);
      const double sigma = lambda * (1.0 + side * 1e-9);
      wrong +=
          std::abs(linear::eigenvalues_below(A.K, A.M, {sigma}, {.held = five.masters}) - expected);
    }
  }
  return wrong;
}

}  // namespace

std::vector<HardCase> reduction_cases()
{
  const std::string area = "reduction", frequencies = "relative error of the frequencies";
  return {
      {area, "springs of contrast 1e8",
       "K_ss has condition 1e11: the rounding of its entries alone is worth 4e-6", frequencies,
       1e-5, [] { return frequency_error(contrast_chain(1e8), 10); }},
      {area, "masses of contrast 1e8", "light masses on heavy ones", frequencies, 1e-10,
       [] {
         Chain chain = uniform_chain(60);
         for (std::size_t i = 1; i < chain.mass.size(); i += 2) chain.mass[i] = 1e-8;
         return frequency_error(chain, 10);
       }},
      {area, "every third node without mass", "M_ss is singular", frequencies, 1e-10,
       [] {
         Chain chain = uniform_chain(60);
         for (std::size_t i = 1; i < chain.mass.size(); i += 3) chain.mass[i] = 0.0;
         return frequency_error(chain, 10);
       }},
      {area, "a body on a spring of 1e-9", "K_ss is singular to all but nine digits",
       "departure of the constraint modes from a translation", 1e-5,
       [] {
         Chain chain = uniform_chain(60);
         chain.spring[0] = 1e-9;
         return translation_error(chain, {0});
       }},
      {area, "a part that no master holds", "K_ss is singular", "words missing in the refusal", 0.0,
       [] {
         Chain chain = uniform_chain(20);
         chain.spring[9] = 0.0;
         return words_missing([&] { Reduction(pencil(chain), {0}); },
                              {"not positive definite", "attachment node"});
       }},
      {area, "1000 masters of 1200 DOFs", "more masters than slaves",
       "departure of the constraint modes from a translation", 1e-13,
       [] {
         std::vector<PetscInt> masters;
         for (PetscInt i = 0; i < 1200; ++i)
           if (i % 6 != 3) masters.push_back(i);
         return translation_error(uniform_chain(1200), masters);
       }},
      {area, "fivefold frequencies", "a Krylov space of one vector sees each only once",
       "relative spread of the five lowest", 1e-10,
       [] {
         const EqualChains five;
         const auto omega = Reduction(pencil(five.chain), five.masters).modes(5).omega;
         return omega[4] / omega[0] - 1.0;
       }},
      {area, "a cut through fivefold frequencies", "seven modes asked for, ten belong together",
       "modes that are missing or too many", 0.0,
       [] {
         const EqualChains five;
         return std::abs(double(Reduction(pencil(five.chain), five.masters).modes(7).omega.size()) -
                         10.0);
       }},
      {area, "the modes of fivefold frequencies", "any basis of the eigenspace is as good",
       "departure from orthonormality", 1e-12,
       [] {
         const EqualChains five;
         const Reduction r(pencil(five.chain), five.masters);
         return orthonormality_error(r.modes(10), r.M.ss);
       }},
      {area, "bound of the errors of two values 1e-4 apart",
       "the gap of Temple to the next eigenvalue is nearly nothing", "true error over its bound",
       1.0, error_over_bound_in_a_cluster},
      {area, "count of eigenvalues 1e-9 beside fivefold ones",
       "five pivots of L D L^T next to zero", "eigenvalues too many or too few", 0.0,
       miscount_beside_fivefold_eigenvalues},
  };
}

}  // namespace chladni::hard_cases
