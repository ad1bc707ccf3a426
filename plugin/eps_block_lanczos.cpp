// The SLEPc solver type "blocklanczos": block Lanczos with full reorthogonalisation and thick
// restart for symmetric problems, standard or generalised, of any shift.
// Source: Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228; as
// linear/lanczos/block_lanczos.

#include "plugin/eps_block_lanczos.hpp"

#include <slepc/private/epsimpl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/orthonormalisation.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/lanczos/block_iteration.hpp"
#include "plugin/chladni_cms.h"
#include "plugin/cms_impl.hpp"
#include "plugin/eps_operator.hpp"
#include "plugin/eps_slices.hpp"

using namespace chladni;  // NOLINT(google-build-using-namespace)
using namespace plugin;   // NOLINT(google-build-using-namespace)

namespace {

constexpr const char* type_name = "blocklanczos";

struct Options {
  PetscInt block_size;              ///< as asked for; 0: what the subspace has room for
  PetscReal keep;                   ///< share of the surplus Ritz vectors that a restart keeps
  PetscReal strictness;             ///< share of the tolerance that the recurrence must meet
  bool has_eigenvalues;             ///< what `solve` leaves needs no transformation back
  plugin::Certificate certificate;  ///< of the last interval
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
  PetscInt n_kept = 0;  // by the last sequence that began from an exhausted basis
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
    // What was left out of the blocks of a singular B keeps pairs from converging; a new sequence,
    // orthogonal to those that did, finds the others.
    const bool goes_on = iteration.is_exhausted() && n_first > n_kept;
    if (goes_on) n_kept = n_first;
    if (goes_on || copies == linear::Copies::may_lack) begin_anew(eps, iteration, n_first, op);
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

namespace chladni::plugin {

namespace {

/// The problem of an EPS with work vectors.
class Pencil {
 public:
  explicit Pencil(EPS eps) : taken_(shift_in_place(eps))
  {
    A_ = problem_matrices(eps).A;
    B_ = problem_matrices(eps).B;
    for (petsc::Vector* v : {&a_, &b_, &w_, &r_, &Bx_})
      petsc::check(MatCreateVecs(A_, v->put(), nullptr));
    take_diagonal(A_, a_);
    take_diagonal(B_, b_);
  }

