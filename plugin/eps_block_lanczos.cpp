// The SLEPc solver type "blocklanczos": block Lanczos with full reorthogonalisation and thick
// restart for symmetric problems, standard or generalised, of any shift.
// Source: Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228; as
// linear/lanczos/block_lanczos.
#include <slepc/private/epsimpl.h>

#include <algorithm>

#include "common/petsc_compat.hpp"
#include "linear/lanczos/block_iteration.hpp"
#include "plugin/chladni_cms.h"
#include "plugin/eps_operator.hpp"
#include "plugin/eps_order.hpp"
#include "plugin/eps_residuals.hpp"
#include "plugin/eps_sequences.hpp"
#include "plugin/guard.hpp"

using namespace chladni;  // NOLINT(google-build-using-namespace)
using namespace plugin;   // NOLINT(google-build-using-namespace)

namespace {

constexpr const char* type_name = "blocklanczos";

struct Options {
  PetscInt block_size;  ///< as asked for; 0: what the subspace has room for
  PetscReal keep;       ///< share of the surplus Ritz vectors that a restart keeps
};

Options* options_of(EPS eps)
{
  return static_cast<Options*>(eps->data);
}

/// Vectors solved at a time: as many as were asked for, else 8, or fewer where restarts would leave
/// no room for some blocks.
PetscInt block_size(EPS eps)
{
  constexpr PetscInt most = 8, blocks_beyond = 8;
  PetscInt b = options_of(eps)->block_size;
  if (b == 0) {
    b = most;
    if (eps->ncv != petsc::automatic && eps->ncv < eps->n)
      b = std::clamp<PetscInt>((eps->ncv - eps->nev) / blocks_beyond, 1, most);
  }
  return std::min(b, eps->n);
}

PetscErrorCode check_problem(EPS eps)
{
  PetscBool known = PETSC_FALSE;
  PetscFunctionBegin;
  EPSCheckHermitianDefinite(eps);
  EPSCheckUnsupported(eps, EPS_FEATURE_BALANCE | EPS_FEATURE_ARBITRARY | EPS_FEATURE_REGION |
                               EPS_FEATURE_EXTRACTION | EPS_FEATURE_TWOSIDED);
  PetscCall(PetscObjectTypeCompareAny((PetscObject)eps->st, &known, STSINVERT, STSHIFT, ""));
  PetscCheck(known, PetscObjectComm((PetscObject)eps), PETSC_ERR_SUP,
             "blocklanczos needs -st_type sinvert (inner eigenvalues) or shift (outer ones)");
  PetscCheck(eps->nds == 0, PetscObjectComm((PetscObject)eps), PETSC_ERR_SUP,
             "blocklanczos takes no deflation space; use -eps_type krylovschur");
  PetscCheck(!eps->trueres, PetscObjectComm((PetscObject)eps), PETSC_ERR_SUP,
             "blocklanczos converges by its own residuals; leave -eps_true_residual out and see "
             "-eps_error_relative");
  PetscFunctionReturn(0);
}

PetscErrorCode set_up(EPS eps)
{
  PetscBool sinvert = PETSC_FALSE;
  const PetscInt b = block_size(eps);
  PetscFunctionBegin;
  PetscCall(check_problem(eps));
  PetscCall(PetscObjectTypeCompare((PetscObject)eps->st, STSINVERT, &sinvert));
  if (!eps->which) eps->which = sinvert ? EPS_TARGET_MAGNITUDE : EPS_LARGEST_MAGNITUDE;
  if (eps->ncv == petsc::automatic) eps->ncv = std::min(eps->n, 2 * eps->nev + 16 * b);
  PetscCheck(eps->ncv >= std::min(eps->n, eps->nev + 2 * b), PetscObjectComm((PetscObject)eps),
             PETSC_ERR_USER_INPUT,
             "-eps_ncv %" PetscInt_FMT
             " is too small: give at least nev + 2 blocks = %" PetscInt_FMT
             ", or a smaller -eps_blocklanczos_blocksize",
             eps->ncv, std::min(eps->n, eps->nev + 2 * b));
  if (eps->mpd == petsc::automatic) eps->mpd = eps->ncv;
  if (eps->max_it == petsc::automatic) eps->max_it = std::max<PetscInt>(100, 2 * eps->n / b);
  PetscCall(EPSAllocateSolution(eps, 0));
  PetscCall(EPS_SetInnerProduct(eps));
  // The iteration has a basis of its own; this one holds the eigenvectors, and first the initial
  // space, whose number is negative until SLEPc copies it.
  PetscCall(BVResize(eps->V, std::max(eps->nev, -eps->nini), PETSC_FALSE));
  PetscCall(set_up_sort(eps));
  PetscFunctionReturn(0);
}

/// Ritz values and error estimates to SLEPc; number of leading ones that converged.
PetscInt publish(EPS eps, const linear::BlockIteration& iteration)
{
  const PetscInt n = std::min(iteration.n_vectors(), eps->ncv);
  PetscInt n_converged = 0;
  bool all_so_far = true;
  for (PetscInt i = 0; i < n; ++i) {
    eps->eigr[i] = iteration.theta(i);
    eps->eigi[i] = 0.0;
    PetscScalar value = eps->eigr[i], zero = 0.0;
    if (eps->conv == EPS_CONV_NORM) petsc::check(STBackTransform(eps->st, 1, &value, &zero));
    petsc::check((*eps->converged)(eps, value, 0.0, iteration.residual(i), &eps->errest[i],
                                   eps->convergedctx));
    if (iteration.residual(i) == 0.0) eps->errest[i] = 0.0;  // relative to zero, too
    all_so_far = all_so_far && eps->errest[i] < eps->tol;
    if (all_so_far) ++n_converged;
  }
  return n_converged;
}

/// The largest number of pairs among the first n that lack no copy of a multiple eigenvalue, the
/// last one's excepted; n_least at least.
PetscInt n_without_gaps(const linear::BlockIteration& iteration, PetscInt n, PetscInt n_least,
                        double tol)
{
  while (n > n_least && iteration.copies_among_first(n, tol) != linear::Copies::all_there) --n;
  return n;
}

/// Block steps until enough pairs have converged, nothing is left, or patience ends.
void iterate(EPS eps, linear::BlockIteration& iteration, const linear::BlockOperator& op)
{
  const auto before = [eps](double a, double b) { return comes_before(eps, a, b); };
  start(eps, iteration, op);
  while (eps->reason == EPS_CONVERGED_ITERATING) {
    iteration.step(op);
    ++eps->its;
    iteration.order_ritz_values(before);
    const PetscInt n_first = publish(eps, iteration);
    const linear::Copies copies =
        iteration.copies_among_first(std::min(n_first, eps->nev), eps->tol);
    eps->nconv = copies == linear::Copies::all_there
                     ? n_without_gaps(iteration, n_first, eps->nev, eps->tol)
                     : std::min(n_first, eps->nev - 1);
    const PetscInt n = std::min(iteration.n_vectors(), eps->ncv);
    petsc::check(EPSMonitor(eps, eps->its, eps->nconv, eps->eigr, eps->eigi, eps->errest, n));
    petsc::check((*eps->stopping)(eps, eps->its, eps->max_it, eps->nconv, eps->nev, &eps->reason,
                                  eps->stoppingctx));
    if (eps->reason != EPS_CONVERGED_ITERATING) return;
    if (copies == linear::Copies::may_lack) begin_anew(eps, iteration, n_first, op);
    if (iteration.is_exhausted()) eps->reason = EPS_DIVERGED_BREAKDOWN;  // fewer pairs exist
    if (!iteration.is_full()) continue;
    const auto surplus = static_cast<double>(iteration.n_vectors() - eps->nev);
    const auto n_kept = eps->nev + static_cast<PetscInt>(options_of(eps)->keep * surplus);
    iteration.restart(std::min(n_kept, iteration.n_vectors() - 1));
  }
}

/// Keeps the pairs that satisfy A x = lambda B x; where the factor of A - sigma B is unusable, as
/// with sigma on an eigenvalue, the recurrence does not know that they do not.
void drop_false_pairs(EPS eps, Mat X)
{
  const PetscInt n_true = n_true_pairs(eps, X);
  if (n_true == eps->nconv) return;
  petsc::check(PetscInfo(eps,
                         "%" PetscInt_FMT " of %" PetscInt_FMT
                         " pairs satisfy A x = lambda B x: the operator is not accurate; is the "
                         "target an eigenvalue?\n",
                         n_true, eps->nconv));
  eps->nconv = n_true;
  if (n_true < eps->nev) eps->reason = EPS_DIVERGED_BREAKDOWN;
}

void store_vectors(EPS eps, const linear::BlockIteration& iteration,
                   const linear::BlockOperator& op)
{
  if (eps->nconv == 0) return;
  // SLEPc asks for it with a B alone, whose null space is to be left; of a standard problem it
  // makes the residual of A x = lambda x as small as that of the inverse.
  const bool purifies = inverts(eps) && (eps->purify || !eps->isgeneralized);
  const petsc::Matrix X =
      purifies ? iteration.purified_vectors(0, eps->nconv, op) : iteration.ritz_vectors(eps->nconv);
  drop_false_pairs(eps, X);
  petsc::check(BVResize(eps->V, std::max<PetscInt>(eps->nconv, 1), PETSC_FALSE));
  for (PetscInt i = 0; i < eps->nconv; ++i) {
    Vec x = nullptr, v = nullptr;
    petsc::check(MatDenseGetColumnVecRead(X, i, &x));
    petsc::check(BVGetColumn(eps->V, i, &v));
    petsc::check(VecCopy(x, v));
    petsc::check(BVRestoreColumn(eps->V, i, &v));
    petsc::check(MatDenseRestoreColumnVecRead(X, i, &x));
  }
}

PetscErrorCode solve(EPS eps)
{
  PetscFunctionBegin;
  PetscCall(guarded((PetscObject)eps, __func__, [eps] {
    const PetscInt b = block_size(eps);
    const petsc::Matrix B = inner_product_matrix(eps);
    linear::BlockIteration iteration(B, b, eps->ncv + b);
    const linear::BlockOperator op = operator_of(eps);
    iterate(eps, iteration, op);
    store_vectors(eps, iteration, op);
  }));
  PetscFunctionReturn(0);
}

PetscErrorCode back_transform(EPS eps)
{
  PetscFunctionBegin;
  PetscCall(STBackTransform(eps->st, eps->nconv, eps->eigr, eps->eigi));
  PetscFunctionReturn(0);
}

PetscErrorCode set_from_options(EPS eps, petsc::OptionItems PetscOptionsObject)
{
  Options& options = *options_of(eps);
  PetscFunctionBegin;
  PetscOptionsHeadBegin(PetscOptionsObject, "EPS blocklanczos options");
  PetscCall(PetscOptionsRangeInt("-eps_blocklanczos_blocksize",
                                 "Vectors solved at a time; 8 to 16 are fastest; 0: 8, or what ncv "
                                 "has room for",
                                 nullptr, options.block_size, &options.block_size, nullptr, 0,
                                 1024));
  PetscCall(PetscOptionsReal("-eps_blocklanczos_restart",
                             "Share of the Ritz vectors beyond nev that a restart keeps", nullptr,
                             options.keep, &options.keep, nullptr));
  PetscOptionsHeadEnd();
  PetscCheck(options.keep >= 0.0 && options.keep <= 0.9, PetscObjectComm((PetscObject)eps),
             PETSC_ERR_USER_INPUT, "-eps_blocklanczos_restart %g; give 0 to 0.9",
             (double)options.keep);
  PetscFunctionReturn(0);
}

PetscErrorCode view(EPS eps, PetscViewer viewer)
{
  PetscBool ascii = PETSC_FALSE;
  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  if (!ascii) PetscFunctionReturn(0);
  PetscCall(PetscViewerASCIIPrintf(viewer, "  block size %" PetscInt_FMT "\n", block_size(eps)));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  a restart keeps %g of the surplus Ritz vectors\n",
                                   (double)options_of(eps)->keep));
  PetscFunctionReturn(0);
}

PetscErrorCode destroy(EPS eps)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(eps->data));
  PetscFunctionReturn(0);
}

/// The vectors are stored by `solve`, purified where that is right.
PetscErrorCode compute_vectors(EPS)
{
  return 0;
}

PetscErrorCode create(EPS eps)
{
  Options* options = nullptr;
  PetscFunctionBegin;
  PetscCall(PetscNew(&options));
  *options = {.block_size = 0, .keep = 0.5};
  eps->data = options;
  eps->categ = EPS_CATEGORY_KRYLOV;
  eps->useds = PETSC_FALSE;
  eps->ops->solve = solve;
  eps->ops->setup = set_up;
  eps->ops->setupsort = set_up_sort;
  eps->ops->setfromoptions = set_from_options;
  eps->ops->destroy = destroy;
  eps->ops->view = view;
  eps->ops->backtransform = back_transform;
  eps->ops->computevectors = compute_vectors;
  PetscFunctionReturn(0);
}

}  // namespace

PetscErrorCode CMSRegisterEPS()
{
  PetscFunctionBegin;
  PetscCall(EPSRegister(type_name, create));
  PetscFunctionReturn(0);
}
