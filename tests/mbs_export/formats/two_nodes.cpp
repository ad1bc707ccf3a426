#include "two_nodes.hpp"

namespace chladni::mbs_export::test {

ReducedSystem two_nodes()
{
  ReducedSystem system{};
  system.title = "two nodes";
  system.attachment_nodes = {{-1, {1.0, -0.25, 1.0 / 3.0}}, {7, {0.0, 0.0, -2e-3}}};
  system.sets = {{"ends", {0, 1}}};
  system.masters = {{1, 2}, {0, 4}, {0, 2}};
  system.fixed_interface_frequencies = Eigen::Vector2d(200.0, 1000.0 / 3.0);
  system.K = Eigen::MatrixXd::Zero(5, 5);
  system.K.topLeftCorner<3, 3>() << 3.5e6, -1.2e5, -2.4e6, -1.2e5, 8.8e4, 6.5e4, -2.4e6, 6.5e4,
      9.9e6;
  system.K.diagonal().tail<2>() = system.fixed_interface_frequencies.cwiseAbs2();
  system.M = Eigen::MatrixXd::Identity(5, 5);
  system.M.topLeftCorner<3, 3>() << 2.0 / 3.0, 0.0, 1.0 / 6.0, 0.0, 1e-3, -1.0 / 70.0, 1.0 / 6.0,
      -1.0 / 70.0, 0.7;
  system.M.bottomLeftCorner<2, 3>() << 0.1, 0.02, 0.3, 0.0, -0.04, 0.5;
  system.M.topRightCorner<3, 2>() = system.M.bottomLeftCorner<2, 3>().transpose();
  return system;
}

}  // namespace chladni::mbs_export::test
