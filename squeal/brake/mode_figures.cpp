#include "squeal/brake/mode_figures.hpp"

#include <algorithm>
#include <cmath>

#include "linear/dense/orthogonal_factor.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Index;

/// Parts of equal width of the radius; fewer where the picture has few points.
constexpr int parts_max = 16;
/// A part is looked at when it has so many points for each coefficient.
constexpr int points_per_coefficient = 4;
/// Amplitudes below this part of the largest one have no sign.
constexpr double still = 0.05;
/// Of motion in the plane, from which on nodal circles of the other one say nothing.
constexpr double mostly_in_plane = 0.5;

std::optional<double> in_plane_of(const mbs_export::ModalBody& body, Index mode)
{
  if (!body.mass_integrals) return std::nullopt;
  const auto& S = body.mass_integrals->products;
  const double plane = S[0](mode, mode) + S[1](mode, mode), axis = S[2](mode, mode);
  return plane + axis > 0.0 ? std::optional(plane / (plane + axis)) : std::nullopt;
}

/// Points of a picture by their distance from the axis.
struct Parts {
  std::vector<std::vector<Index>> points;
};

Parts parts_of(const mbs_export::Picture& picture, int diameters)
{
  const Eigen::VectorXd r = picture.positions.leftCols<2>().rowwise().norm();
  const double from = r.minCoeff(), to = r.maxCoeff();
  const auto needed = Index{points_per_coefficient} * (2 * diameters + 1);
  const auto n = std::clamp<Index>(r.size() / needed, 1, parts_max);
  Parts parts{std::vector<std::vector<Index>>(static_cast<std::size_t>(n))};
  for (Index i = 0; i < r.size(); ++i) {
    const auto at = static_cast<Index>((r[i] - from) / (to - from) * double(n));
    parts.points[static_cast<std::size_t>(std::clamp<Index>(at, 0, n - 1))].push_back(i);
  }
  std::erase_if(parts.points, [&](const auto& of) { return std::ssize(of) < 2 * diameters + 1; });
  return parts;
}

/// (a, b) of u_z = a cos(d theta) + b sin(d theta) by least squares over the points of a part.
Eigen::Vector2d amplitude(const mbs_export::Picture& picture, const std::vector<Index>& points,
                          Index mode, int d)
{
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const Index i : points) {
    const double theta = d * std::atan2(picture.positions(i, 1), picture.positions(i, 0));
    const Eigen::Vector2d wave{std::cos(theta), std::sin(theta)};
    A += wave * wave.transpose();
    right += picture.transformation(3 * i + 2, mode) * wave;
  }
  if (d == 0) return {right[0] / A(0, 0), 0.0};
  return linear::least_squares(A, right);
}

int circles_of(const mbs_export::Picture& picture, Index mode, int diameters)
{
  std::vector<Eigen::Vector2d> amplitudes;
  for (const std::vector<Index>& points : parts_of(picture, diameters).points)
    amplitudes.push_back(amplitude(picture, points, mode, diameters));
  if (amplitudes.empty()) return 0;
  const Eigen::Vector2d largest =
      *std::ranges::max_element(amplitudes, {}, [](const Eigen::Vector2d& a) { return a.norm(); });
  int circles = 0;
  double last = 0.0;
  for (const Eigen::Vector2d& a : amplitudes) {
    const double along = a.dot(largest);
    if (std::abs(along) <= still * largest.squaredNorm()) continue;
    circles += along * last < 0.0 ? 1 : 0;
    last = along;
  }
  return circles;
}

}  // namespace

std::vector<ModeFigure> mode_figures(const mbs_export::ModalBody& body,
                                     const std::vector<int>& diameters)
{
  const bool has_picture =
      body.picture.positions.rows() > 0 && body.picture.transformation.cols() == body.n_modes();
  std::vector<ModeFigure> figures;
  for (Index i = 0; i < body.n_modes(); ++i) {
    ModeFigure figure{.in_plane = in_plane_of(body, i)};
    if (has_picture && figure.in_plane.value_or(0.0) < mostly_in_plane)
      figure.circles = circles_of(body.picture, i, diameters[static_cast<std::size_t>(i)]);
    figures.push_back(figure);
  }
  return figures;
}

}  // namespace chladni::squeal
