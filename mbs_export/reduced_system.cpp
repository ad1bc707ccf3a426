#include "mbs_export/reduced_system.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "common/eigen_every.hpp"
#include "common/error.hpp"

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXd;

const AttachmentSet& find_set(const ReducedSystem& reduced, const std::string& name)
{
  const auto found = std::ranges::find(reduced.sets, name, &AttachmentSet::name);
  if (found != reduced.sets.end()) return *found;
  std::vector<std::string> names;
  for (const AttachmentSet& set : reduced.sets) names.push_back("'" + set.name + "'");
  throw Error(fmt::format("no attachment set '{}'; there is {}", name,
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

Picture picture_in(const ReducedSystem& reduced, const Eigen::MatrixXd& T)
{
  const auto& [positions, cells, transformation] = reduced.picture;
  if (positions.rows() == 0) return {};
  if (reduced.picture_of_sectors)
    return {positions, cells, in_coordinates(*reduced.picture_of_sectors, T)};
  return {positions, cells, transformation * T};
}

namespace {

double angle_of_part(std::int64_t part, const SectorMotions& motions)
{
  return 2.0 * std::numbers::pi * double(part % motions.n_sectors) / motions.n_sectors;
}

MatrixXd in_phase(const MatrixXd& x, const MatrixXd& y, double phase)
{
  return std::cos(phase) * x - std::sin(phase) * y;
}

void turn(Eigen::Ref<MatrixXd> rows, double angle)
{
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (Index i = 0; i < rows.rows(); i += 3)
    rows.middleRows<3>(i) = (R * rows.middleRows<3>(i)).eval();
}

}  // namespace

SectorHarmonics in_coordinates(const SectorHarmonics& harmonics, const MatrixXd& M,
                               const MatrixXd& T)
{
  constexpr double round_off = 1e-9;
  const MatrixXd MT = M * T;
  SectorHarmonics of_T{.n_sectors = harmonics.n_sectors, .order = {}};
  for (Index j = 0; j < T.cols(); ++j) {
    Eigen::VectorXd energy = Eigen::VectorXd::Zero(harmonics.n_sectors / 2 + 1);
    for (Index i = 0; i < T.rows(); ++i)
      if (const int n = harmonics.order[std::size_t(i)]; n >= 0) energy[n] += T(i, j) * MT(i, j);
    Index largest = 0;
    const double most = energy.maxCoeff(&largest);
    const bool is_alone = std::abs(T.col(j).dot(MT.col(j)) - most) <= round_off * most;
    of_T.order.push_back(is_alone ? static_cast<int>(largest) : -1);
  }
  return of_T;
}

MatrixXd in_coordinates(const SectorMotions& motions, const MatrixXd& T_whole)
{
  const MatrixXd T = motions.T.size() > 0 ? motions.T * T_whole : T_whole;
  const Index n = motions.rows_of_sector();
  MatrixXd whole = MatrixXd::Zero(n * motions.n_sectors, T.cols());
  for (const SectorMotions::Harmonic& h : motions.harmonics) {
    const MatrixXd T_h = T(h.columns, every);
    const MatrixXd x = h.x * T_h, y = h.y * T_h;
    for (int j = 0; j < motions.n_sectors; ++j) {
      whole.middleRows(j * n, n) +=
          in_phase(x, y, angle_of_part(std::int64_t{h.order} * j, motions));
    }
  }
  for (int j = 0; j < motions.n_sectors; ++j)
    turn(whole.middleRows(j * n, n), angle_of_part(j, motions));
  return whole;
}

}  // namespace chladni::mbs_export
