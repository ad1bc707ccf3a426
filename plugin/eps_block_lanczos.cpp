// The SLEPc solver type "blocklanczos": block Lanczos with full reorthogonalisation and thick
// restart for symmetric problems, standard or generalised, of any shift.
// Source: Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228; as
// linear/lanczos/block_lanczos.
#include <slepc/private/epsimpl.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/petsc_compat.hpp"
#include "linear/lanczos/block_iteration.hpp"
#include "plugin/chladni_cms.h"
#include "plugin/eps_operator.hpp"
#include "plugin/eps_order.hpp"
#include "plugin/eps_refusals.hpp"
#include "plugin/eps_residuals.hpp"
#include "plugin/eps_sequences.hpp"
#include "plugin/eps_slices.hpp"
#include "plugin/guard.hpp"

using namespace chladni;  // NOLINT(google-build-using-namespace)
using namespace plugin;   // NOLINT(google-build-using-namespace)

namespace {

constexpr const char* type_name = "blocklanczos";

struct Options {
  PetscInt block_size;      ///< as asked for; 0: what the subspace has room for
  PetscReal keep;           ///< share of the surplus Ritz vectors that a restart keeps
  PetscReal strictness;     ///< share of the tolerance that the recurrence must meet
  bool has_eigenvalues;     ///< what `solve` leaves needs no transformation back
  Certificate certificate;  ///< of the last interval
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
    if (eps->which != EPS_ALL && eps->ncv != petsc::automatic && eps->ncv < eps->n)
      b = std::clamp<PetscInt>((eps->ncv - eps->nev) / blocks_beyond, 1, most);
  }
  return std::min(b, eps->n);
}

/// The basis of the EPS holds the eigenvectors, and first the initial space, whose number is
/// negative until SLEPc copies it. The iteration has a basis of its own.
PetscErrorCode allocate(EPS eps)
{
  PetscBool is_cayley = PETSC_FALSE, is_injective = PETSC_TRUE;
  Mat B = nullptr;
  PetscFunctionBegin;
  PetscCall(EPSAllocateSolution(eps, 0));
  PetscCall(EPS_SetInnerProduct(eps));
  PetscCall(PetscObjectTypeCompare((PetscObject)eps->st, STCAYLEY, &is_cayley));
  if (is_cayley && eps->isgeneralized) {  // SLEPc's A + nu B may be indefinite
    PetscCall(EPSGetOperators(eps, nullptr, &B));
    PetscCall(BVSetMatrix(eps->V, B, PETSC_FALSE));
  }
  // With a deflation space in it, it cannot change its size any more.
  if (eps->nds == 0)
    PetscCall(BVResize(eps->V, std::max<PetscInt>({1, eps->nev, -eps->nini}), PETSC_FALSE));
  // Where a shell transformation has no inverse, SLEPc computes Rayleigh quotients with it.
  PetscCall(DSSetType(eps->ds, DSHEP));
  PetscCall(STIsInjective(eps->st, &is_injective));
  if (!is_injective) PetscCall(DSAllocate(eps->ds, eps->ncv + 1));
  PetscFunctionReturn(0);
}

/// Of an interval: how many pairs there are is known after the counts.
PetscErrorCode set_up_interval(EPS eps)
{
  PetscFunctionBegin;
  eps->nev = eps->ncv = eps->mpd = 1;
  if (eps->max_it == petsc::automatic) eps->max_it = 1000;
  PetscCall(STSetTransform(eps->st, PETSC_FALSE));  // no factor of its own
  PetscCall(allocate(eps));
  PetscCall(set_up_sort(eps));
  PetscFunctionReturn(0);
}

