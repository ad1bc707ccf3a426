#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/petsc.hpp"

namespace chladni {
namespace {

#ifndef CHLADNI_SANITIZED  // whose malloc ends the process

TEST(OutOfMemory, IsToldForWhatItIs)
{
  double* values = nullptr;
  try {
    petsc::check(PetscMalloc1(std::size_t(1) << 50, &values));
    FAIL() << "so much memory";
  } catch (const petsc::Failure& failure) {
    EXPECT_EQ(failure.code, PETSC_ERR_MEM);
    EXPECT_THAT(failure.what(), testing::HasSubstr("out of memory"));
  }
}

#endif

}  // namespace
}  // namespace chladni
