#include "linear/kernels/storage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/lanczos/block_lanczos.hpp"
#include "linear/solver_options.hpp"
#include "matrices.hpp"

namespace chladni::linear {
namespace {

namespace fs = std::filesystem;

/// What `work` says to be wrong.
template <typename Work>
std::string complaint(const Work& work)
{
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

/// Files without a name that this process has mapped.
std::size_t n_scratch_maps()
{
  std::ifstream maps("/proc/self/maps");
  const std::string folder = fs::temp_directory_path().string();
  std::size_t n = 0;
  for (std::string line; std::getline(maps, line);)
    n += line.find(folder) != std::string::npos && line.ends_with("(deleted)") ? 1 : 0;
  return n;
}

TEST(Scratch, KeepsAMatrixInAFileWithoutAName)
{
  const fs::path folder =  // of this rank alone
      fs::temp_directory_path() / ("chladni_scratch_" + std::to_string(getpid()));
  fs::create_directory(folder);
  const petsc::Matrix A = testing::diagonal(6, [](PetscInt i) { return 1.0 + i; });
  const petsc::Matrix X = large_dense(A, 3, folder.string());
  petsc::check(MatZeroEntries(X));
  add_sparse_product(A, Eigen::MatrixXd::Ones(6, 3), X);  // row i is 1 + i
  const petsc::Matrix Y = large_dense(A, 3, "");
  petsc::check(MatCopy(X, Y, SAME_NONZERO_PATTERN));
  EXPECT_TRUE(inner_product(X, Y).isApprox(91.0 * Eigen::MatrixXd::Ones(3, 3)));
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove_all(folder);
}

TEST(Scratch, MultipliesByAMatrixThatWasMovedThere)
{
  const auto band = [] {
    return testing::matrix(20, 5, [](PetscInt i) {
      testing::Row row;
      for (PetscInt j = std::max<PetscInt>(0, i - 2); j <= std::min<PetscInt>(19, i + 2); ++j)
        row.push_back({j, 1.0 + double(i * j)});
      return row;
    });
  };
  const petsc::Matrix A = band();
  const std::size_t n_before = n_scratch_maps();
  petsc::IndexSet all;
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  petsc::check(ISCreateStride(PETSC_COMM_WORLD, last - first, first, 1, all.put()));
  const petsc::Matrix moved = own_submatrix(A, all, all, fs::temp_directory_path().string());
  EXPECT_EQ(n_scratch_maps(), n_before + 1);
  PetscBool is_equal = PETSC_FALSE, is_known = PETSC_FALSE, is_symmetric = PETSC_FALSE;
  petsc::check(MatEqual(A, moved, &is_equal));
  EXPECT_TRUE(is_equal);
  petsc::check(MatIsSymmetricKnown(moved, &is_known, &is_symmetric));
  EXPECT_TRUE(is_known && is_symmetric);
  const petsc::Matrix X = large_dense(A, 3, "");
  petsc::check(MatSetRandom(X, nullptr));
  EXPECT_EQ(gram(sparse_product(A, X)), gram(sparse_product(moved, X)));
}

TEST(Scratch, GivesBlockLanczosTheSameVectors)
{
  const int n = 60;
  const petsc::Matrix M = testing::diagonal(n, [](PetscInt) { return 1.0; });
  const BlockSolve solve = [&](Mat B, Mat X) {
    petsc::check(MatCopy(B, X, SAME_NONZERO_PATTERN));
    PetscInt first = 0, last = 0;
    petsc::Vector inverse;
    petsc::check(MatCreateVecs(M, inverse.put(), nullptr));
    petsc::check(VecGetOwnershipRange(inverse, &first, &last));
    for (PetscInt i = first; i < last; ++i)
      petsc::check(VecSetValue(inverse, i, 1.0 / (1.0 + i), INSERT_VALUES));
    petsc::check(VecAssemblyBegin(inverse));
    petsc::check(VecAssemblyEnd(inverse));
    petsc::check(MatDiagonalScale(X, inverse, nullptr));
  };
  const auto pairs = [&](const std::string& folder) {
    BlockLanczos lanczos(solve, M, {.n_pairs = 0, .block_size = 4, .scratch = folder});
    lanczos.converge(10);
    return gram(lanczos.vectors(0, 10));
  };
  EXPECT_EQ(pairs(""), pairs(fs::temp_directory_path().string()));
}

TEST(Scratch, SaysThatAFolderIsNotThere)
{
  const petsc::Matrix A = testing::diagonal(3, [](PetscInt i) { return 1.0 + i; });
  const auto said = [](const char* folder) {
    petsc::check(PetscOptionsSetValue(nullptr, "-scratch_test_scratch", folder));
    const std::string answer = complaint(
        [] { read_solver_options(PETSC_COMM_WORLD, {.petsc = {.prefix = "scratch_test_"}}); });
    petsc::check(PetscOptionsClearValue(nullptr, "-scratch_test_scratch"));
    return answer;
  };
  EXPECT_EQ(said("/tmp"), "nothing");
  EXPECT_THAT(said("/no/such/folder"),
              ::testing::HasSubstr("-scratch_test_scratch /no/such/folder: files cannot be"));
  EXPECT_THAT(complaint([&] { large_dense(A, 2, "/no/such/folder"); }),
              ::testing::HasSubstr("no room"));
}

TEST(ColumnsAtATime, AreFewerWhereTheyAreLong)
{
  const auto n_for = [](PetscInt rows, PetscInt most) {
    petsc::Matrix A;
    petsc::check(MatCreateConstantDiagonal(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE,
                                           rows * petsc::size(PETSC_COMM_WORLD),
                                           rows * petsc::size(PETSC_COMM_WORLD), 1.0, A.put()));
    return columns_at_a_time(A, most);
  };
  EXPECT_EQ(n_for(10, 32), 32);
  EXPECT_EQ(n_for(1'000'000, 32), 16);
  EXPECT_EQ(n_for(5'000'000, 32), 8);
  EXPECT_EQ(n_for(1'000'000, 64), 32);
  EXPECT_EQ(n_for(100'000'000, 64), 16);
}

}  // namespace
}  // namespace chladni::linear
