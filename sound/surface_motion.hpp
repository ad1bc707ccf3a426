#pragma once

#include <array>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "sound/body_surface.hpp"
#include "sound/splines.hpp"
#include "sound/thick_body.hpp"

namespace chladni::sound {

/// A function of the angle around the axis.
enum class Parity { cosine, sine };

/// What the modes of a body do at its surface. The displacements at the nodes of the body's picture
/// become splines along each middle line and Fourier series around the axis; material normals stay
/// normal to the middle surface. Nodes that are in none of the pieces but between two of them, such
/// as those of vanes, are inner ones: the air does not see them.
class SurfaceMotion {
 public:
  /// @param modes      0-based
  /// @param harmonics  circumferential harmonics n to look for
  /// @throws chladni::Error when the body has no picture, when a node of it is not in the outline,
  ///         and when a middle line has too few nodes.
  SurfaceMotion(const mbs_export::ModalBody& body, const ThickBody& thick,
                const std::vector<int>& modes, const std::vector<int>& harmonics);

  const std::vector<int>& harmonics() const { return harmonics_; }

  /// Normal displacement at points of a meridian: the amplitude of cos(n phi) or sin(n phi) for the
  /// i-th harmonic.
  /// @return [n_points x n_modes] m per unit of q
  Eigen::MatrixXd on_meridian(const BodySurface& surface, std::size_t i, Parity parity) const;

  /// Normal displacement at points of space.
  Eigen::MatrixXd in_space(const BodySurface& surface) const;

  /// [n_modes] part of the displacements at the nodes that splines and harmonics leave out, in the
  /// mean square, relative.
  const Eigen::VectorXd& residual() const { return residual_; }

  /// Number of inner nodes.
  int inner_nodes() const { return inner_nodes_; }

  /// All middle lines are in the plane z = 0 and move along the axis alone, so that the sound field
  /// is antisymmetric to it.
  bool antisymmetric() const { return antisymmetric_; }

 private:
  using Amplitudes = Eigen::Matrix<double, 3, Eigen::Dynamic>;  ///< u_r, u_t, u_z of each mode

  struct Line {
    Splines splines;
    /// u_r, u_t, u_z: [n_functions n_splines x n_modes], the functions cos and sin of each harmonic
    std::array<Eigen::MatrixXd, 3> coefficients;
  };

  Amplitudes on_line(const Line& line, const Eigen::RowVectorXd& B, std::size_t function) const;
  Amplitudes displacement(const Place& place, double r, std::size_t i, Parity parity) const;

  std::vector<int> harmonics_;
  std::vector<MidLine> mid_;
  double hub_radius_;  ///< where the innermost line begins, m
  std::vector<Line> lines_;
  Eigen::VectorXd residual_;
  int inner_nodes_ = 0;
  bool antisymmetric_ = false;
};

}  // namespace chladni::sound
