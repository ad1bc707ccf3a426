#include "sound/tone.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "sound/helmholtz_element.hpp"

namespace chladni::sound {

using Eigen::Index, Eigen::MatrixX3d, Eigen::MatrixXcd, Eigen::Vector3d, Eigen::VectorXcd;
using std::numbers::pi;

namespace {

using Complex = std::complex<double>;

constexpr double silent = 1e-9;

void add_field(Tone& tone, Exterior& exterior, const MatrixXcd& v_n)
{
  tone.fields.push_back(solve(exterior, v_n));
  tone.n_unknowns += exterior.n_unknowns();
  tone.memory_MiB = std::max(tone.memory_MiB, exterior.memory_MiB());
}

AirPlan plan_of(const Source& source, double omega)
{
  return plan_air(source.body.outline, source.air, omega, source.motion.antisymmetric());
}

/// Complex amplitudes of the velocities of the modes in one harmonic, [n_modes].
VectorXcd velocity_of(const Vibration& vibration, int h)
{
  return Complex(0.0, h * vibration.omega) * vibration.harmonics.col(h - 1);
}

Tone tone_of(const Source& source, const AirPlan& plan, const Vibration& vibration, int h)
{
  const SurfaceMotion& motion = source.motion;
  const double omega = h * vibration.omega;
  const VectorXcd velocity = velocity_of(vibration, h);
  const auto mesh = std::make_shared<const AirMesh>(air_around(source.body.outline, plan));
  Tone tone{h, omega, 0, mesh->n_elements(), 0.0, {}};
  if (!plan.meridian) {
    Exterior exterior(mesh, {source.air.medium, omega, 0}, plan.layer);
    add_field(tone, exterior, motion.in_space(exterior.surface()).cast<Complex>() * velocity);
    return tone;
  }
  for (std::size_t i = 0; i < motion.harmonics().size(); ++i) {
    Exterior exterior(mesh, {source.air.medium, omega, motion.harmonics()[i]}, plan.layer);
    MatrixXcd v_n(exterior.surface().n_points(), 2);
    v_n.col(0) =
        motion.on_meridian(exterior.surface(), i, Parity::cosine).cast<Complex>() * velocity;
    v_n.col(1) = motion.on_meridian(exterior.surface(), i, Parity::sine).cast<Complex>() * velocity;
    if (motion.harmonics()[i] == 0) v_n.col(1).setZero();
    add_field(tone, exterior, v_n);
  }
  return tone;
}

/// Directions all over the sphere, with the area that each stands for: enough to compare two
/// fields, not to integrate one. Their number around the axis is prime, so that no circumferential
/// harmonic below it is missed.
struct Directions {
  MatrixX3d e;
  Eigen::VectorXd weights;
};

Directions all_around()
{
  constexpr int n_heights = 12, n_angles = 13;
  const Quadrature heights = gauss_points(n_heights);  // z of the unit sphere is 2 t - 1
  Directions all{MatrixX3d(n_heights * n_angles, 3), Eigen::VectorXd(n_heights * n_angles)};
  for (int i = 0; i < n_heights * n_angles; ++i) {
    const double z = 2.0 * heights.points(i / n_angles, 0) - 1.0, r = std::sqrt(1.0 - z * z);
    const double phi = 2.0 * std::numbers::pi * (i % n_angles + 0.3) / n_angles;
    all.e.row(i) << r * std::cos(phi), r * std::sin(phi), z;
    all.weights[i] = heights.weights[i / n_angles];
  }
  return all;
}

using Evaluate = MatrixXcd (*)(const Field&, const MatrixX3d&);

/// The columns of a meridian plane joined by cos(n phi) and sin(n phi); points that follow one
/// another on a circle around the axis are evaluated once.
VectorXcd joined(const Tone& tone, const MatrixX3d& x, Evaluate evaluate)
{
  VectorXcd p = VectorXcd::Zero(x.rows());
  for (const Field& field : tone.fields) {
    if (field.mesh->dimension() == 3) {
      p += evaluate(field, x).col(0);
      continue;
    }
    MatrixXcd amplitude;
    double last_r = -1.0, last_z = 0.0;
    for (Index i = 0; i < x.rows(); ++i) {
      const double r = x.row(i).head<2>().norm(), z = x(i, 2);
      if (std::abs(r - last_r) > 1e-12 * r || z != last_z)
        amplitude = evaluate(field, Eigen::RowVector3d(r, 0.0, z));
      last_r = r;
      last_z = z;
      const double phase = field.wave.n * std::atan2(x(i, 1), x(i, 0));
      p[i] += amplitude(0, 0) * std::cos(phase) + amplitude(0, 1) * std::sin(phase);
    }
  }
  return p;
}

/// Harmonics whose surface moves at all.
std::vector<int> sounding_harmonics(const Vibration& vibration, int n_harmonics)
{
  std::vector<int> all;
  const double first = velocity_of(vibration, 1).norm();
  for (int h = 1; h <= std::min<Index>(n_harmonics, vibration.harmonics.cols()); ++h)
    if (velocity_of(vibration, h).norm() > silent * first) all.push_back(h);
  return all;
}

}  // namespace

std::vector<Tone> tones(const Source& source, const Vibration& vibration, int n_harmonics)
{
  std::vector<Tone> all;
  for (const int h : sounding_harmonics(vibration, n_harmonics))
    all.push_back(tone_of(source, plan_of(source, h * vibration.omega), vibration, h));
  return all;
}

void check_air(const Source& source, const Vibration& vibration, int n_harmonics)
{
  for (const int h : sounding_harmonics(vibration, n_harmonics))
    plan_of(source, h * vibration.omega);
}

std::optional<double> Accuracy::power() const
{
  if (!pressure) return std::nullopt;
  return *pressure * (2.0 + *pressure) + std::abs(balance);
}

Accuracy accuracy(const Source& source, const Vibration& vibration, const Tone& tone)
{
  Accuracy found{.balance = far_power(tone) / near_power(tone) - 1.0, .pressure = {}};
  const AirPlan plan = coarsened(plan_of(source, tone.omega));
  try {
    const Tone coarse = tone_of(source, plan, vibration, tone.h);
    const Directions around = all_around();
    const auto norm = [&](const VectorXcd& p) {
      return std::sqrt(p.cwiseAbs2().dot(around.weights));
    };
    const VectorXcd p = far_field(tone, around.e);
    found.pressure = norm(p - far_field(coarse, around.e)) / norm(p);
  } catch (const Error&) {  // a tone is worth more than what is known of its error
  }
  return found;
}

VectorXcd pressure_at(const Tone& tone, const MatrixX3d& x)
{
  return joined(tone, x, static_cast<Evaluate>(pressure_at));
}

VectorXcd far_field(const Tone& tone, const MatrixX3d& directions)
{
  return joined(tone, directions, static_cast<Evaluate>(far_field));
}

double near_power(const Tone& tone)
{
  double power = 0.0;
  for (const Field& field : tone.fields) power += complex_power(field).diagonal().real().sum();
  return power;
}

double far_power(const Tone& tone)
{
  double power = 0.0;
  for (const Field& field : tone.fields) power += far_power(field).sum();
  return power;
}

namespace {

constexpr int n_angles = 48;

/// Whether all corners of an element, which Gmsh lists first, are before the absorbing shell.
bool is_inner(const AirMesh& mesh, int element)
{
  for (Index i = 0; i <= mesh.dimension(); ++i) {
    Eigen::RowVectorXd x = mesh.positions.row(mesh.elements(element, i));
    x[mesh.dimension() - 1] -= mesh.centre;
    if (x.norm() > mesh.inner_radius * (1.0 + 1e-9)) return false;
  }
  return true;
}

/// Corners of the small triangles as places in an element whose nodes form a lattice; every third
/// line of it at order 6, every second at order 4.
std::vector<std::array<int, 3>> small_triangles(const LagrangeBasis& basis)
{
  const int p = basis.order(), step = p % 3 == 0 ? 3 : p % 2 == 0 ? 2 : 1, m = p / step;
  std::map<std::pair<int, int>, int> place;
  for (Index i = 0; i < basis.nodes().rows(); ++i) {
    place[{static_cast<int>(std::lround(p * basis.nodes()(i, 0))),
           static_cast<int>(std::lround(p * basis.nodes()(i, 1)))}] = static_cast<int>(i);
  }
  const auto at = [&](int i, int j) { return place.at({step * i, step * j}); };
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i + j < m; ++i) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + j + 2 <= m) triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return triangles;
}

