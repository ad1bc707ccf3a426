#pragma once

#include <string>
#include <vector>

#include "mesh/quality.hpp"
#include "report/json.hpp"

/// Element quality of a mesh, as text and as JSON.
namespace chladni::report {

/// Minimum, mean, maximum and histogram of each quality measure, and the first ten unusable
/// elements.
std::string quality_text(const std::vector<mesh::ElementQuality>& elements);

/// JSON members `quality`, with min, mean, max, bin_edges and counts of each measure, and
/// `unusable_elements` with their numbers.
std::vector<Json::Member> quality_json(const std::vector<mesh::ElementQuality>& elements);

}  // namespace chladni::report
