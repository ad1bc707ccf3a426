// Sums over the contact points of each pad: what is reported of a pad with a grid.
#include <algorithm>

#include "squeal/brake/pad_system.hpp"

namespace chladni::squeal {

std::vector<ContactResult<double>> by_pad(const PadSystem& pads,
                                          const std::vector<ContactResult<double>>& points)
{
  std::vector<ContactResult<double>> sums;
  std::vector<int> counts;
  const auto add = [](PadState<double>& sum, const PadState<double>& x) {
    sum.z += x.z;
    sum.z_dot += x.z_dot;
    sum.N += x.N;
    sum.slip_speed = std::min(sum.slip_speed, x.slip_speed);
    sum.S += x.S;
    sum.f_r += x.f_r;
    sum.f_t += x.f_t;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == 0 || pads.points[i].pad != pads.points[i - 1].pad) {
      sums.push_back(points[i]);
      counts.push_back(1);
      continue;
    }
    ++counts.back();
    add(sums.back().upper, points[i].upper);
    add(sums.back().lower, points[i].lower);
  }
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (PadState<double>* pad : {&sums[i].upper, &sums[i].lower}) {
      pad->z /= counts[i];
      pad->z_dot /= counts[i];
    }
  return sums;
}

}  // namespace chladni::squeal
