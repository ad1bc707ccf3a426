#include <gtest/gtest.h>
#include <slepcsys.h>

/// Tests that need PETSc run on several ranks; each rank reports its own failures.
int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  SlepcInitialize(&argc, &argv, nullptr, nullptr);
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  int failed = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  PetscPopErrorHandler();
  SlepcFinalize();
  return failed;
}
