#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/files/hdf5.hpp"
#include "sound/air_plan.hpp"
#include "sound/field.hpp"
#include "sound/surface_motion.hpp"

namespace chladni::sound {

/// A periodic motion of a body in a frame that does not rotate, with the displacement
/// Re sum_h exp(i h omega t) sum_i harmonics(i, h - 1) shape_i.
struct Vibration {
  double speed;                ///< rotation speed of the disc, rad/s
  double omega;                ///< fundamental angular frequency, rad/s
  std::vector<int> modes;      ///< [n_modes] 0-based numbers of the body's modes
  Eigen::MatrixXcd harmonics;  ///< [n_modes x n_harmonics] m kg^(1/2)
};

/// The sound of one harmonic of a vibration.
struct Tone {
  int h;              ///< multiple of the fundamental frequency
  double omega;       ///< angular frequency of the tone, rad/s
  int n_unknowns;     ///< sum over its systems of equations
  int n_elements;     ///< number of elements of its mesh
  double memory_MiB;  ///< memory of its largest factor
  /// For each circumferential harmonic a field with the columns cos(n phi) and sin(n phi), or one
  /// field in space.
  std::vector<Field> fields;
};

/// The body whose sound is computed, with the air around it.
struct Source {
  const ThickBody& body;
  const SurfaceMotion& motion;  ///< surface motion of the vibration's modes, in their order
  const AirOptions& air;
};

/// Computes the tones of the harmonics up to `n_harmonics`. Harmonics whose modal velocity is below
/// 1e-9 of that of the first are rounding errors and left out.
/// @throws chladni::Error from plan_air.
/// @note MPI must be initialised.
std::vector<Tone> tones(const Source& source, const Vibration& vibration, int n_harmonics);

/// Checks the air mesh of all these tones without solving for them.
/// @throws chladni::Error from plan_air.
void check_air(const Source& source, const Vibration& vibration, int n_harmonics);

/// Estimated relative error of a tone due to the elements of the air, from the same tone with
/// larger elements. Reflections of the absorbing layer are not included.
struct Accuracy {
  double balance;  ///< far-field power over the power at the surface, minus 1
  /// Relative error of the pressure, as a mean square over all far-field directions; absent when
  /// Gmsh cannot make the coarser mesh.
  std::optional<double> pressure;

  /// Relative error of the power at the surface. With the error e of the pressure the far-field
  /// power, its mean square, has the error 2 e + e^2, to which |balance| is added.
  std::optional<double> power() const;
};

/// Estimates the error of a tone by solving once more with the mesh of `coarsened`.
/// @note MPI must be initialised.
Accuracy accuracy(const Source& source, const Vibration& vibration, const Tone& tone);

/// Complex pressure at points in space.
/// @param x  [n x 3] m
/// @return [n] Pa
/// @throws chladni::Error when a point is inside the body.
Eigen::VectorXcd pressure_at(const Tone& tone, const Eigen::MatrixX3d& x);

/// Far-field amplitude p R exp(ikR) for R to infinity.
/// @param directions  [n x 3] unit vectors
/// @return [n] Pa m
Eigen::VectorXcd far_field(const Tone& tone, const Eigen::MatrixX3d& directions);

/// Radiated power at the surface, and from the far field, W.
double near_power(const Tone& tone);
double far_power(const Tone& tone);

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
