#pragma once

#include "mbs_export/fmu/modal_model.hpp"

namespace chladni::fmu::testing {

/// Three modes, one of them rigid, that damping couples, seen at two degrees of freedom.
inline ModalModel three_modes()
{
  ModalModel model{.token = "0123456789abcdef",
                   .omega = Eigen::Vector3d(0.0, 40.0, 900.0),
                   .C = Eigen::Matrix3d::Zero(),
                   .Phi = Eigen::MatrixXd(2, 3)};
  model.C << 0, 0, 0, 0, 3.0, 1.0, 0, 1.0, 20.0;
  model.Phi << 1.0, 0.5, -0.2, 1.0, -1.5, 0.7;
  return model;
}

}  // namespace chladni::fmu::testing