/// Gives each node that is used a row of its own.
class Rows {
 public:
  int row(int node)
  {
    const auto [it, is_new] = row_.emplace(node, static_cast<int>(nodes.size()));
    if (is_new) nodes.push_back(node);
    return it->second;
  }
  std::vector<int> nodes;

 private:
  std::map<int, int> row_;
};

FieldPicture revolved(const Tone& tone)
{
  const Triangles plane = inner_triangles(*tone.fields[0].mesh);
  const Index n = plane.nodes.rows(), n_cells = plane.corners.rows();
  FieldPicture picture{Eigen::MatrixX3d(n * n_angles, 3), {}, Eigen::VectorXcd(n * n_angles)};
  for (int a = 0; a < n_angles; ++a) {
    const double phi = 2.0 * pi * a / n_angles;
    for (Index i = 0; i < n; ++i) {
      const double r = plane.nodes(i, 0);
      picture.points.row(a * n + i) << r * std::cos(phi), r * std::sin(phi), plane.nodes(i, 1);
      std::complex<double> p = 0.0;
      for (const Field& field : tone.fields) {
        const auto amplitude = field.p.row(plane.index[std::size_t(i)]);
        p += amplitude[0] * std::cos(field.wave.n * phi) +
             amplitude[1] * std::sin(field.wave.n * phi);
      }
      picture.pressure[a * n + i] = p;
    }
    const int next = (a + 1) % n_angles;
    for (Index c = 0; c < n_cells; ++c) {
      std::vector<int> wedge;
      for (const int slice : {a, next})
        for (Index k = 0; k < 3; ++k)
          wedge.push_back(static_cast<int>(slice * n + plane.corners(c, k)));
      picture.cells.push_back(std::move(wedge));
    }
  }
  return picture;
}

