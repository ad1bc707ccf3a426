#include "squeal/brake/ring_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.hpp"
#include "squeal/brake/pads.hpp"

namespace chladni::squeal {
namespace {

/// Heights of rings are known to this part of their radius.
constexpr double placement = 1e-6;

/// Heights of the lower and of the upper contact plane, m.
std::array<double, 2> plane_heights(const SquealOptions& options, double lower, double upper)
{
  if (options.planes->heights) return *options.planes->heights;
  const double middle = 0.5 * (lower + upper), half = 0.5 * options.thickness;
  return {middle - half, middle + half};
}

/// @param a, b  indices of the two rings, in any order, or twice the same one
RingPair pair_of(const SquealOptions& options, const std::vector<RingPlace>& rings, std::size_t a,
                 std::size_t b)
{
  if (!options.planes)
    return {.rings = {a, b}, .faces = faces_of_plate(options.thickness, rings[a].radius)};
  if (rings[a].height < rings[b].height) std::swap(a, b);
  const RingPlace &upper = rings[a], &lower = rings[b];
  if (a != b && upper.height - lower.height <= placement * upper.radius) {
    throw Error(
        fmt::format("[squeal] ring: \"{}\" and \"{}\" both lie at z = {:.6g} m; inboard and "
                    "outboard need rings "
                    "at two heights, or one ring for both: ring = \"{}\"",
                    upper.name, lower.name, upper.height, upper.name));
  }
  const auto [bottom, top] = plane_heights(options, lower.height, upper.height);
  const double half = 0.5 * (top - bottom);
  return {.rings = {a, b},
          .faces = {PadFace{upper.radius, half, top - upper.height},
                    PadFace{lower.radius, -half, bottom - lower.height}}};
}

std::size_t index_of(const std::vector<RingPlace>& rings, const std::string& name, std::size_t pad)
{
  const auto at = std::ranges::find(rings, name, &RingPlace::name);
  if (at == rings.end()) {
    throw Error(
        fmt::format("[squeal] pads[{}].grid.rings: the disc has no ring \"{}\"", pad, name));
  }
  return static_cast<std::size_t>(at - rings.begin());
}

}  // namespace

RingPair study_pair(const SquealOptions& options, const std::vector<RingPlace>& rings)
{
  const bool two = options.planes && !options.planes->opposite_ring.empty();
  return pair_of(options, rings, 0, two ? 1 : 0);
}

std::vector<RingPair> ring_pairs(const SquealOptions& options, const PadGrid& grid,
                                 const std::vector<RingPlace>& rings, std::size_t pad)
{
  if (grid.rings.empty()) return {study_pair(options, rings)};
  std::vector<RingPair> pairs;
  for (std::size_t i = 0; i < grid.rings.size(); ++i) {
    const std::size_t one = index_of(rings, grid.rings[i], pad);
    const std::size_t other =
        grid.opposite_rings.empty() ? one : index_of(rings, grid.opposite_rings[i], pad);
    pairs.push_back(pair_of(options, rings, one, other));
  }
  return pairs;
}

}  // namespace chladni::squeal
