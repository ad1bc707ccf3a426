#include <gtest/gtest.h>
#include <slepceps.h>

#include "common/petsc.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "linear/log_event.hpp"
#include "plugin/chladni_cms.h"

namespace chladni::reduce {
namespace {

/// From SlepcInitialize to SlepcFinalize; a process may have several.
class Session {
 public:
  Session()
  {
    SlepcInitialize(nullptr, nullptr, nullptr, nullptr);
    PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  }
  ~Session() { SlepcFinalize(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

TEST(SecondSession, KnowsTheCholeskyTypesAndTheEventsAgain)
{
  for (int session = 0; session < 3; ++session) {
    const Session of_slepc;
    linear::register_cholesky_types();
    for (const char* type : {linear::supernodal, linear::mumps_metis}) {
      PetscBool is_known = PETSC_FALSE;
      petsc::check(
          MatSolverTypeGet(type, MATSEQAIJ, MAT_FACTOR_CHOLESKY, &is_known, nullptr, nullptr));
      EXPECT_TRUE(is_known) << type << " in session " << session;
    }
    {
      const linear::LogEvent event(linear::Event::ordering);
    }
    PetscLogEvent id = -1;
    petsc::check(PetscLogEventGetId("CMSOrdering", &id));
    EXPECT_GE(id, 0) << "in session " << session;
  }
}

TEST(SecondSession, KnowsThePluginAgain)
{
  for (int session = 0; session < 3; ++session) {
    const Session of_slepc;
    petsc::check(CMSInitializePackage());
    petsc::check(CMSRegisterEPS());
    petsc::EigenSolver eps;
    petsc::check(EPSCreate(PETSC_COMM_WORLD, eps.put()));
    EXPECT_EQ(EPSSetType(eps, "blocklanczos"), 0) << "in session " << session;
    CMS cms = nullptr;
    EXPECT_EQ(CMSCreate(PETSC_COMM_WORLD, &cms), 0) << "in session " << session;
    petsc::check(CMSDestroy(&cms));
  }
}

}  // namespace
}  // namespace chladni::reduce

/// PETSc ends MPI with its first session unless somebody else began it.
int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  MPI_Init(&argc, &argv);
  const int failed = RUN_ALL_TESTS();
  MPI_Finalize();
  return failed;
}
