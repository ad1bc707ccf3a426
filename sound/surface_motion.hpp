#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "sound/exterior.hpp"
#include "sound/outline.hpp"

namespace chladni::sound {

/// Cubic B-splines on [0, length] with equal intervals.
class Splines {
 public:
  Splines(double length, int n_intervals);

  int size() const { return n_intervals_ + 3; }
  /// Values of all splines at s; s outside the interval is moved to its nearest end.
  Eigen::RowVectorXd values(double s) const;
  /// Derivatives of all splines by s, at the same s.
  Eigen::RowVectorXd slopes(double s) const;

 private:
  Eigen::RowVectorXd evaluate(double s, int derivative) const;

  double length_;
  int n_intervals_;
};

/// Even or odd function of the angle around the axis: cos(n phi) or sin(n phi).
enum class Parity { cosine, sine };

/// Displacement of the modes on the body's surface. The displacements at the nodes of the body's
/// picture are fitted by splines along each middle line and Fourier series around the axis;
/// material normals remain normal to the middle surface, and nodes of solids beside it are fitted
/// by what their normal has there. Nodes that belong to no piece of the
/// middle surface but lie between two, such as those of vanes, are inner nodes: they do not
/// radiate.
class SurfaceMotion {
 public:
  /// Fits the modes.
  /// @param modes      0-based numbers of the body's modes
  /// @param harmonics  circumferential harmonics n of the Fourier series
  /// @throws chladni::Error when the body has no picture, when one of its nodes is outside the
  ///         outline, and when a middle line has too few nodes.
  SurfaceMotion(const mbs_export::ModalBody& body, const ThickBody& thick,
                const std::vector<int>& modes, const std::vector<int>& harmonics);

  const std::vector<int>& harmonics() const { return harmonics_; }

  /// Normal displacement at points of a meridian: amplitude of cos(n phi) or sin(n phi) for the
  /// i-th harmonic n.
  /// @return [n_points x n_modes] m per unit of q
  Eigen::MatrixXd on_meridian(const BodySurface& surface, std::size_t i, Parity parity) const;

  /// Normal displacement at points of the surface in space.
  /// @return [n_points x n_modes] m per unit of q
  Eigen::MatrixXd in_space(const BodySurface& surface) const;

  /// Relative root mean square of the nodal displacements that the fit leaves out.
  /// @return [n_modes]
  const Eigen::VectorXd& residual() const { return residual_; }

  /// Number of inner nodes.
  int inner_nodes() const { return inner_nodes_; }

  /// Whether all middle lines are in the plane z = 0 and move only along the axis, so that the
  /// sound field is antisymmetric about that plane.
  bool antisymmetric() const { return antisymmetric_; }

 private:
  /// [3 x n_modes] u_r, u_t, u_z of each mode.
  using Amplitudes = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  struct Line {
    Splines splines;
    /// For u_r, u_t, u_z: [n_functions n_splines x n_modes] with the functions cos and sin of each
    /// harmonic.
    std::array<Eigen::MatrixXd, 3> coefficients;
  };

  Amplitudes on_line(const Line& line, const Eigen::RowVectorXd& B, std::size_t function) const;
  Amplitudes displacement(const Place& place, double r, std::size_t i, Parity parity) const;

  std::vector<int> harmonics_;
  std::vector<MidLine> mid_;
  double hub_radius_;  ///< inner end of the innermost line, m
  std::vector<Line> lines_;
  Eigen::VectorXd residual_;
  int inner_nodes_ = 0;
  bool antisymmetric_ = false;
};

}  // namespace chladni::sound
