#include "cases/lent_motions.hpp"

#include <algorithm>

#include "cases/ranks.hpp"
#include "common/petsc.hpp"
#include "cyclic/sector_dofs.hpp"

namespace chladni::cases {

namespace {

using Eigen::Index, Eigen::MatrixXd;

/// Columns of the matrix, so that no count exceeds an int.
class ColumnType {
 public:
  explicit ColumnType(Index n_rows)
  {
    MPI_Type_contiguous(static_cast<int>(n_rows), MPI_DOUBLE, &type_);
    MPI_Type_commit(&type_);
  }
  ~ColumnType() { MPI_Type_free(&type_); }
  ColumnType(const ColumnType&) = delete;
  ColumnType& operator=(const ColumnType&) = delete;
  MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

}  // namespace

LentMotions::LentMotions(int count, int n_dofs, const HarmonicGroups& groups)
    : n_harmonics_(cyclic::n_harmonics(count)), n_dofs_(n_dofs), groups_(groups)
{}

LentMotions::~LentMotions()
{
  forget_below(n_harmonics_);
}

void LentMotions::lend(int order, int to)
{
  const cyclic::SectorMotion& motion = motions_.at(order);
  const ColumnType column(n_dofs_);
  for (const MatrixXd* phase : {&motion.x, &motion.y}) {
    MPI_Isend(phase->data(), static_cast<int>(phase->cols()), column.get(), to, order,
              PETSC_COMM_WORLD, &lent_[order].emplace_back());
  }
}

void LentMotions::borrow(int order)
{
  const int from = groups_.speaker(order);
  const ColumnType column(n_dofs_);
  cyclic::SectorMotion& motion = motions_[order];
  for (MatrixXd* phase : {&motion.x, &motion.y}) {
    MPI_Status status;
    int n_columns = 0;
    MPI_Probe(from, order, PETSC_COMM_WORLD, &status);
    MPI_Get_count(&status, column.get(), &n_columns);
    phase->resize(n_dofs_, n_columns);
    MPI_Recv(phase->data(), n_columns, column.get(), from, order, PETSC_COMM_WORLD,
             MPI_STATUS_IGNORE);
  }
}

void LentMotions::forget_below(int order)
{
  for (auto& [lent, requests] : lent_) {
    if (lent >= order) continue;
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    requests.clear();
  }
  std::erase_if(motions_, [&](const auto& motion) { return motion.first < order; });
}

void LentMotions::exchange(int order, cyclic::SectorMotion motion)
{
  motions_.emplace(order, std::move(motion));
  for (int higher = order + 1; higher <= std::min(order + SectorMass::reach, n_harmonics_ - 1);
       ++higher)
    if (groups_.speaker(higher) != rank()) lend(order, groups_.speaker(higher));
  forget_below(order - SectorMass::reach);
  for (int lower = std::max(order - SectorMass::reach, 0); lower < order; ++lower)
    if (groups_.speaker(lower) != rank()) borrow(lower);
}

}  // namespace chladni::cases
