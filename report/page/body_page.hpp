#pragma once

#include <Eigen/Core>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
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

/// The modes of a body: number, frequency, kind, what they look like where `looks` knows, and for
/// modes that the certificate knows the estimated relative error of the frequency and half the
/// bound of the error of omega^2.
Json modes_json(const mbs_export::ModalBody& body, const mbs_export::Certificate& certificate,
                const ModeLooks& looks);

/// The eigenvalue counts of the certificate: upper limit, expected and found number; null when none
/// were counted.
Json counts_json(const mbs_export::Certificate& certificate);

/// Size and error for each step of the selection; null when no tolerance chose the modes.
Json selection_json(const mbs_export::ModalBody& body);

/// A motion Re((re + i im) exp(i omega t)) of all nodes of a picture, by complex modal amplitudes.
struct Motion {
  std::string name;
  double frequency_Hz;
  Eigen::VectorXcd amplitude;  ///< [n_modes] amplitude of each mode of the body
};

/// Nodes and cells to draw a body with: its picture, or else its attachment nodes with lines along
/// the rings.
mbs_export::Picture drawable(const mbs_export::ModalBody& body);

/// JSON with positions, cells and motions: first each mode, then `motions`. Displacements are
/// 16-bit integers scaled to the largest displacement of each motion. For a large picture only as
/// many modes are included as fit into a page of a few MB; `left_out` is the number of the others.
Json shapes_json(const mbs_export::ModalBody& body, const std::vector<Motion>& motions);

}  // namespace chladni::report
