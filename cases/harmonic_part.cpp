#include "cases/harmonic_part.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "cases/harmonic_certificate.hpp"
#include "cyclic/turn.hpp"
#include "reduce_export/reduced_system.hpp"

namespace chladni::cases {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// The motion of sector j, cos(j mu) x - sin(j mu) y, turned with it; `rows` vectors of three.
MatrixXd turned_motion(const cyclic::SectorMotion& motion, int order, int sector, int count)
{
  const double phase = 2.0 * std::numbers::pi * order * sector / count;
  MatrixXd rows = std::cos(phase) * motion.x - std::sin(phase) * motion.y;
  const Eigen::Matrix3d R = cyclic::turn_of_sector(sector, count);
  for (Index i = 0; i < rows.rows(); i += 3)
    rows.middleRows<3>(i) = (R * rows.middleRows<3>(i)).eval();
  return rows;
}

/// Adds what the rows of a part move at the attachment nodes, which stand ring by ring, sector by
/// sector, behind the nodes on the axis.
void add_interface_motion(MatrixXd& motion, const SectorModel& model, const HarmonicPart& part,
                          const std::vector<Index>& places)
{
  const int count = model.mesh.sectors.count;
  const std::vector<SectorNode>& nodes = model.interface.nodes;
  std::vector<Index> first(model.dofs.rings.size() + 1, std::ssize(model.dofs.axis));
  for (std::size_t r = 0; r < model.dofs.rings.size(); ++r)
    first[r + 1] = first[r] + model.dofs.rings[r].n_nodes;
  for (int sector = 0; sector < count; ++sector) {
    const MatrixXd rows = turned_motion(part.interface, part.order, sector, count);
    std::vector<Index> seen(first.size(), 0);
    Index n_axis = 0;
    for (Index i = 0; i < std::ssize(nodes); ++i) {
      const int ring = nodes[std::size_t(i)].ring;
      if (ring < 0 && sector > 0) continue;
      const Index own = ring < 0 ? 0 : model.dofs.rings[std::size_t(ring)].n_nodes / count;
      const Index node =
          ring < 0 ? n_axis++ : first[std::size_t(ring)] + sector * own + seen[std::size_t(ring)]++;
      motion(Eigen::seqN(6 * node, 6), places) += rows.middleRows<6>(6 * i);
    }
  }
}

}  // namespace

std::vector<std::vector<Index>> places_of(const std::vector<HarmonicPart>& parts, Index n_masters)
{
  struct Mode {
    double omega;
    std::size_t part;
    Index row;
  };
  std::vector<Mode> modes;
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (Index k = 0; k < parts[p].omega.size(); ++k) modes.push_back({parts[p].omega[k], p, k});
  std::ranges::stable_sort(modes, {}, &Mode::omega);
  std::vector<std::vector<Index>> places;
  for (const HarmonicPart& part : parts) {
    places.emplace_back(part.masters.begin(), part.masters.end());
    places.back().resize(part.masters.size() + std::size_t(part.omega.size()));
  }
  for (Index i = 0; i < std::ssize(modes); ++i) {
    const Mode& mode = modes[std::size_t(i)];
    places[mode.part][parts[mode.part].masters.size() + std::size_t(mode.row)] = n_masters + i;
  }
  return places;
}

mbs_export::ReducedSystem unfolded(mbs_export::ReducedSystem whole, const SectorModel& model,
                                   const std::vector<HarmonicPart>& parts,
                                   const std::vector<std::string>& fixed, double lambda_max)
{
  const Index n_m = whole.n_masters();
  const auto places = places_of(parts, n_m);
  const Index n = n_m + std::accumulate(parts.begin(), parts.end(), Index{0},
                                        [](Index sum, const HarmonicPart& part) {
                                          return sum + part.omega.size();
                                        });
  whole.K = whole.M = MatrixXd::Zero(n, n);
  if (!parts.empty() && parts.front().C.size() > 0) whole.C = MatrixXd::Zero(n, n);
  if (!parts.empty() && parts.front().H.size() > 0) whole.H = MatrixXd::Zero(n, n);
  whole.fixed_interface_frequencies = VectorXd(n - n_m);
  MatrixXd& motion = whole.ring_motion->displacements;
  motion = MatrixXd::Zero(6 * std::ssize(whole.attachment_nodes), n);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const HarmonicPart& part = parts[p];
    whole.K(places[p], places[p]) = part.K;
    whole.M(places[p], places[p]) = part.M;
    if (whole.C.size() > 0) whole.C(places[p], places[p]) = part.C;
    if (whole.H.size() > 0) whole.H(places[p], places[p]) = part.H;
    for (Index k = 0; k < part.omega.size(); ++k) {
      whole.fixed_interface_frequencies[places[p][part.masters.size() + std::size_t(k)] - n_m] =
          part.omega[k];
    }
    add_interface_motion(motion, model, part, places[p]);
  }
  whole.sector_harmonics = {.n_sectors = model.mesh.sectors.count,
                            .order = std::vector<int>(std::size_t(n), -1)};
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const Index i : places[p]) whole.sector_harmonics->order[std::size_t(i)] = parts[p].order;
  whole.certificate = whole_certificate(parts, fixed, lambda_max);
  return whole;
}

void add_picture(mbs_export::ReducedSystem& whole, const PictureNodes& chosen,
                 const SectorModel& model, std::vector<HarmonicPart>& parts)
{
  const int count = model.mesh.sectors.count;
  const auto n_nodes = std::ssize(chosen.nodes);
  mbs_export::Picture& picture = whole.picture;
  picture.positions.resize(n_nodes * count, 3);
  for (int sector = 0; sector < count; ++sector) {
    const Eigen::Matrix3d R = cyclic::turn_of_sector(sector, count);
    for (Index i = 0; i < n_nodes; ++i) {
      picture.positions.row(sector * n_nodes + i) =
          (R * model.system.dofs.position(chosen.nodes[std::size_t(i)])).transpose();
    }
    for (std::array<int, 4> cell : chosen.cells) {
      for (int& corner : cell) corner += static_cast<int>(sector * n_nodes);
      picture.cells.push_back(cell);
    }
  }
  auto places = places_of(parts, whole.n_masters());
  whole.picture_of_sectors = {.n_sectors = count, .n_coordinates = whole.K.rows(), .harmonics = {}};
  for (std::size_t p = 0; p < parts.size(); ++p) {
    cyclic::SectorMotion motion = std::exchange(parts[p].picture, {});
    whole.picture_of_sectors->harmonics.push_back({.order = parts[p].order,
                                                   .x = std::move(motion.x),
                                                   .y = std::move(motion.y),
                                                   .columns = std::move(places[p])});
  }
}

}  // namespace chladni::cases
