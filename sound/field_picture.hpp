#pragma once

#include <array>
#include <vector>

#include "files/hdf5.hpp"
#include "sound/tone.hpp"

namespace chladni::sound {

/// The elements of a meridian plane inside the absorbing shell's inner radius, each divided into
/// straight triangles.
struct Triangles {
  Eigen::MatrixXd nodes;         ///< [n x 2] m
  std::vector<int> index;        ///< [n] number of each node in the mesh
  files::IntegerMatrix corners;  ///< [n_triangles x 3] rows of `nodes`
};

/// Divides the elements of a meridian mesh into triangles for pictures.
Triangles inner_triangles(const AirMesh& mesh);

/// A field around the body in linear cells: wedges, which are the triangles of a meridian plane
/// turned around the axis, or tetrahedra. A half space is completed by its mirror image below
/// z = 0.
struct FieldPicture {
  Eigen::MatrixX3d points;              ///< m
  std::vector<std::vector<int>> cells;  ///< 6 corners of a wedge or 4 of a tetrahedron
  Eigen::VectorXcd pressure;            ///< [n_points] Pa
};

/// The field of a tone inside the absorbing shell's inner radius, for pictures.
FieldPicture field_picture(const Tone& tone);

}  // namespace chladni::sound