FieldPicture tetrahedra(const Field& field)
{
  const AirMesh& mesh = *field.mesh;
  FieldPicture picture;
  Rows rows;
  for (int e = 0; e < mesh.n_elements(); ++e) {
    if (!is_inner(mesh, e)) continue;
    std::vector<int> cell;
    for (Index k = 0; k < 4; ++k) cell.push_back(rows.row(mesh.elements(e, k)));
    picture.cells.push_back(std::move(cell));
  }
  picture.points = mesh.positions(rows.nodes, every);
  picture.pressure = field.p.col(0)(rows.nodes);
  return picture;
}

/// With the opposite field below z = 0.
FieldPicture mirrored(const FieldPicture& upper)
{
  const Index n = upper.points.rows();
  FieldPicture both{Eigen::MatrixX3d(2 * n, 3), upper.cells, Eigen::VectorXcd(2 * n)};
  both.points << upper.points, upper.points * Vector3d(1.0, 1.0, -1.0).asDiagonal();
  both.pressure << upper.pressure, -upper.pressure;
  for (std::vector<int> cell : upper.cells) {
    for (int& corner : cell) corner += static_cast<int>(n);
    both.cells.push_back(std::move(cell));
  }
  return both;
}

}  // namespace

Triangles inner_triangles(const AirMesh& mesh)
{
  const auto small = small_triangles(mesh.basis);
  Rows rows;
  std::vector<int> corners;
  for (int e = 0; e < mesh.n_elements(); ++e) {
    if (!is_inner(mesh, e)) continue;
    for (const auto& triangle : small)
      for (const int place : triangle) corners.push_back(rows.row(mesh.elements(e, place)));
  }
  Triangles triangles{
      mesh.positions(rows.nodes, every), rows.nodes, {static_cast<Index>(corners.size()) / 3, 3}};
  std::ranges::copy(corners, triangles.corners.data());
  return triangles;
}

FieldPicture field_picture(const Tone& tone)
{
  const Field& first = tone.fields[0];
  FieldPicture picture = first.mesh->dimension() == 3 ? tetrahedra(first) : revolved(tone);
  return first.mesh->half_space ? mirrored(picture) : picture;
}

}  // namespace chladni::sound
