#include "plugin/eps_residuals.hpp"

#include <slepc/private/epsimpl.h>

#include <algorithm>
#include <cmath>

#include "common/petsc.hpp"

namespace chladni::plugin {

namespace {

/// The problem of an EPS with work vectors.
class Pencil {
 public:
  explicit Pencil(EPS eps)
  {
    petsc::check(EPSGetOperators(eps, &A_, &B_));
    for (petsc::Vector* v : {&a_, &b_, &w_, &r_, &Bx_})
      petsc::check(MatCreateVecs(A_, v->put(), nullptr));
    take_diagonal(A_, a_);
    take_diagonal(B_, b_);
  }

  struct Lengths {
    double residual;  ///< of A x - lambda B x
    double mass;      ///< of B x
    double terms;     ///< of what cancels in A x
  };
  /// With each row divided by the root of |A_ii| + |lambda B_ii|.
  Lengths lengths(Vec x, double lambda)
  {
    petsc::check(VecWAXPY(w_, std::abs(lambda), b_, a_));
    PetscReal largest = 0.0;
    petsc::check(VecMax(w_, nullptr, &largest));
    petsc::check(VecShift(w_, 1e-16 * largest));
    petsc::check(VecSqrtAbs(w_));
    petsc::check(MatMult(A_, x, r_));
    if (B_)
      petsc::check(MatMult(B_, x, Bx_));
    else
      petsc::check(VecCopy(x, Bx_));
    petsc::check(VecAXPY(r_, -lambda, Bx_));
    Lengths lengths{};
    lengths.residual = scaled_length(r_);
    lengths.mass = scaled_length(Bx_);
    petsc::check(VecPointwiseMult(r_, w_, x));
    petsc::check(VecNorm(r_, NORM_2, &lengths.terms));
    return lengths;
  }

 private:
  /// The absolute diagonal; 1 where A is the identity or a shell matrix that does not give it.
  static void take_diagonal(Mat A, Vec d)
  {
    PetscBool is_given = PETSC_FALSE;
    petsc::check(VecSet(d, 1.0));
    if (A) petsc::check(MatHasOperation(A, MATOP_GET_DIAGONAL, &is_given));
    if (is_given) petsc::check(MatGetDiagonal(A, d));
    petsc::check(VecAbs(d));
  }

  double scaled_length(Vec v)
  {
    PetscReal length = 0.0;
    petsc::check(VecPointwiseDivide(v, v, w_));
    petsc::check(VecNorm(v, NORM_2, &length));
    return length;
  }

  Mat A_ = nullptr, B_ = nullptr;
  petsc::Vector a_, b_, w_, r_, Bx_;
};

/// lambda of theta, and its distance to what the transformation inverts about.
struct Eigenvalue {
  double lambda, distance;
};

Eigenvalue eigenvalue(EPS eps, double theta)
{
  PetscScalar lambda = theta, zero = 0.0;
  petsc::check(STBackTransform(eps->st, 1, &lambda, &zero));
  PetscBool sinvert = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare((PetscObject)eps->st, STSINVERT, &sinvert));
  return {.lambda = lambda, .distance = sinvert ? std::abs(1.0 / theta) : std::abs(theta)};
}

}  // namespace

PetscInt n_true_pairs(EPS eps, Mat X)
{
  constexpr double round_off = 1e-12;
  const double tolerance = std::max(1e-4, 100.0 * eps->tol);
  Pencil pencil(eps);
  for (PetscInt i = 0; i < eps->nconv; ++i) {
    const Eigenvalue value = eigenvalue(eps, eps->eigr[i]);
    Vec x = nullptr;
    petsc::check(MatDenseGetColumnVecRead(X, i, &x));
    const Pencil::Lengths lengths = pencil.lengths(x, value.lambda);
    petsc::check(MatDenseRestoreColumnVecRead(X, i, &x));
    if (lengths.residual <= round_off * lengths.terms) continue;
    const double relative = lengths.residual / (value.distance * lengths.mass);
    if (!(relative <= tolerance)) return i;
    if (relative > 100.0 * eps->tol) eps->errest[i] = std::max(eps->errest[i], relative);
  }
  return eps->nconv;
}

}  // namespace chladni::plugin
