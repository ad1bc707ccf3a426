#pragma once

#include <memory>
#include <optional>

#include "sound/air_mesh.hpp"

namespace chladni::sound {

/// Finds the element of an air mesh that contains a point, to interpolate nodal fields.
class Locator {
 public:
  explicit Locator(std::shared_ptr<const AirMesh> mesh);

  /// Interpolated values of nodal fields. Below z = 0 of a half space they are those of the mirror
  /// point with opposite sign.
  /// @param x  m
  /// @param p  [n_nodes x n_fields]
  /// @return [n_fields]
  /// @throws chladni::Error when no element contains the point, so that it is inside the body.
  Eigen::RowVectorXcd value(const Eigen::Vector3d& x, const Eigen::MatrixXcd& p) const;

 private:
  std::optional<Eigen::RowVectorXd> reference_place(int element, const Eigen::RowVectorXd& x) const;

  std::shared_ptr<const AirMesh> mesh_;
  Eigen::MatrixXd low_, high_;  ///< [n_elements x dimension] bounding boxes of the elements
};

}  // namespace chladni::sound
