#include "mbs_export/fmu/modal_model.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "common/error.hpp"
#include "models.hpp"

namespace chladni::fmu {
namespace {

TEST(ModalModel, ComesBackBitByBit)
{
  const ModalModel model = testing::three_modes();
  const ModalModel again = unpacked(packed(model));
  EXPECT_EQ(again.token, model.token);
  EXPECT_EQ(again.omega, model.omega);
  EXPECT_EQ(again.C, model.C);
  EXPECT_EQ(again.Phi, model.Phi);
}

TEST(ModalModel, MayHaveNoDamping)
{
  ModalModel model = testing::three_modes();
  model.C.resize(0, 0);
  EXPECT_EQ(unpacked(packed(model)).C.size(), 0);
}

TEST(ModalModel, ThatIsCutOffOrTooLongIsRefused)
{
  const std::string bytes = packed(testing::three_modes());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THROW(unpacked(bytes.substr(0, n)), Error) << n << " bytes";
  EXPECT_THROW(unpacked(bytes + "x"), Error);
}

TEST(ModalModel, WithDamagedNumbersIsRefused)
{
  std::string bytes = packed(testing::three_modes());
  const std::size_t counts = bytes.find("cdef") + 4;
  for (int i = 0; i < 3; ++i) {
    std::string damaged = bytes;
    damaged[counts + 8 * std::size_t(i) + 7] = '\x7F';
    EXPECT_THROW(unpacked(damaged), Error) << "count " << i;
  }
  ModalModel model = testing::three_modes();
  model.Phi(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(unpacked(packed(model)), Error);
}

}  // namespace
}  // namespace chladni::fmu
