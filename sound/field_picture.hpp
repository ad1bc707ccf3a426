#pragma once

#include <array>
#include <vector>

#include "files/hdf5.hpp"
#include "sound/tone.hpp"

namespace chladni::sound {

/// The elements of a meridian plane before the absorbing shell, each cut into straight triangles.
struct Triangles {
  Eigen::MatrixXd nodes;         ///< [n x 2] m
  std::vector<int> index;        ///< [n] of these nodes in the mesh
  files::IntegerMatrix corners;  ///< [n_triangles x 3] rows of `nodes`
};

Triangles inner_triangles(const AirMesh& mesh);

/// A field around the body in linear cells: wedges of a meridian plane turned around the axis, or
/// tetrahedra; below z = 0 the image of a half space.
struct FieldPicture {
  Eigen::MatrixX3d points;              ///< m
  std::vector<std::vector<int>> cells;  ///< 6 corners of a wedge or 4 of a tetrahedron
  Eigen::VectorXcd pressure;            ///< [n_points] Pa
};

FieldPicture field_picture(const Tone& tone);

}  // namespace chladni::sound
