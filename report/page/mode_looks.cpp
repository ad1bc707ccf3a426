#include "report/page/mode_looks.hpp"

#include <algorithm>
#include <cmath>
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

}  // namespace

ModeLooks mode_looks(const squeal::Disc& disc)
{
  ModeLooks looks;
  const std::vector<int> diameters = squeal::nodal_diameters(disc);
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    const squeal::ModeFigure figure =
        i < disc.figures.size() ? disc.figures[i] : squeal::ModeFigure{};
    looks[disc.mode_numbers[i]] = {
        .diameters = diameters[i], .circles = figure.circles, .in_plane = figure.in_plane};
  }
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
