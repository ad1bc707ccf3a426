#include "linear/cholesky/pivoting_fallback.hpp"

#include "linear/cholesky/mumps_factor.hpp"

namespace chladni::linear {

PivotingFallback::PivotingFallback(std::unique_ptr<CholeskyFactor> definite, MPI_Comm comm)
    : definite_(std::move(definite)), comm_(comm)
{}

void PivotingFallback::analyze(Mat A)
{
  pivoting_.reset();
  definite_->analyze(A);
  error_ = definite_->error();
}

void PivotingFallback::factorize(Mat A)
{
  pivoting_.reset();
  definite_->factorize(A);
  error_ = definite_->error();
  if (definite_->is_reliable()) return;
  if (must_be_definite) {
    error_ = MAT_FACTOR_NUMERIC_ZEROPIVOT;
    return;
  }
  definite_->release();
  pivoting_ = std::make_unique<MumpsFactor>(comm_, Definiteness::unknown);
  pivoting_->analyze(A);
  error_ = pivoting_->error();
  if (error_ == MAT_FACTOR_NOERROR && !memory_need(comm_).fits()) error_ = MAT_FACTOR_OUTMEMORY;
  if (error_ != MAT_FACTOR_NOERROR) return;
  pivoting_->factorize(A);
  error_ = pivoting_->error();
}

std::string PivotingFallback::description() const
{
  if (!pivoting_) return definite_->description();
  return pivoting_->description() + "; with pivoting, since the matrix is indefinite";
}

}  // namespace chladni::linear
