#include "plugin/eps_block_lanczos.hpp"

#include <slepc/private/epsimpl.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

#include "common/petsc.hpp"

namespace chladni::plugin {

namespace {

bool has_transformation(EPS eps, std::initializer_list<const char*> types)
{
  STType type = nullptr;
  petsc::check(STGetType(eps->st, &type));
  return std::ranges::any_of(types,
                             [&](const char* known) { return std::string_view(type) == known; });
}

bool seeks_all(EPS eps)
{
  return eps->which == EPS_ALL;
}

bool has_open_end(EPS eps)
{
  return seeks_all(eps) && (eps->inta <= PETSC_MIN_REAL || eps->intb >= PETSC_MAX_REAL);
}

bool has_region(EPS eps)
{
  PetscBool is_all = PETSC_TRUE;
  petsc::check(RGIsTrivial(eps->rg, &is_all));
  return is_all == PETSC_FALSE;
}

/// Whether matrices of the problem can do nothing but multiply.
bool has_no_entries(EPS eps)
{
  Mat A = nullptr, B = nullptr;
  petsc::check(EPSGetOperators(eps, &A, &B));
  for (Mat matrix : {A, B}) {
    PetscBool is_shell = PETSC_FALSE;
    if (matrix) petsc::check(PetscObjectTypeCompare((PetscObject)matrix, MATSHELL, &is_shell));
    if (is_shell) return true;
  }
  return false;
}

/// Whether the solver of the transformation was chosen to be another than a factor. LU is what
/// SLEPc chooses by itself.
bool has_no_factor(EPS eps)
{
  KSP ksp = nullptr;
  PC pc = nullptr;
  KSPType ksp_type = nullptr;
  PCType pc_type = nullptr;
  petsc::check(STGetKSP(eps->st, &ksp));
  petsc::check(KSPGetPC(ksp, &pc));
  petsc::check(KSPGetType(ksp, &ksp_type));
  petsc::check(PCGetType(pc, &pc_type));
  const bool by_itself = ksp_type == nullptr || std::string_view(ksp_type) == KSPPREONLY;
  const bool is_factor = pc_type == nullptr || std::string_view(pc_type) == PCCHOLESKY ||
                         std::string_view(pc_type) == PCLU;
  return !by_itself || !is_factor;
}

constexpr std::array table{
    Refusal{"problems that are not symmetric (EPS_NHEP, EPS_GNHEP, EPS_PGNHEP)",
            "the recurrence of Lanczos holds for operators that are symmetric in the inner product "
            "of B; use -eps_type krylovschur, or say -eps_hermitian where the problem is symmetric",
            [](EPS eps) { return !eps->ishermitian; }},
    Refusal{"an indefinite B (EPS_GHIEP, or negative x^T B x under EPS_GHEP)",
            "B is the inner product, and lengths in it must be real; use -eps_gen_indefinite with "
            "-eps_type krylovschur",
            [](EPS eps) { return eps->isgeneralized && !eps->ispositive; }},
    Refusal{"left eigenvectors (-eps_two_sided)",
            "those of a symmetric problem are the right ones; leave the option out",
            [](EPS eps) { return eps->twosided == PETSC_TRUE; }},
    Refusal{"balancing (-eps_balance)",
            "it scales rows and columns apart, which ends the symmetry; leave the option out",
            [](EPS eps) { return eps->balance != EPS_BALANCE_NONE; }},
    Refusal{
        "harmonic, relative and refined extraction (-eps_harmonic, -eps_refined)",
        "inner eigenvalues come by -st_type sinvert, with all their copies; harmonic Ritz values "
        "have no recurrence in blocks here",
        [](EPS eps) { return eps->extraction != EPS_RITZ; }},
    Refusal{
        "regions (-rg_type)",
        "whether copies of an eigenvalue are missing is decided along the order of eigenvalues, "
        "which a region cuts into pieces; use -eps_interval a,b",
        has_region},
    Refusal{"arbitrary selection (EPSSetArbitrarySelection)",
            "an order by vectors does not tell whether copies of an eigenvalue are missing; use "
            "-eps_type krylovschur",
            [](EPS eps) { return eps->arbitrary != nullptr; }},
    Refusal{
        "transformations other than shift, sinvert, cayley and shell (-st_type)",
        "a filter maps many eigenvalues to one, so that nothing tells whether all are there; use "
        "-eps_interval a,b with -st_type sinvert",
        [](EPS eps) {
          return !has_transformation(eps, {STSHIFT, STSINVERT, STCAYLEY, STSHELL});
        }},
    Refusal{"all eigenvalues without an interval (-eps_all)",
            "they are counted at the ends of an interval; give -eps_interval a,b",
            [](EPS eps) { return seeks_all(eps) && eps->inta == eps->intb; }},
    Refusal{"an interval with an end at infinity",
            "it is certified by counts at both ends; give two numbers", has_open_end},
    Refusal{"an interval without -st_type sinvert",
            "the factors of A - sigma B that it needs are those of sinvert; add -st_type sinvert",
            [](EPS eps) { return seeks_all(eps) && !has_transformation(eps, {STSINVERT}); }},
    Refusal{"an interval of matrices that only multiply (shell)",
            "eigenvalues are counted by the pivots of A - sigma B, which need its entries; use "
            "-eps_type krylovschur with -st_type filter",
            [](EPS eps) { return seeks_all(eps) && has_no_entries(eps); }},
    Refusal{
        "an interval with an iterative solver (-st_ksp_type, -st_pc_type other than cholesky)",
        "eigenvalues are counted by the pivots of a factor; use -st_ksp_type preonly -st_pc_type "
        "cholesky",
        [](EPS eps) { return seeks_all(eps) && has_no_factor(eps); }},
    Refusal{"an interval with a deflation space",
            "the pivots count what is deflated too; leave the space out and drop its eigenvalues",
            [](EPS eps) { return seeks_all(eps) && eps->nds != 0; }},
    Refusal{"an interval with a stopping test of one's own",
            "an interval ends when all that was counted is found; leave the test out",
            [](EPS eps) { return seeks_all(eps) && eps->stopping != EPSStoppingBasic; }},
};

}  // namespace

std::span<const Refusal> refusals()
{
  return table;
}

void refuse_what_is_not_there(EPS eps)
{
  for (const Refusal& refusal : table)
    if (refusal.is_asked(eps))
      throw Error(fmt::format("blocklanczos refuses {}: {}", refusal.what, refusal.reason));
}

}  // namespace chladni::plugin
