#include "sound/surface_motion.hpp"

#include <fmt/format.h>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/eigen_every.hpp"
#include "common/error.hpp"

namespace chladni::sound {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

namespace {

/// A node of the picture in cylindrical coordinates, and where it belongs.
struct Sample {
  Place place;
  double angle, radius;
  Index node;
};

/// Lateral displacement over the axial one, below which a disc counts as moving along its axis.
constexpr double lateral_limit = 1e-3;

/// The nodes of each line, and how many belong to none.
struct Samples {
  std::vector<std::vector<Sample>> of_line;
  int inner = 0;
};

/// @throws chladni::Error for a node that is neither in a piece nor between two.
Samples samples_of(const mbs_export::Picture& picture, const std::vector<MidLine>& lines)
{
  Samples samples{std::vector<std::vector<Sample>>(lines.size())};
  for (Index i = 0; i < picture.positions.rows(); ++i) {
    const Eigen::Vector3d x = picture.positions.row(i).transpose();
    const Vector2d rz(x.head<2>().norm(), x[2]);
    const Place place = nearest_place(lines, rz);
    const MidLine& line = lines[std::size_t(place.line)];
    const double distance = (line.from + place.s * line.tangent() - rz).norm();
    if (distance <= 0.51 * line.thickness) {
      samples.of_line[std::size_t(place.line)].push_back({place, std::atan2(x[1], x[0]), rz[0], i});
    } else if (lies_between(lines, rz)) {
      ++samples.inner;
    } else {
      throw Error(fmt::format(
          "sound: the node of the body at (r, z) = ({:.6g}, {:.6g}) m is {:.3g} m away from the "
          "nearest middle line, which is {:.3g} m thick, and not between two of them as a vane is; "
          "correct the outline of [sound]",
          rz[0], rz[1], distance, line.thickness));
    }
  }
  return samples;
}

/// Two nodes for each interval across, as if they were spread evenly over the surface.
int n_intervals(const MidLine& line, std::size_t n_nodes)
{
  const double area = std::numbers::pi * (line.from[0] + line.to[0]) * line.length();
  const double spacing = std::sqrt(area / double(n_nodes));
  return std::clamp(static_cast<int>(0.5 * line.length() / spacing), 1, 60);
}

/// [n_samples x n_functions n_splines]
MatrixXd design(const std::vector<Sample>& samples, const std::vector<int>& harmonics,
                const Splines& splines)
{
  const Index n_splines = splines.size();
  MatrixXd A(static_cast<Index>(samples.size()),
             2 * static_cast<Index>(harmonics.size()) * n_splines);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto row = static_cast<Index>(k);
    const Eigen::RowVectorXd B = splines.values(samples[k].place.s);
    for (std::size_t i = 0; i < harmonics.size(); ++i) {
      const double phase = harmonics[i] * samples[k].angle;
      const Index first = 2 * static_cast<Index>(i) * n_splines;
      A.row(row).segment(first, n_splines) = std::cos(phase) * B;
      A.row(row).segment(first + n_splines, n_splines) = std::sin(phase) * B;
    }
  }
  return A;
}

/// dw/ds and dw/dphi at samples, [n_samples x n_modes].
struct Slopes {
  MatrixXd along, around;
};

/// @param w  coefficients of a function as `design` has them
Slopes slopes(const std::vector<Sample>& samples, const std::vector<int>& harmonics,
              const Splines& splines, const MatrixXd& w)
{
  const auto n = static_cast<Index>(samples.size());
  Slopes found{MatrixXd::Zero(n, w.cols()), MatrixXd::Zero(n, w.cols())};
  const Index n_splines = splines.size();
  for (Index k = 0; k < n; ++k) {
    const Sample& sample = samples[std::size_t(k)];
    const Eigen::RowVectorXd B = splines.values(sample.place.s),
                             B_s = splines.slopes(sample.place.s);
    for (std::size_t i = 0; i < harmonics.size(); ++i) {
      const double phase = harmonics[i] * sample.angle, c = std::cos(phase), s = std::sin(phase);
      const auto cosine = w.middleRows(2 * Index(i) * n_splines, n_splines);
      const auto sine = w.middleRows((2 * Index(i) + 1) * n_splines, n_splines);
      found.along.row(k) += B_s * (c * cosine + s * sine);
      found.around.row(k) += harmonics[i] * (B * (c * sine - s * cosine));
    }
  }
  return found;
}

/// Of nodes at a distance zeta from the middle line, the displacement of its point: u + zeta grad
/// w.
void take_to_middle(std::array<MatrixXd, 3>& u, const std::vector<Sample>& samples,
                    const MidLine& line, const Slopes& of_w)
{
  const Vector2d t = line.tangent();
  for (Index k = 0; k < u[0].rows(); ++k) {
    const Sample& sample = samples[std::size_t(k)];
    const double zeta = sample.place.zeta, r = sample.radius;
    u[0].row(k) += zeta * t[0] * of_w.along.row(k);
    u[2].row(k) += zeta * t[1] * of_w.along.row(k);
    if (r > 0.0) u[1].row(k) += zeta / r * of_w.around.row(k);
  }
}

/// u_r, u_t, u_z of the samples, [n_samples x n_modes] each.
std::array<MatrixXd, 3> cylindrical(const mbs_export::Picture& picture,
                                    const std::vector<Sample>& samples,
                                    const std::vector<int>& modes)
{
  const auto n = static_cast<Index>(samples.size()), n_modes = static_cast<Index>(modes.size());
  std::array<MatrixXd, 3> u{MatrixXd(n, n_modes), MatrixXd(n, n_modes), MatrixXd(n, n_modes)};
  for (Index k = 0; k < n; ++k) {
    const Sample& sample = samples[std::size_t(k)];
    const MatrixXd x = picture.transformation.middleRows(3 * sample.node, 3)(every, modes);
    const double c = std::cos(sample.angle), s = std::sin(sample.angle);
    u[0].row(k) = c * x.row(0) + s * x.row(1);
    u[1].row(k) = c * x.row(1) - s * x.row(0);
    u[2].row(k) = x.row(2);
  }
  return u;
}

void check_rank(const MidLine& line, Index n_samples, Index rank, Index needed)
{
  if (rank >= needed) return;
  throw Error(fmt::format(
      "sound: the {} nodes of the body's picture between (r, z) = ({:.4g}, {:.4g}) and ({:.4g}, "
      "{:.4g}) m are too few for the {} coefficients of its motion; set pictures = \"all\" in "
      "[reduce]",
      n_samples, line.from[0], line.from[1], line.to[0], line.to[1], needed));
}

double smallest_radius(const std::vector<MidLine>& lines)
{
  double r = lines[0].from[0];
  for (const MidLine& line : lines) r = std::min({r, line.from[0], line.to[0]});
  return r;
}

bool flat(const std::vector<MidLine>& lines)
{
  return std::ranges::all_of(
      lines, [](const MidLine& line) { return line.from[1] == 0.0 && line.to[1] == 0.0; });
}

}  // namespace

