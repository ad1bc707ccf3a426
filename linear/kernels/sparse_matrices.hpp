#pragma once

#include <string>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// A matrix as plain AIJ: a reference if it is plain AIJ, else a converted copy. PETSc's variants
/// of AIJ (aijperm, aijsell) and its block formats store their entries elsewhere.
/// @note   Collective.
petsc::Matrix as_aij(Mat A);

/// A plain AIJ matrix in whose rows columns ascend: the same one if they do, else a copy, in which
/// what stands twice is added up, as MatMult does. MatCreateSeqAIJWithArrays takes rows as they
/// are.
/// @note   Collective.
petsc::Matrix with_ascending_rows(petsc::Matrix A);

/// The diagonal of a square matrix. PETSc 3.18 looks through half of each row for it.
/// @note   Collective.
petsc::Vector diagonal(Mat A);

/// K - sigma M, symmetric and not marked definite.
/// @note   Collective.
petsc::Matrix shifted(Mat K, Mat M, double sigma);

/// What the ranks have at rows that may be those of others.
/// @param rows  global numbers
/// @param own   a value for each row of this rank
/// @return one for each of `rows`
/// @note   Collective.
std::vector<double> values_at(const std::vector<PetscInt>& rows, std::vector<double> own,
                              MPI_Comm comm);

/// Some rows and columns of a sparse matrix in any order, each on the rank that has it already.
/// PETSc 3.18's MatCreateSubMatrix wants those of several ranks in ascending order.
/// @param A        AIJ; any other type is converted
/// @param rows     global rows, on the rank that owns them
/// @param columns  global columns, on the rank that owns them; not twice the same
/// @param folder   for the arrays, in a file of each rank, where they take no memory while nobody
///                 multiplies by them; empty: they are in memory
/// @note   Collective.
/// @throws chladni::Error on all ranks when one has no room for it.
petsc::Matrix own_submatrix(Mat A, IS rows, IS columns, const std::string& folder = {});

}  // namespace chladni::linear
