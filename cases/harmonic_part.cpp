#include "cases/harmonic_part.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

#include "reduce_export/reduced_system.hpp"

namespace chladni::cases {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// The motion of sector j, cos(j mu) x - sin(j mu) y, turned with it; `rows` vectors of three.
MatrixXd turned_motion(const cyclic::SectorMotion& motion, int order, int sector, int count)
{
  const double angle = 2.0 * std::numbers::pi * sector / count, phase = order * angle;
  MatrixXd rows = std::cos(phase) * motion.x - std::sin(phase) * motion.y;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
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

/// The counts of all harmonics as one. Where no harmonic misses a mode, all together have as many
/// as the model has below the lowest of their limits.
/// @param lambda  of the model, all of a part
mbs_export::ModeCount whole_count(
    const std::vector<HarmonicPart>& parts, reduce::EigenvalueCount reduce::Certificate::*which,
    const std::function<std::vector<double>(const HarmonicPart&)>& lambda)
{
  double least = std::numeric_limits<double>::infinity(), largest = 0.0;
  mbs_export::ModeCount sum;
  for (const HarmonicPart& part : parts) {
    const reduce::EigenvalueCount& count = part.certificate.*which;
    if (!(count.sigma > 0.0)) return {};
    least = std::min(least, count.sigma);
    largest = std::max(largest, count.sigma);
    sum.expected += count.expected;
    sum.found += count.found;
  }
  sum.up_to = std::sqrt(largest);
  if (sum.missing() > 0) return sum;
  sum = {.up_to = std::sqrt(least), .expected = 0, .found = 0};
  for (const HarmonicPart& part : parts) {
    const double sigma = (part.certificate.*which).sigma;
    const auto is_above = [&](double value) { return value >= least && value < sigma; };
    sum.found += (part.certificate.*which).found -
                 static_cast<int>(std::ranges::count_if(lambda(part), is_above));
  }
  sum.expected = sum.found;
  return sum;
}

/// Up to which eigenvalue no harmonic misses one; 0 where one was not counted.
double complete_up_to(const std::vector<HarmonicPart>& parts)
{
  double least = std::numeric_limits<double>::infinity();
  for (const HarmonicPart& part : parts) {
    const reduce::EigenvalueCount& complete = part.certificate.complete;
    least = std::min(least, complete.expected == complete.found ? complete.sigma : 0.0);
  }
  return least;
}

/// The certificate of all harmonics together. Each place has at least the eigenvalue of its place
/// among the lower ends lambda / (1 + bound) of all harmonics, as far as none misses one.
mbs_export::Certificate whole_certificate(const std::vector<HarmonicPart>& parts,
                                          const std::vector<std::string>& fixed, double lambda_max)
{
  struct Entry {
    double lambda, eta2, estimate, rounding, bound;
  };
  std::vector<Entry> entries;
  mbs_export::Certificate whole;
  whole.fixed = fixed;
  bool has_errors = true;
  for (const HarmonicPart& part : parts) {
    const reduce::Certificate& c = part.certificate;
    whole.n_rigid += c.n_zero;
    whole.rigid_residual = std::max(whole.rigid_residual, c.zero_energy);
    whole.condition = std::max(whole.condition, c.condition);
    has_errors = has_errors && c.eta2.size() == c.lambda.size();
    if (!has_errors) return whole;
    for (std::size_t i = 0; i < c.lambda.size(); ++i) {
      if (c.lambda[i] > lambda_max) continue;
      entries.push_back({c.lambda[i], c.eta2[i], c.estimates[i],
                         i < c.rounding.size() ? c.rounding[i] : 0.0,
                         i < c.bounds.size() ? c.bounds[i] : -1.0});
    }
  }
  std::ranges::stable_sort(entries, {}, &Entry::lambda);
  const auto column = [&](double Entry::*member, std::size_t n) {
    VectorXd values(static_cast<Index>(n));
    for (std::size_t i = 0; i < n; ++i) values[static_cast<Index>(i)] = entries[i].*member;
    return values;
  };
  const double complete = complete_up_to(parts);
  std::vector<double> lower;
  for (const Entry& e : entries) {
    if (e.bound < 0.0 || e.lambda > complete) break;
    lower.push_back(e.lambda / (1.0 + e.bound));
  }
  std::ranges::sort(lower);
  for (std::size_t i = 0; i < lower.size(); ++i)
    entries[i].bound = std::max(0.0, entries[i].lambda / lower[i] - 1.0);
  whole.frequencies = column(&Entry::lambda, entries.size()).cwiseSqrt();
  whole.eta2 = column(&Entry::eta2, entries.size());
  whole.estimates = column(&Entry::estimate, entries.size());
  whole.rounding = column(&Entry::rounding, entries.size());
  whole.bounds = column(&Entry::bound, lower.size());
  const auto of_model = [](const HarmonicPart& part) { return part.certificate.lambda; };
  const auto of_modes = [](const HarmonicPart& part) {
    const VectorXd lambda = part.omega.cwiseAbs2();
    return std::vector<double>(lambda.begin(), lambda.end());
  };
  whole.fixed_interface = whole_count(parts, &reduce::Certificate::fixed_interface, of_modes);
  whole.range = whole_count(parts, &reduce::Certificate::range, of_model);
  whole.complete = whole_count(parts, &reduce::Certificate::complete, of_model);
  return whole;
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
  whole.fixed_interface_frequencies = VectorXd(n - n_m);
  MatrixXd& motion = whole.ring_motion->displacements;
  motion = MatrixXd::Zero(6 * std::ssize(whole.attachment_nodes), n);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const HarmonicPart& part = parts[p];
    whole.K(places[p], places[p]) = part.K;
    whole.M(places[p], places[p]) = part.M;
    if (whole.C.size() > 0) whole.C(places[p], places[p]) = part.C;
    for (Index k = 0; k < part.omega.size(); ++k) {
      whole.fixed_interface_frequencies[places[p][part.masters.size() + std::size_t(k)] - n_m] =
          part.omega[k];
    }
    add_interface_motion(motion, model, part, places[p]);
  }
  whole.certificate = whole_certificate(parts, fixed, lambda_max);
  return whole;
}

mbs_export::Picture unfolded_picture(const PictureNodes& chosen, const SectorModel& model,
                                     const std::vector<HarmonicPart>& parts, Index n_masters)
{
  const auto places = places_of(parts, n_masters);
  const int count = model.mesh.sectors.count;
  const auto n_nodes = std::ssize(chosen.nodes);
  Index n = n_masters;
  for (const HarmonicPart& part : parts) n += part.omega.size();
  mbs_export::Picture picture;
  picture.positions.resize(n_nodes * count, 3);
  picture.transformation = MatrixXd::Zero(3 * n_nodes * count, n);
  for (int sector = 0; sector < count; ++sector) {
    const double angle = 2.0 * std::numbers::pi * sector / count;
    const Eigen::AngleAxisd R(angle, Eigen::Vector3d::UnitZ());
    for (Index i = 0; i < n_nodes; ++i) {
      picture.positions.row(sector * n_nodes + i) =
          (R * model.system.dofs.position(chosen.nodes[std::size_t(i)])).transpose();
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
      picture.transformation(Eigen::seqN(3 * sector * n_nodes, 3 * n_nodes), places[p]) +=
          turned_motion(parts[p].picture, parts[p].order, sector, count);
    }
    for (std::array<int, 4> cell : chosen.cells) {
      for (int& corner : cell) corner += static_cast<int>(sector * n_nodes);
      picture.cells.push_back(cell);
    }
  }
  return picture;
}

}  // namespace chladni::cases
