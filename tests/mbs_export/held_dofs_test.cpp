#include "mbs_export/attachment_dofs.hpp"

#include <gtest/gtest.h>

#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

TEST(HeldDofs, OfAWholeNodeAreItsSixComponents)
{
  const HeldDofs held = held_dofs(test::wheel(), {"hub"});
  EXPECT_EQ(held.rows, (std::vector<int>{72, 73, 74, 75, 76, 77}));
  EXPECT_EQ(held.names.front(), "hub.x");
  EXPECT_EQ(held.names.back(), "hub.rz");
}

TEST(HeldDofs, OfOneComponentCoverEachNodeOfASetOnce)
{
  const HeldDofs held = held_dofs(test::wheel(), {"rim.z", "rim.z", "hub.ry"});
  ASSERT_EQ(held.rows.size(), 13u);
  EXPECT_EQ(held.rows[1], 8);
  EXPECT_EQ(held.names[1], "rim.z (node 101)");
  EXPECT_EQ(held.rows[12], 76);
}

TEST(HeldDofs, NameWhatExistsWhenAskedForSomethingElse)
{
  const ReducedSystem wheel = test::wheel();
  EXPECT_EQ(files::test::error_of([&] { held_dofs(wheel, {"axle"}); }),
            "no attachment set 'axle'; there is 'rim', 'hub'");
  EXPECT_EQ(files::test::error_of([&] { held_dofs(wheel, {"hub.w"}); }),
            "fixed: 'hub.w': no component 'w'; there is x, y, z, rx, ry, rz");
  ReducedSystem translations = wheel;
  std::erase_if(translations.masters, [](const MasterDof& dof) { return dof.component == 5; });
  EXPECT_EQ(files::test::error_of([&] {
              held_dofs(translations, {"hub.rz"});
            }).find("fixed: 'hub.rz': the reduced system has no component rz there"),
            0u);
}

TEST(HeldDofs, AreASupportWhateverWordsSayIt)
{
  const ReducedSystem wheel = test::wheel();
  EXPECT_TRUE(are_same_support(wheel, {"hub", "rim.z"}, {"rim.z", "hub"}));
  EXPECT_TRUE(are_same_support(wheel, {"hub"},
                               {"hub.rz", "hub.ry", "hub.rx", "hub.z", "hub.y", "hub.x", "hub.x"}));
  EXPECT_FALSE(are_same_support(wheel, {"hub"}, {"hub.x"}));
  EXPECT_FALSE(are_same_support(wheel, {"hub"}, {}));
  EXPECT_FALSE(are_same_support(wheel, {"hub.x"}, {"hub.y"}));
}

}  // namespace
}  // namespace chladni::mbs_export
