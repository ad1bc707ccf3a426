#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "report/json.hpp"

namespace chladni::report {

/// A motion Re((re + i im) exp(i omega t)) of all nodes of a picture.
struct Motion {
  std::string name;
  double frequency_Hz;
  Eigen::VectorXcd amplitude;  ///< [n_modes] of the body's modes
};

/// The nodes and cells by which a body can be drawn: its picture, or else its attachment nodes with
/// lines along the rings.
mbs_export::Picture drawable(const mbs_export::ModalBody& body);

/// Positions, cells and motions: each mode by itself, then `motions`. Displacements are 16-bit
/// integers, full scale for the largest one of each motion. Of a large picture only as many modes
/// are taken as fit into a page of a few MB; `left_out` counts the others.
Json shapes_json(const mbs_export::ModalBody& body, const std::vector<Motion>& motions);

}  // namespace chladni::report
