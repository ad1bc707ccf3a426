// What a solved CMS hands out.

#include <algorithm>
#include <numeric>

#include "common/petsc.hpp"
#include "plugin/cms_impl.hpp"
#include "reduce/craig_bampton.hpp"

namespace chladni::plugin {

namespace {

std::vector<int> places_of(const Inside& in)
{
  return reduce::coordinate_places(in.set_up->body.masters, in.result->reduction.model);
}

/// A replicated matrix as dense one of the communicator, in the order of the user.
petsc::Matrix distributed(const Eigen::MatrixXd& A, const std::vector<int>& places, MPI_Comm comm)
{
  petsc::Matrix B;
  PetscInt first = 0, last = 0;
  const auto n = static_cast<PetscInt>(places.size());
  petsc::check(MatCreateDense(comm, PETSC_DECIDE, PETSC_DECIDE, n, n, nullptr, B.put()));
  petsc::check(MatGetOwnershipRange(B, &first, &last));
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(B, &values));
  for (PetscInt j = 0; j < n; ++j)
    for (PetscInt i = first; i < last; ++i)
      values[i - first + std::size_t(j) * (last - first)] = A(places[i], places[j]);
  petsc::check(MatDenseRestoreArrayWrite(B, &values));
  petsc::check(MatSetOption(B, MAT_SYMMETRIC, PETSC_TRUE));
  return B;
}

petsc::Matrix dense_rows(MPI_Comm comm, PetscInt n_local, PetscInt n_columns)
{
  petsc::Matrix T;
  petsc::check(
      MatCreateDense(comm, n_local, PETSC_DECIDE, PETSC_DETERMINE, n_columns, nullptr, T.put()));
  return T;
}

/// All rows, each rank its own: no communication.
petsc::Matrix whole_transformation(const reduce::FactoredBody& body,
                                   const reduce::CraigBamptonBasis& Q_CB,
                                   const std::vector<int>& places)
{
  PetscInt n_local = 0;
  petsc::check(MatGetLocalSize(body.K, &n_local, nullptr));
  petsc::Matrix T =
      dense_rows(petsc::communicator(body.K), n_local, static_cast<PetscInt>(places.size()));
  const reduce::BasisColumns columns(Q_CB, body.dofs);
  const auto n = static_cast<std::size_t>(n_local);
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArray(T, &values));
  for (std::size_t j = 0; j < places.size(); ++j)
    columns.write(places[j], std::span(values + j * n, n));
  petsc::check(MatDenseRestoreArray(T, &values));
  return T;
}

/// The rows of `output` of all ranks.
std::vector<PetscInt> checked_output(const Inside& in)
{
  std::vector<PetscInt> rows = all_indices(in.output);
  PetscInt n = 0;
  petsc::check(MatGetSize(in.K, &n, nullptr));
  for (const PetscInt row : rows) {
    if (row < 0 || row >= n) {
      throw Error(
          fmt::format("CMSSetOutput: row {} is out of range; rows are 0 to {}", row, n - 1));
    }
  }
  return rows;
}

/// The rows of `output`, each rank those of its part.
petsc::Matrix chosen_rows(const Inside& in, const std::vector<int>& places)
{
  const MPI_Comm comm = petsc::communicator(in.set_up->body.K);
  const std::vector<PetscInt> dofs = checked_output(in);
  const Eigen::MatrixXd rows =
      reduce::basis_rows(in.result->reduction.Q_CB, in.set_up->body.dofs, dofs);
  const std::vector<PetscInt> own = petsc::own_indices(in.output);
  const PetscInt first = petsc::indices_before(in.output);
  petsc::Matrix T =
      dense_rows(comm, static_cast<PetscInt>(own.size()), static_cast<PetscInt>(places.size()));
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArray(T, &values));
  for (std::size_t j = 0; j < places.size(); ++j)
    for (std::size_t i = 0; i < own.size(); ++i)
      values[i + j * own.size()] = rows(first + static_cast<PetscInt>(i), places[j]);
  petsc::check(MatDenseRestoreArray(T, &values));
  return T;
}

/// The rows asked for of a phase of a harmonic.
petsc::Matrix phase_transformation(const Inside& in, Mat phase, Mat T_harmonic)
{
  petsc::Matrix chosen, T;
  if (in.output) {
    PetscInt first = 0, n = 0;
    petsc::check(MatGetOwnershipRangeColumn(phase, &first, nullptr));
    petsc::check(MatGetLocalSize(phase, nullptr, &n));
    petsc::IndexSet all;
    petsc::check(ISCreateStride(petsc::communicator(phase), n, first, 1, all.put()));
    petsc::check(MatCreateSubMatrix(phase, in.output, all, MAT_INITIAL_MATRIX, chosen.put()));
  }
  petsc::check(MatMatMult(chosen ? static_cast<Mat>(chosen) : phase, T_harmonic, MAT_INITIAL_MATRIX,
                          petsc::automatic, T.put()));
  return T;
}