PetscErrorCode set_up(EPS eps)
{
  PetscBool inverse = PETSC_FALSE;
  const PetscInt b = block_size(eps);
  PetscFunctionBegin;
  PetscCall(guarded((PetscObject)eps, __func__, [eps] { refuse_what_is_not_there(eps); }));
  options_of(eps)->certificate = {};
  if (eps->which == EPS_ALL) {
    PetscCall(set_up_interval(eps));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscObjectTypeCompareAny((PetscObject)eps->st, &inverse, STSINVERT, STCAYLEY, ""));
  if (!eps->which) eps->which = inverse ? EPS_TARGET_MAGNITUDE : EPS_LARGEST_MAGNITUDE;
  if (eps->ncv == petsc::automatic) eps->ncv = std::min(eps->n, 2 * eps->nev + 16 * b);
  PetscCheck(eps->ncv >= std::min(eps->n, eps->nev + 2 * b), PetscObjectComm((PetscObject)eps),
             PETSC_ERR_USER_INPUT,
             "-eps_ncv %" PetscInt_FMT
             " is too small: give at least nev + 2 blocks = %" PetscInt_FMT
             ", or a smaller -eps_blocklanczos_blocksize",
             eps->ncv, std::min(eps->n, eps->nev + 2 * b));
  if (eps->mpd == petsc::automatic) eps->mpd = eps->ncv;
  // As many vectors as 100 restarts of a method without blocks, which keeps half of its basis.
  if (eps->max_it == petsc::automatic)
    eps->max_it = std::max<PetscInt>({100, 2 * eps->n / b, 50 * eps->ncv / b});
  PetscCall(allocate(eps));
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
    all_so_far = all_so_far && eps->errest[i] < options_of(eps)->strictness * eps->tol;
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

/// Keeps the wanted Ritz vectors and some of the others.
void restart(EPS eps, linear::BlockIteration& iteration)
{
  const auto surplus = static_cast<double>(iteration.n_vectors() - eps->nev);
  const auto n_kept = eps->nev + static_cast<PetscInt>(options_of(eps)->keep * surplus);
  iteration.restart(std::min(n_kept, iteration.n_vectors() - 1));
}

/// Block steps until enough pairs have converged, nothing is left, or patience ends.
void iterate(EPS eps, linear::BlockIteration& iteration, const linear::BlockOperator& op)
{
  const auto before = [eps](double a, double b) { return comes_before(eps, a, b); };
  while (eps->reason == EPS_CONVERGED_ITERATING) {
    if (iteration.is_full()) restart(eps, iteration);
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
  }
}

/// Whether the residuals that EPSErrorView prints must be below the tolerance: the user asks for
/// it, or a solver inside iterates, so that the recurrence is that of another operator.
bool is_told_by_true_residuals(EPS eps)
{
  return eps->trueres == PETSC_TRUE || !is_direct(eps);
}

std::vector<Eigenvalue> eigenvalues(EPS eps)
{
  std::vector<Eigenvalue> values;
  PetscScalar shift = 0.0;
  petsc::check(STGetShift(eps->st, &shift));
  for (PetscInt i = 0; i < eps->nconv; ++i) {
    const double value = eps->eigr[i];
    values.push_back(options_of(eps)->has_eigenvalues
                         ? Eigenvalue{.lambda = value, .distance = std::abs(value - shift)}
                         : eigenvalue(eps, value));
  }
  return values;
}

/// The largest printed error over what is allowed, where more than round-off is left.
double excess(EPS eps, const std::vector<PairErrors>& errors)
{
  double largest = 0.0;
  for (const PairErrors& pair : errors) {
    const double least = eps->trueres ? 0.0 : pair.round_off;
    largest = std::max(largest, pair.printed / std::max(eps->tol, least));
  }
  return largest;
}

/// Pairs with true residuals below the tolerance, as far as some more applications of the inexact
/// operator bring it.
void refine(EPS eps, const linear::BlockOperator& op, petsc::Matrix& X)
{
  constexpr int most = 6;
  constexpr double gain = 0.7;
  std::vector<PairErrors> errors = pair_errors(eps, X, eigenvalues(eps));
  for (int pass = 0; pass < most && excess(eps, errors) > 1.0; ++pass) {
    const std::vector<PetscScalar> before(eps->eigr, eps->eigr + eps->nconv);
    const bool had_eigenvalues = options_of(eps)->has_eigenvalues;
    Pairs pairs = refined(eps, X, op);
    if (std::cmp_less(pairs.lambda.size(), eps->nconv)) break;
    std::ranges::copy(pairs.lambda, eps->eigr);
    options_of(eps)->has_eigenvalues = true;
    std::vector<PairErrors> after = pair_errors(eps, pairs.X, eigenvalues(eps));
    if (excess(eps, after) > gain * excess(eps, errors)) {
      std::ranges::copy(before, eps->eigr);
      options_of(eps)->has_eigenvalues = had_eigenvalues;
      break;
    }
    X = std::move(pairs.X);
    errors = std::move(after);
  }
  for (std::size_t i = 0; i < errors.size(); ++i) eps->errest[i] = errors[i].printed;
}

/// Whether pair i may be told: the recurrence does not know of the errors of its operator.
bool is_true(EPS eps, PetscInt i, const PairErrors& errors)
{
  if (!(errors.scaled <= std::max(1e-4, 100.0 * eps->tol))) return false;
  if (!is_told_by_true_residuals(eps)) return true;
  constexpr double as_slepc_says = 5.0;  // EPSErrorView: "higher than the tolerance"
  return eps->errest[i] <=
         (eps->trueres ? eps->tol : std::max(as_slepc_says * eps->tol, errors.round_off));
}

/// Keeps the pairs that satisfy A x = lambda B x. Where the factor of A - sigma B is unusable, as
/// with sigma on an eigenvalue, or a solver inside too loose, there may be none.
void drop_false_pairs(EPS eps, Mat X)
{
  const std::vector<PairErrors> errors = pair_errors(eps, X, eigenvalues(eps));
  PetscInt n_true = 0;
  while (n_true < eps->nconv && is_true(eps, n_true, errors[std::size_t(n_true)])) {
    const double scaled = errors[std::size_t(n_true)].scaled;
    if (scaled > 100.0 * eps->tol) eps->errest[n_true] = std::max(eps->errest[n_true], scaled);
    ++n_true;
  }
  if (n_true == eps->nconv) return;
  petsc::check(PetscInfo(eps,
                         "%" PetscInt_FMT " of %" PetscInt_FMT
                         " pairs satisfy A x = lambda B x: the operator is not accurate; is the "
                         "target an eigenvalue, or the tolerance of the solver inside "
                         "(-st_ksp_rtol) too loose?\n",
                         n_true, eps->nconv));
  eps->nconv = n_true;
  if (n_true < eps->nev) eps->reason = EPS_DIVERGED_BREAKDOWN;
}

/// Copies the columns of X into the basis of the EPS.
void store_columns(EPS eps, Mat X)
{
  if (eps->nds == 0) petsc::check(BVResize(eps->V, std::max<PetscInt>(eps->nconv, 1), PETSC_FALSE));
  for (PetscInt i = 0; i < eps->nconv; ++i) {
    Vec x = nullptr, v = nullptr;
    petsc::check(MatDenseGetColumnVecRead(X, i, &x));
    petsc::check(BVGetColumn(eps->V, i, &v));
    petsc::check(VecCopy(x, v));
    petsc::check(BVRestoreColumn(eps->V, i, &v));
    petsc::check(MatDenseRestoreColumnVecRead(X, i, &x));
  }
}

void store_vectors(EPS eps, const linear::BlockIteration& iteration,
                   const linear::BlockOperator& op)
{
  PetscBool is_injective = PETSC_TRUE;
  petsc::check(STIsInjective(eps->st, &is_injective));
  if (!is_injective) {
    eps->nconv = std::min(eps->nconv, eps->nev);  // SLEPc sorts them by Rayleigh quotients
    petsc::check(DSSetDimensions(eps->ds, eps->nconv, 0, 0));
    petsc::check(DSSetState(eps->ds, DS_STATE_RAW));
  }
  if (eps->nconv == 0) return;
  // SLEPc asks for it with a B alone, whose null space is to be left; of a standard problem it
  // makes the residual of A x = lambda x as small as that of the inverse.
  const bool purifies = inverts(eps) && (eps->purify || !eps->isgeneralized);
  petsc::Matrix X =
      purifies ? iteration.purified_vectors(0, eps->nconv, op) : iteration.ritz_vectors(eps->nconv);
  if (is_injective) {
    if (is_told_by_true_residuals(eps) && has_own_inner_product(eps)) refine(eps, op, X);
    drop_false_pairs(eps, X);
  }
  store_columns(eps, X);
}

/// All pairs of the interval of EPSSetInterval.
void solve_all(EPS eps)
{
  const IntervalPairs all = pairs_of_interval(eps, block_size(eps));
  options_of(eps)->certificate = all.certificate;
  options_of(eps)->has_eigenvalues = true;
  eps->reason = all.is_complete ? EPS_CONVERGED_TOL : EPS_DIVERGED_ITS;
  eps->nconv = eps->nev = static_cast<PetscInt>(all.pairs.size());
  eps->ncv = eps->mpd = std::max<PetscInt>(eps->nconv, 1);
  petsc::check(EPSAllocateSolution(eps, 0));
  for (PetscInt i = 0; i < eps->nconv; ++i) {
    const IntervalPair& pair = all.pairs[std::size_t(i)];
    eps->eigr[i] = pair.lambda;
    eps->eigi[i] = 0.0;
    eps->errest[i] = pair.error;
    eps->perm[i] = i;
    petsc::check(BVInsertVec(eps->V, i, pair.x));
  }
}

/// Where true residuals decide, the recurrence is asked for more than they need, the more the less
/// they follow it.
void solve_some(EPS eps)
{
  constexpr double strictest = 1e-4;
  const PetscInt b = block_size(eps);
  const petsc::Matrix B = inner_product_matrix(eps), C = deflation_space(eps);
  linear::BlockIteration iteration(B, b, eps->ncv + b);
  const linear::BlockOperator op = operator_of(eps, C);
  if (C != nullptr) {
    petsc::check(PetscObjectReference((PetscObject)(Mat)C));
    iteration.exclude(petsc::Matrix(static_cast<Mat>(C)));
  }
  Options& options = *options_of(eps);
  options.strictness = 1.0;
  start(eps, iteration, op);
  for (;;) {
    options.has_eigenvalues = false;
    iterate(eps, iteration, op);
    const EPSConvergedReason by_recurrence = eps->reason;
    store_vectors(eps, iteration, op);
    options.strictness *= 0.1;
    if (by_recurrence <= 0 || eps->reason > 0 || iteration.is_exhausted() ||
        options.strictness < strictest || !is_told_by_true_residuals(eps))
      return;
    eps->reason = EPS_CONVERGED_ITERATING;
  }
}

PetscErrorCode solve(EPS eps)
{
  PetscFunctionBegin;
  PetscCall(guarded((PetscObject)eps, __func__,
                    [eps] { eps->which == EPS_ALL ? solve_all(eps) : solve_some(eps); }));
  PetscFunctionReturn(0);
}

PetscErrorCode back_transform(EPS eps)
{
  PetscFunctionBegin;
  if (!options_of(eps)->has_eigenvalues)
    PetscCall(STBackTransform(eps->st, eps->nconv, eps->eigr, eps->eigi));
  PetscFunctionReturn(0);
}

/// With -help, as docs/how-to/plugin.md has it.
PetscErrorCode print_refusals(EPS eps)
{
  const MPI_Comm comm = PetscObjectComm((PetscObject)eps);
  PetscFunctionBegin;
  PetscCall((*PetscHelpPrintf)(comm, "blocklanczos refuses:\n"));
  for (const Refusal& refusal : refusals())
    PetscCall((*PetscHelpPrintf)(comm, "  - %s: %s.\n", refusal.what, refusal.reason));
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
  if (PetscOptionsObject->printhelp) PetscCall(print_refusals(eps));
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
  PetscCall(view_certificate(options_of(eps)->certificate, viewer));
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
  *options = {
      .block_size = 0, .keep = 0.5, .strictness = 1.0, .has_eigenvalues = false, .certificate = {}};
  eps->data = options;
  eps->categ = EPS_CATEGORY_KRYLOV;
  eps->useds = PETSC_TRUE;
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
