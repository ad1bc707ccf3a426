#include "report/page/mode_looks.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "report/page/numbers.hpp"

namespace chladni::report {
namespace {

using Eigen::Index;

/// A share of motion and what it looks like.
struct Share {
  double part = 0.0;
  const ModeLook* look = nullptr;
};

/// The shares of all looks that modes of the shape have, the modes of a pair as one.
std::vector<Share> shares_of(const Eigen::VectorXcd& shape, const std::vector<int>& mode_numbers,
                             const ModeLooks& looks)
{
  std::map<std::pair<int, int>, Share> shares;
  for (std::size_t i = 0; i < mode_numbers.size(); ++i) {
    const auto found = looks.find(mode_numbers[i]);
    if (found == looks.end()) continue;
    const ModeLook& look = found->second;
    Share& share = shares[{look.diameters, look.circles.value_or(-1)}];
    share.part += std::norm(shape[static_cast<Index>(i)]);
    share.look = &look;
  }
  std::vector<Share> all;
  for (const auto& [key, share] : shares) all.push_back(share);
  return all;
}

/// The dominant harmonic around the ring of (u_r, u_t), the displacements of its nodes in the plane
/// in a mode; none when they do not move.
std::optional<int> waves_in_plane(const mbs_export::ModalBody& body,
                                  const mbs_export::ContactRing& ring, Index mode)
{
  const Index n = ring.angles.size();
  if (std::ssize(ring.nodes) != n) return std::nullopt;
  std::optional<int> dominant;
  double largest = 0.0;
  for (int d = 0; d <= n / 2; ++d) {
    std::complex<double> u_r = 0.0, u_t = 0.0;
    for (Index i = 0; i < n; ++i) {
      const Index row = 6 * Index{ring.nodes[static_cast<std::size_t>(i)]};
      if (row + 6 > body.attachment_modes.rows()) return std::nullopt;
      const double x = body.attachment_modes(row, mode), y = body.attachment_modes(row + 1, mode),
                   c = std::cos(ring.angles[i]), s = std::sin(ring.angles[i]);
      const std::complex<double> wave = std::polar(1.0, -d * ring.angles[i]);
      u_r += (c * x + s * y) * wave;
      u_t += (c * y - s * x) * wave;
    }
    // A harmonic d > 0 stands for two terms of the series, d and -d.
    const double size = (d > 0 ? 2.0 : 1.0) * (std::norm(u_r) + std::norm(u_t));
    if (size > largest * (1.0 + 1e-9)) {
      largest = size;
      dominant = d;
    }
  }
  return dominant;
}

}  // namespace

ModeLooks mode_looks(const squeal::Disc& disc, const mbs_export::ModalBody& body)
{
  ModeLooks looks;
  const std::vector<int> diameters = squeal::nodal_diameters(disc);
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    const squeal::ModeFigure figure =
        i < disc.figures.size() ? disc.figures[i] : squeal::ModeFigure{};
    looks[disc.mode_numbers[i]] = {
        .diameters = diameters[i], .circles = figure.circles, .in_plane = figure.in_plane};
  }
  const auto ring =
      std::ranges::find(body.rings, disc.rings.front().name, &mbs_export::ContactRing::name);
  if (ring == body.rings.end()) return looks;
  for (const int number : disc.still)
    if (const auto waves = waves_in_plane(body, *ring, number - 1))
      looks[number] = {.diameters = *waves, .circles = {}, .in_plane = 1.0};
  return looks;
}

std::vector<Json::Member> look_members(const ModeLook& look)
{
  return {{"diameters", look.diameters},
          {"circles", look.circles ? Json(*look.circles) : Json()},
          {"in_plane", look.in_plane ? rounded(*look.in_plane) : Json()}};
}

Json motion_looks(const squeal::EigenvalueMap& map, const ModeLooks& looks)
{
  if (map.shapes.empty() || map.mode_numbers.empty() || looks.empty()) return Json();
  std::vector<Json> all;
  for (Index j = 0; j < map.lambda.cols(); ++j) {
    Index i = 0;
    map.lambda.col(j).real().maxCoeff(&i);
    const Eigen::VectorXcd shape = map.shapes[static_cast<std::size_t>(i)].col(j);
    const std::vector<Share> shares = shares_of(shape, map.mode_numbers, looks);
    const auto largest = std::ranges::max_element(shares, {}, &Share::part);
    all.push_back(largest == shares.end() ? Json() : Json::object(look_members(*largest->look)));
  }
  return Json::array(all);
}

}  // namespace chladni::report
