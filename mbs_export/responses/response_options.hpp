#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace chladni::mbs_export {

/// Components at the nodes of a named set: an attachment set, or a group, ring or coupling of the
/// FE model.
struct ResponsePlace {
  std::string at;
  std::vector<int> components = {};                ///< 0 to 5
  std::optional<std::array<double, 3>> near = {};  ///< m; the node of the set nearest to here alone
};

enum class ResponseModel { body, reduced, fe };

/// Displacement, velocity or acceleration for each unit of load.
enum class ResponseQuantity { receptance, mobility, accelerance };

enum class Spacing { linear, logarithmic };

struct FrequencyRange {
  double from_Hz;
  double to_Hz;  ///< above from_Hz
  int count;     ///< 2 or more, both ends among them
  Spacing spacing = Spacing::linear;
};

/// The scene's [response].
struct ResponseOptions {
  ResponseModel model = ResponseModel::body;
  ResponseQuantity quantity = ResponseQuantity::receptance;
  std::vector<ResponsePlace> loads = {};    ///< a unit load for each component
  std::vector<ResponsePlace> outputs = {};  ///< each component of each node
  FrequencyRange range;
  double loss_factor = 0.0;  ///< eta of K (1 + i eta), besides the body's damping
  std::vector<std::string> section_forces = {};  ///< groups whose section forces respond
};

}  // namespace chladni::mbs_export