SurfaceMotion::SurfaceMotion(const mbs_export::ModalBody& body, const ThickBody& thick,
                             const std::vector<int>& modes, const std::vector<int>& harmonics)
    : harmonics_(harmonics), mid_(thick.lines), hub_radius_(smallest_radius(thick.lines))
{
  const mbs_export::Picture& picture = body.picture;
  if (picture.positions.rows() == 0) {
    throw Error(
        "sound: the body has no displacements of its surface; set pictures = \"vertices\" or "
        "\"all\" in [reduce] and make it again");
  }
  const auto [samples, inner] = samples_of(picture, mid_);
  inner_nodes_ = inner;
  const auto n_modes = static_cast<Index>(modes.size());
  VectorXd rest = VectorXd::Zero(n_modes), whole = rest, lateral = rest;
  const bool has_mean = std::ranges::find(harmonics_, 0) != harmonics_.end();
  for (std::size_t i = 0; i < mid_.size(); ++i) {
    const auto n = static_cast<Index>(samples[i].size());
    Line line{Splines(mid_[i].length(), n_intervals(mid_[i], samples[i].size() + 1)), {}};
    const MatrixXd A = design(samples[i], harmonics_, line.splines);
    const Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver(A);
    check_rank(mid_[i], n, solver.rank(), A.cols() - (has_mean ? line.splines.size() : 0));
    auto u = cylindrical(picture, samples[i], modes);
    const auto is_beside = [](const Sample& one) { return one.place.zeta != 0.0; };
    if (std::ranges::any_of(samples[i], is_beside)) {
      const Vector2d nu = mid_[i].normal();
      const MatrixXd w = solver.solve(nu[0] * u[0] + nu[1] * u[2]);
      take_to_middle(u, samples[i], mid_[i], slopes(samples[i], harmonics_, line.splines, w));
    }
    for (std::size_t d = 0; d < 3; ++d) {
      line.coefficients[d] = solver.solve(u[d]);
      const MatrixXd fitted = A * line.coefficients[d];
      rest += (fitted - u[d]).colwise().squaredNorm().transpose();
      whole += u[d].colwise().squaredNorm().transpose();
      if (d < 2)
        lateral += fitted.colwise().squaredNorm().transpose();  // without what faces differ
    }
    lines_.push_back(std::move(line));
  }
  residual_ = rest.cwiseQuotient(whole).cwiseSqrt();
  antisymmetric_ = flat(mid_) && mirrored(thick.outline) &&
                   (lateral.array() < lateral_limit * lateral_limit * whole.array()).all();
}

