#pragma once

#include <map>
#include <optional>
#include <vector>

#include "report/json.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/results/stability_results.hpp"

namespace chladni::report {

/// What a mode looks like: its nodal diameters and circles, and its share of motion in the plane.
struct ModeLook {
  int diameters;
  std::optional<int> circles;
  std::optional<double> in_plane;
};

/// By the 1-based number of the mode in the body.
using ModeLooks = std::map<int, ModeLook>;

/// @param disc  of all modes of the body; those that do not move its ring along the axis are looked
///              at in the plane
ModeLooks mode_looks(const squeal::Disc& disc, const mbs_export::ModalBody& body);

/// Members `diameters`, `circles` and `in_plane`; null where one is unknown.
std::vector<Json::Member> look_members(const ModeLook& look);

/// For each motion of the map the look that has the largest share of its modal amplitudes squared
/// where it grows most; null when `looks` or the map do not tell the modes.
Json motion_looks(const squeal::EigenvalueMap& map, const ModeLooks& looks);

}  // namespace chladni::report
