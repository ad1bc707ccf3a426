#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "report/json.hpp"

namespace chladni::report {

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
