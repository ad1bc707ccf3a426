#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/error.hpp"

namespace chladni::mbs_export {

/// Components at the nodes of a named set: an attachment set, or a group, ring or coupling of the
/// FE model.
struct ResponsePlace {
  std::string at;
  std::vector<int> components = {};  ///< 0 to 5
  /// m; only the node of the set that is nearest to this position
  std::optional<std::array<double, 3>> near = {};
  std::optional<std::int64_t> measured_node = {};  ///< number of the node in a measurement
};

enum class ResponseModel { body, reduced, fe };

/// Displacement, velocity or acceleration per unit of load.
enum class ResponseQuantity { receptance, mobility, accelerance };

enum class Spacing { linear, logarithmic };

struct FrequencyRange {
  double from_Hz;
  double to_Hz;  ///< above from_Hz
  int count;     ///< 2 or more, both ends included
  Spacing spacing = Spacing::linear;
};

struct MeasuredFunctions;

/// Measured frequency responses to compare with.
struct Measurement {
  std::shared_ptr<const MeasuredFunctions> functions;
  /// m; largest distance from a measured node to its load or output. Without it only places with a
  /// `measured_node` are compared.
  std::optional<double> distance = {};
};

/// The table [response] of a scene.
struct ResponseOptions {
  ResponseModel model = ResponseModel::body;
  ResponseQuantity quantity = ResponseQuantity::receptance;
  std::vector<ResponsePlace> loads = {};    ///< a unit load for each component
  std::vector<ResponsePlace> outputs = {};  ///< each component of each node
  FrequencyRange range;
  double loss_factor = 0.0;  ///< eta of K (1 + i eta), in addition to the body's damping
  /// groups whose section forces are computed
  std::vector<std::string> section_forces = {};
  /// Its frequencies replace `count` and `spacing` of the range.
  std::optional<Measurement> measurement = {};
};

/// Thrown when a model cannot answer what the scene's table [response] asks for; names the key.
class ResponseOptionError : public Error {
 public:
  /// @param key  "loads[2].at"
  ResponseOptionError(std::string key, std::string why)
      : Error("response." + key + ": " + why), key_(std::move(key)), why_(std::move(why))
  {}

  const std::string& key() const { return key_; }
  const std::string& why() const { return why_; }

 private:
  std::string key_;
  std::string why_;
};

}  // namespace chladni::mbs_export
