#pragma once

#include <memory>
#include <optional>

#include "sound/air_mesh.hpp"

namespace chladni::sound {

/// Finds points in a mesh of air.
class Locator {
 public:
  explicit Locator(std::shared_ptr<const AirMesh> mesh);

  /// Values of nodal fields at a point of space, interpolated; below z = 0 of a half space they are
  /// the opposite of those above.
  /// @param x  m
  /// @param p  [n_nodes x n_fields]
  /// @throws chladni::Error when the point is in no element, i.e. in the body.
  Eigen::RowVectorXcd value(const Eigen::Vector3d& x, const Eigen::MatrixXcd& p) const;

 private:
  std::optional<Eigen::RowVectorXd> reference_place(int element, const Eigen::RowVectorXd& x) const;

  std::shared_ptr<const AirMesh> mesh_;
  Eigen::MatrixXd low_, high_;  ///< [n_elements x dimension] boxes that hold the elements
};

}  // namespace chladni::sound