void make_reduced_operators(Inside& in)
{
  Result& result = *in.result;
  if (result.K_r) return;
  const MPI_Comm comm = in.set_up->body.comm();
  const std::vector<int> places = places_of(in);
  const reduce::ReducedModel& model = result.reduction.model;
  result.M_r = distributed(model.M, places, comm);
  if (const VelocityForces& velocity = in.set_up->velocity; velocity.C) {
    result.C_r = distributed(reduced_velocity_forces(in), places, comm);
    petsc::check(
        MatSetOption(result.C_r, MAT_SYMMETRIC, velocity.is_symmetric ? PETSC_TRUE : PETSC_FALSE));
  }
  result.K_r = distributed(model.K, places, comm);
}

}  // namespace

void make_transformation(Inside& in)
{
  Result& result = *in.result;
  if (result.T) return;
  const std::vector<int> places = places_of(in);
  if (in.output && !in.problem) {
    result.T = chosen_rows(in, places);
    return;
  }
  petsc::Matrix whole = whole_transformation(in.set_up->body, result.reduction.Q_CB, places);
  if (!in.problem) {
    result.T = std::move(whole);
    return;
  }
  const cyclic::SectorHarmonic& harmonic = in.problem->harmonic;
  if (in.output) static_cast<void>(checked_output(in));
  if (harmonic.Y) result.T_y = phase_transformation(in, harmonic.Y, whole);
  result.T = phase_transformation(in, harmonic.X, whole);
}

Eigen::MatrixXd reduced_velocity_forces(const Inside& in)
{
  const auto& [C, is_symmetric] = in.set_up->velocity;
  Eigen::MatrixXd C_r =
      reduce::project_form(in.result->reduction.Q_CB, reduce::split(C, in.set_up->body.dofs));
  if (is_symmetric) C_r = (0.5 * (C_r + C_r.transpose())).eval();
  return C_r;
}

}  // namespace chladni::plugin

using namespace chladni::plugin;  // NOLINT(google-build-using-namespace)

// After CMSSolve only.
#define CMSCheckSolved(cms)                                                               \
  PetscCheck((cms)->inside->result, PetscObjectComm((PetscObject)(cms)), PETSC_ERR_ORDER, \
             "Call CMSSolve() first")