/// u on the middle line for one function of the angle, or along it with the slopes of the splines.
SurfaceMotion::Amplitudes SurfaceMotion::on_line(const Line& line, const Eigen::RowVectorXd& B,
                                                 std::size_t function) const
{
  Amplitudes u(3, residual_.size());
  const Index n = line.splines.size();
  for (Index d = 0; d < 3; ++d)
    u.row(d) = B * line.coefficients[std::size_t(d)].middleRows(Index(function) * n, n);
  return u;
}

/// u - zeta (dw/ds tangent + 1/r dw/dphi e_phi) with w = u . normal
SurfaceMotion::Amplitudes SurfaceMotion::displacement(const Place& place, double r, std::size_t i,
                                                      Parity parity) const
{
  const Line& line = lines_[std::size_t(place.line)];
  const MidLine& mid = mid_[std::size_t(place.line)];
  const Vector2d t = mid.tangent(), nu = mid.normal();
  const std::size_t own = 2 * i + (parity == Parity::sine),
                    other = 2 * i + (parity != Parity::sine);
  const Eigen::RowVectorXd B = line.splines.values(place.s);
  const auto w = [&](const Amplitudes& u) { return nu[0] * u.row(0) + nu[1] * u.row(2); };
  Amplitudes u = on_line(line, B, own);
  const Amplitudes u_s = on_line(line, line.splines.slopes(place.s), own);
  // d/dphi of cos is -n sin, of sin n cos: the slope comes from the other function.
  const double sign = parity == Parity::cosine ? 1.0 : -1.0;
  const Eigen::RowVectorXd dw_ds = w(u_s);
  const Eigen::RowVectorXd dw_dphi = sign * harmonics_[i] * w(on_line(line, B, other));
  u.row(0) -= place.zeta * t[0] * dw_ds;
  u.row(2) -= place.zeta * t[1] * dw_ds;
  if (r > 0.0) u.row(1) -= place.zeta / r * dw_dphi;
  return u;
}

MatrixXd SurfaceMotion::on_meridian(const BodySurface& surface, std::size_t i, Parity parity) const
{
  MatrixXd w = MatrixXd::Zero(surface.n_points(), residual_.size());
  for (Index k = 0; k < w.rows(); ++k) {
    const Vector2d x = surface.x.row(k).transpose();
    if (x[0] < hub_radius_) continue;  // its plug does not move
    const Amplitudes u = displacement(nearest_place(mid_, x), x[0], i, parity);
    w.row(k) = surface.normal(k, 0) * u.row(0) + surface.normal(k, 1) * u.row(2);
  }
  return w;
}

MatrixXd SurfaceMotion::in_space(const BodySurface& surface) const
{
  MatrixXd w = MatrixXd::Zero(surface.n_points(), residual_.size());
  for (Index k = 0; k < w.rows(); ++k) {
    const Vector2d x(surface.x.row(k).head<2>().norm(), surface.x(k, 2));
    if (x[0] < hub_radius_) continue;  // its plug does not move
    const double angle = std::atan2(surface.x(k, 1), surface.x(k, 0));
    const double c = std::cos(angle), s = std::sin(angle);
    const Eigen::RowVector3d n(c * surface.normal(k, 0) + s * surface.normal(k, 1),
                               c * surface.normal(k, 1) - s * surface.normal(k, 0),
                               surface.normal(k, 2));
    const Place place = nearest_place(mid_, x);
    for (std::size_t i = 0; i < harmonics_.size(); ++i) {
      w.row(k) +=
          std::cos(harmonics_[i] * angle) * (n * displacement(place, x[0], i, Parity::cosine));
      w.row(k) +=
          std::sin(harmonics_[i] * angle) * (n * displacement(place, x[0], i, Parity::sine));
    }
  }
  return w;
}

Splines::Splines(double length, int n_intervals) : length_(length), n_intervals_(n_intervals) {}

Eigen::RowVectorXd Splines::evaluate(double s, int derivative) const
{
  const double h = length_ / n_intervals_, x = std::clamp(s, 0.0, length_) / h;
  const int interval = std::min(static_cast<int>(x), n_intervals_ - 1);
  const double t = x - interval, u = 1.0 - t;
  Eigen::RowVectorXd B = Eigen::RowVectorXd::Zero(size());
  if (derivative == 0) {
    B.segment<4>(interval) << u * u * u, 3 * t * t * t - 6 * t * t + 4,
        3 * u * u * u - 6 * u * u + 4, t * t * t;
    return B / 6.0;
  }
  B.segment<4>(interval) << -u * u, 3 * t * t - 4 * t, -3 * u * u + 4 * u, t * t;
  return B / (2.0 * h);
}

Eigen::RowVectorXd Splines::values(double s) const
{
  return evaluate(s, 0);
}

Eigen::RowVectorXd Splines::slopes(double s) const
{
  return evaluate(s, 1);
}

}  // namespace chladni::sound
