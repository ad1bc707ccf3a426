#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/error.hpp"

namespace chladni::mbs_export {

/// A tolerance for the largest relative error of the frequency responses at the loaded attachment
/// DOFs, over a range.
struct Tolerance {
  double error;     ///< 0 < error < 1
  double up_to_Hz;  ///< end of the range, which begins at 0
};

/// The constrained modes that the body keeps: at most one member is set; none means all modes.
struct KeptModes {
  std::optional<int> count;
  std::optional<double> up_to_Hz;
  /// numbers from 1 in ascending order of frequency
  std::optional<std::vector<int>> list;
  /// As few modes and interface modes as meet the tolerance; `interface_modes` then name the loads
  /// to choose from.
  std::optional<Tolerance> tolerance = {};
};

/// The interface modes of one set of loaded attachment nodes: IRM (at = set, omega0 = 0) or FRM.
struct InterfaceModes {
  enum class Kind { irm, frm };
  /// The space of the response: the neglected modes, or the FE model at the time of the reduction,
  /// which then adds columns for it to the reduced system.
  enum class Space { reduced, full };
  Kind kind;
  std::string at;               ///< name of an attachment set
  std::vector<int> components;  ///< loaded components 0..5 of each of its nodes
  /// rad/s; absent: half the first elastic free frequency
  std::optional<double> omega0;
  Space space = Space::reduced;
};

/// The damping of the body in its final coordinates.
struct Damping {
  enum class Type { none, modal, rayleigh, matrix };
  Type type = Type::none;
  std::vector<double> ratios =
      {};  ///< modal: one for all modes, one for each, or as many as `at_Hz`
  /// modal: ascending frequencies of the ratios, linear between; empty: none
  std::vector<double> at_Hz = {};
  double alpha = 0.0;  ///< Rayleigh, 1/s
  double beta = 0.0;   ///< Rayleigh, s
};

/// The name of a type of damping: "none", "modal", "rayleigh", "matrix".
std::string name_of(Damping::Type type);

/// The table [body] of a scene.
struct BodyOptions {
  std::vector<std::string> fixed;  ///< "SET" (whole nodes) or "SET.x|y|z|rx|ry|rz"
  KeptModes keep;
  std::vector<InterfaceModes> interface_modes;
  Damping damping;
};

/// Thrown when a reduced system cannot do what the scene's table [body] asks for; names the key.
class BodyOptionError : public Error {
 public:
  /// @param key  "keep.modes"
  BodyOptionError(std::string key, std::string why)
      : Error(key + ": " + why), key_(std::move(key)), why_(std::move(why))
  {}

  const std::string& key() const { return key_; }
  const std::string& why() const { return why_; }

 private:
  std::string key_;
  std::string why_;
};

}  // namespace chladni::mbs_export