  PairErrors errors(Vec x, const Eigenvalue& value)
  {
    constexpr double eps = std::numeric_limits<double>::epsilon(), round_off = 1e-12;
    const double size = weigh_rows(value.lambda);
    take_residual(x, value.lambda);
    PetscReal length = 0.0, residual = 0.0, terms = 0.0;
    petsc::check(VecNorm(x, NORM_2, &length));
    petsc::check(VecNorm(r_, NORM_2, &residual));
    PairErrors errors{};
    errors.printed = residual / (std::abs(value.lambda) * length);
    errors.round_off = 100.0 * eps * size / std::abs(value.lambda);
    const double scaled = scaled_length(r_), mass = scaled_length(Bx_);
    petsc::check(VecPointwiseMult(r_, w_, x));  // what cancels in A x
    petsc::check(VecNorm(r_, NORM_2, &terms));
    errors.scaled = scaled <= round_off * terms ? 0.0 : scaled / (value.distance * mass);
    return errors;
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

  /// w <- the root of |A_ii| + |lambda B_ii|, by which rows are divided. Returns the largest sum.
  double weigh_rows(double lambda)
  {
    PetscReal largest = 0.0;
    petsc::check(VecWAXPY(w_, std::abs(lambda), b_, a_));
    petsc::check(VecMax(w_, nullptr, &largest));
    petsc::check(VecShift(w_, 1e-16 * largest));
    petsc::check(VecSqrtAbs(w_));
    return largest;
  }

  /// r <- A x - lambda B x, and B x
  void take_residual(Vec x, double lambda)
  {
    petsc::check(MatMult(A_, x, r_));
    if (B_)
      petsc::check(MatMult(B_, x, Bx_));
    else
      petsc::check(VecCopy(x, Bx_));
    petsc::check(VecAXPY(r_, taken_ - lambda, Bx_));
  }

  double scaled_length(Vec v)
  {
    PetscReal length = 0.0;
    petsc::check(VecPointwiseDivide(v, v, w_));
    petsc::check(VecNorm(v, NORM_2, &length));
    return length;
  }

  double taken_;  ///< from A
  Mat A_ = nullptr, B_ = nullptr;
  petsc::Vector a_, b_, w_, r_, Bx_;
};

/// A X, or B X, of a matrix that may do nothing but multiply vectors.
petsc::Matrix times(Mat A, Mat X)
{
  PetscInt n = 0;
  petsc::Matrix Y;
  petsc::check(MatGetSize(X, nullptr, &n));
  petsc::check(MatDuplicate(X, MAT_COPY_VALUES, Y.put()));
  if (A == nullptr) return Y;
  for (PetscInt j = 0; j < n; ++j) {
    Vec x = nullptr, y = nullptr;
    petsc::check(MatDenseGetColumnVecRead(X, j, &x));
    petsc::check(MatDenseGetColumnVecWrite(Y, j, &y));
    petsc::check(MatMult(A, x, y));
    petsc::check(MatDenseRestoreColumnVecWrite(Y, j, &y));
    petsc::check(MatDenseRestoreColumnVecRead(X, j, &x));
  }
  return Y;
}

/// X S
petsc::Matrix combined(Mat X, const Eigen::MatrixXd& S)
{
  petsc::Matrix Y = linear::uninitialized_dense(X, S.cols());
  petsc::check(MatZeroEntries(Y));
  linear::add_product(1.0, X, S, Y);
  return Y;
}

/// The places of values in the order that the user wants.
std::vector<PetscInt> wanted_order(EPS eps, const std::vector<double>& lambda)
{
  std::vector<PetscInt> order(lambda.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](PetscInt a, PetscInt b) {
    PetscInt sign = 0;
    petsc::check(eps->sc->comparison(lambda[std::size_t(a)], 0.0, lambda[std::size_t(b)], 0.0,
                                     &sign, eps->sc->comparisonctx));
    return sign < 0;
  });
  return order;
}

}  // namespace

Eigenvalue eigenvalue(EPS eps, double theta)
{
  PetscScalar lambda = theta, zero = 0.0, shift = 0.0;
  PetscBool is_inverse = PETSC_FALSE, is_shift = PETSC_FALSE;
  petsc::check(STBackTransform(eps->st, 1, &lambda, &zero));
  petsc::check(STGetShift(eps->st, &shift));
  petsc::check(
      PetscObjectTypeCompareAny((PetscObject)eps->st, &is_inverse, STSINVERT, STCAYLEY, ""));
  petsc::check(PetscObjectTypeCompare((PetscObject)eps->st, STSHIFT, &is_shift));
  if (inverts(eps)) return {.lambda = lambda, .distance = std::abs(1.0 / theta)};
  if (is_inverse) return {.lambda = lambda, .distance = std::abs(lambda - shift)};
  return {.lambda = lambda, .distance = std::abs(is_shift ? theta : lambda)};
}

std::vector<PairErrors> pair_errors(EPS eps, Mat X, std::span<const Eigenvalue> values)
{
  Pencil pencil(eps);
  std::vector<PairErrors> errors;
  for (std::size_t i = 0; i < values.size(); ++i) {
    Vec x = nullptr;
    petsc::check(MatDenseGetColumnVecRead(X, static_cast<PetscInt>(i), &x));
    errors.push_back(pencil.errors(x, values[i]));
    petsc::check(MatDenseRestoreColumnVecRead(X, static_cast<PetscInt>(i), &x));
  }
  return errors;
}

Pairs refined(EPS eps, Mat X, const linear::BlockOperator& op)
{
  constexpr double independent = 1e-12;
  const auto [A, B] = problem_matrices(eps);
  const MPI_Comm comm = petsc::communicator(X);
  petsc::Matrix Y;
  petsc::check(MatDuplicate(X, MAT_COPY_VALUES, Y.put()));
  op(X, times(B, X), Y);
  const Eigen::MatrixXd G = linear::inner_product(Y, times(B, Y));
  std::vector<double> sizes;
  for (Eigen::Index j = 0; j < G.cols(); ++j) sizes.push_back(std::sqrt(std::max(G(j, j), 0.0)));
  const linear::Orthonormalisation o = linear::orthonormalisation(G, sizes, independent, comm);
  const petsc::Matrix Q = combined(Y, o.to_Q);
  const linear::SymmetricEigen ritz =
      linear::symmetric_eigen(linear::inner_product(Q, times(A, Q)), comm);
  std::vector<double> lambda = ritz.values;
  for (double& value : lambda) value += shift_in_place(eps);
  const std::vector<PetscInt> order = wanted_order(eps, lambda);
  Pairs pairs{.lambda = {}, .X = combined(Q, Eigen::MatrixXd(ritz.vectors(every, order)))};
  for (const PetscInt i : order) pairs.lambda.push_back(lambda[std::size_t(i)]);
  return pairs;
}

void start(EPS eps, linear::BlockIteration& iteration, const linear::BlockOperator& op)
{
  const PetscInt n = std::min(eps->nini, iteration.block_size());
  if (n <= 0) return iteration.start(op);
  const petsc::Matrix guesses = iteration.new_block(n);
  petsc::check(MatZeroEntries(guesses));
  for (PetscInt i = 0; i < eps->nini; ++i) {
    Vec v = nullptr, guess = nullptr;
    petsc::check(BVGetColumn(eps->V, i, &v));
    petsc::check(MatDenseGetColumnVec(guesses, i % n, &guess));
    petsc::check(VecAXPY(guess, 1.0, v));
    petsc::check(MatDenseRestoreColumnVec(guesses, i % n, &guess));
    petsc::check(BVRestoreColumn(eps->V, i, &v));
  }
  iteration.start(op, guesses, eps->nini);
}

void begin_anew(EPS eps, linear::BlockIteration& iteration, PetscInt n_kept,
                const linear::BlockOperator& op)
{
  const bool is_second = !iteration.sequence().known.empty();
  const PetscInt b = iteration.block_size();
  const PetscInt widest = std::max(b, eps->nev / 4);
  const PetscInt width = std::min({widest, (is_second ? 2 : 1) * b, eps->n - n_kept});
  petsc::check(PetscInfo(eps,
                         "an eigenvalue may have more copies than the %" PetscInt_FMT
                         " found: %" PetscInt_FMT " new random vectors\n",
                         iteration.sequence().n_sources, width));
  iteration.reserve(std::min(n_kept + 8 * width, eps->n) + width);
  iteration.begin_anew(n_kept, width, op);
}

}  // namespace chladni::plugin
