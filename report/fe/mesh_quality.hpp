#pragma once

#include <string>
#include <vector>

#include "mesh/quality.hpp"
#include "report/json.hpp"

/// The shapes of a mesh's elements, for people and for programs.
namespace chladni::report {

/// Least, mean and greatest value of each measure, its histogram, and the first ten elements that
/// cannot work.
std::string quality_text(const std::vector<mesh::ElementQuality>& elements);

/// "quality": measure -> min, mean, max, bin_edges, counts; "unusable_elements": their numbers.
std::vector<Json::Member> quality_json(const std::vector<mesh::ElementQuality>& elements);

}  // namespace chladni::report