PetscErrorCode CMSGetReducedOperators(CMS cms, Mat* K, Mat* M, Mat* C)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  CMSCheckSolved(cms);
  PetscCall(guarded((PetscObject)cms, __func__, [&] { make_reduced_operators(*cms->inside); }));
  const Result& result = *cms->inside->result;
  if (K) *K = result.K_r;
  if (M) *M = result.M_r;
  if (C) *C = result.C_r;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetTransformation(CMS cms, Mat* T)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscAssertPointer(T, 2);
  CMSCheckSolved(cms);
  PetscCall(guarded((PetscObject)cms, __func__, [&] { make_transformation(*cms->inside); }));
  *T = cms->inside->result->T;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetDimensions(CMS cms, PetscInt* nmasters, PetscInt* nmodes)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  const Inside& in = *cms->inside;
  if (nmasters) *nmasters = in.set_up ? static_cast<PetscInt>(in.set_up->body.masters.size()) : 0;
  if (nmodes)
    *nmodes = in.result ? static_cast<PetscInt>(in.result->reduction.model.omega.size()) : 0;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetFrequencies(CMS cms, PetscInt* n, const PetscReal* f[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  CMSCheckSolved(cms);
  if (n) *n = static_cast<PetscInt>(cms->inside->result->f_Hz.size());
  if (f) *f = cms->inside->result->f_Hz.data();
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetErrors(CMS cms, PetscInt* n, const PetscReal* eta2[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  CMSCheckSolved(cms);
  if (n) *n = static_cast<PetscInt>(cms->inside->result->reduction.certificate.eta2.size());
  if (eta2) *eta2 = cms->inside->result->reduction.certificate.eta2.data();
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetRounding(CMS cms, PetscInt* n, const PetscReal* rounding[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  CMSCheckSolved(cms);
  if (n) *n = static_cast<PetscInt>(cms->inside->result->reduction.certificate.rounding.size());
  if (rounding) *rounding = cms->inside->result->reduction.certificate.rounding.data();
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetErrorBounds(CMS cms, PetscInt* n, const PetscReal* bounds[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  CMSCheckSolved(cms);
  if (n) *n = static_cast<PetscInt>(cms->inside->result->reduction.certificate.bounds.size());
  if (bounds) *bounds = cms->inside->result->reduction.certificate.bounds.data();
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetQuality(CMS cms, CMSQuality* quality)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscAssertPointer(quality, 2);
  CMSCheckSolved(cms);
  *quality = cms->inside->result->quality;
  PetscFunctionReturn(0);
}

// A CMS of sectors: what CMSSetCyclic says, and the harmonic as matrices.

using namespace chladni::plugin;  // NOLINT(google-build-using-namespace)

PetscErrorCode CMSSetCyclic(CMS cms, PetscInt count, IS low, IS high, PetscInt b,
                            const PetscReal rotation[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscValidLogicalCollectiveInt(cms, count, 2);
  if (count == 0) {
    PetscCall(CMSReset(cms));
    cms->inside->sectors.reset();
    PetscFunctionReturn(0);
  }
  PetscValidHeaderSpecific(low, IS_CLASSID, 3);
  PetscValidHeaderSpecific(high, IS_CLASSID, 4);
  PetscCheckSameComm(cms, 1, low, 3);
  PetscCheckSameComm(cms, 1, high, 4);
  PetscValidLogicalCollectiveInt(cms, b, 5);
  PetscCheck(b > 0, PetscObjectComm((PetscObject)cms), PETSC_ERR_ARG_OUTOFRANGE,
             "Block size %" PetscInt_FMT
             " of the rotation; give the components of a node, or 1 and no rotation",
             b);
  PetscCall(CMSReset(cms));
  PetscCall(guarded((PetscObject)cms, __func__, [&] {
    Sectors sectors{.count = static_cast<int>(count),
                    .low = reference<chladni::petsc::IndexSet>(low),
                    .high = reference<chladni::petsc::IndexSet>(high),
                    .R = Eigen::MatrixXd::Identity(b, b)};
    for (PetscInt i = 0; rotation && i < b * b; ++i) sectors.R(i / b, i % b) = rotation[i];
    cms->inside->sectors = std::move(sectors);
  }));
  PetscFunctionReturn(0);
}

PetscErrorCode CMSSetHarmonic(CMS cms, PetscInt n)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscValidLogicalCollectiveInt(cms, n, 2);
  if (n != cms->inside->harmonic) PetscCall(CMSReset(cms));
  cms->inside->harmonic = n;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetHarmonic(CMS cms, PetscInt* n)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscAssertPointer(n, 2);
  *n = cms->inside->harmonic;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetHarmonicOperators(CMS cms, Mat* K, Mat* M, Mat* C)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(guarded((PetscObject)cms, __func__, [&] { made_problem(cms); }));
  const Operators& operators = cms->inside->problem->operators;
  if (K) *K = operators.K;
  if (M) *M = operators.M;
  if (C) *C = operators.velocity.C;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetHarmonicCoordinates(CMS cms, Mat* X, Mat* Y)
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCall(guarded((PetscObject)cms, __func__, [&] { made_problem(cms); }));
  if (X) *X = cms->inside->problem->harmonic.X;
  if (Y) *Y = cms->inside->problem->harmonic.Y;
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetHarmonicInterface(CMS cms, PetscInt* n, const PetscInt* rows[],
                                       const PetscInt* phases[])
{
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCheck(cms->inside->set_up && cms->inside->problem, PetscObjectComm((PetscObject)cms),
             PETSC_ERR_ORDER, "Call CMSSetCyclic() and CMSSetUp() first");
  const HarmonicMasters& masters = cms->inside->problem->masters;
  if (n) *n = static_cast<PetscInt>(masters.rows.size());
  if (rows) *rows = masters.rows.data();
  if (phases) *phases = masters.phases.data();
  PetscFunctionReturn(0);
}

PetscErrorCode CMSGetHarmonicTransformation(CMS cms, Mat* T_x, Mat* T_y)
{
  Mat T = nullptr;
  PetscFunctionBegin;
  PetscValidHeaderSpecific(cms, CMS_CLASSID, 1);
  PetscCheck(cms->inside->sectors, PetscObjectComm((PetscObject)cms), PETSC_ERR_ORDER,
             "Call CMSSetCyclic() first");
  PetscCall(CMSGetTransformation(cms, &T));
  if (T_x) *T_x = T;
  if (T_y) *T_y = cms->inside->result->T_y;
  PetscFunctionReturn(0);
}
