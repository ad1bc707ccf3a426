#include "mbs_export/responses/frequency_responses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mbs_export/responses/response_options.hpp"

namespace chladni::mbs_export {
namespace {

constexpr int along_z = 2;

/// Four nodes on a circle.
struct Ring {
  std::vector<AttachmentNode> nodes;
  std::vector<AttachmentSet> sets{{"track", {0, 1, 2, 3}}};

  Ring()
  {
    for (int i = 0; i < 4; ++i) {
      const double angle = i * std::numbers::pi / 2.0;
      nodes.push_back({.number = 11 + i, .position = {std::cos(angle), std::sin(angle), 0.0}});
    }
  }
  NamedNodes named() const { return {nodes, sets}; }
};

TEST(ResponseDofs, ShareALoadAndGiveEachNodeAnOutput)
{
  const Ring ring;
  const auto loads = response_loads(ring.named(), {{.at = "track", .components = {along_z}}});
  ASSERT_EQ(loads.size(), 1U);
  EXPECT_EQ(loads[0].name, "track.z");
  EXPECT_EQ(loads[0].nodes, (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(point_of(ring.named(), loads[0]).node, 0);
  const auto outputs =
      response_outputs(ring.named(), {{.at = "track", .components = {0, along_z}}});
  ASSERT_EQ(outputs.size(), 8U);
  EXPECT_EQ(outputs[3].name, "track.z (node 12)");
}

TEST(ResponseDofs, TakeTheNearestNode)
{
  const Ring ring;
  const std::array<double, 3> near{0.1, -0.9, 0.0}, between{0.7, 0.7, 0.0};
  const auto loads =
      response_loads(ring.named(), {{.at = "track", .components = {along_z}, .near = near}});
  EXPECT_EQ(loads[0].nodes, std::vector{3});
  EXPECT_EQ(loads[0].name, "track.z (node 14)");
  EXPECT_THROW(
      response_loads(ring.named(), {{.at = "track", .components = {along_z}, .near = between}}),
      ResponseOptionError);
}

TEST(ResponseDofs, RefuseAMomentAboutTheNormalOfAShell)
{
  Ring ring;
  for (AttachmentNode& node : ring.nodes) node.drilling_axis = {0.0, 0.0, 1.0};
  const std::vector<ResponsePlace> twist{{.at = "track", .components = {5}}};
  EXPECT_THROW(response_loads(ring.named(), twist), ResponseOptionError);
  EXPECT_EQ(response_outputs(ring.named(), twist).size(), 4U);
}

}  // namespace
}  // namespace chladni::mbs_export
