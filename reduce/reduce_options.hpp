#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace chladni::reduce {

/// The method of reduction. `automatic` needs a tolerance and takes the method that costs least.
enum class Method { guyan, craig_bampton, mixed_interface, rubin, automatic };

/// The name of a method in scene files and options.
constexpr std::string_view name_of(Method method)
{
  constexpr std::array<std::string_view, 5> names{"guyan", "craig-bampton", "mixed-interface",
                                                  "rubin", "auto"};
  return names[static_cast<std::size_t>(method)];
}

/// Asks for as few fixed-interface modes as keep the estimated relative error of each frequency of
/// the supported body below a tolerance, up to a frequency. With the mixed interface all modes of
/// the supported body up to that frequency are taken; they have no such error.
struct ModesByTolerance {
  double tolerance;  ///< relative, of a frequency
  double up_to_Hz;
};

/// The method and the number of its modes: fixed-interface modes, modes of the supported body
/// (mixed interface), or free-interface modes (Rubin). Exactly one of `modes`, `cutoff_Hz` and
/// `tolerance` is set, none for Guyan; Guyan and Rubin take no tolerance.
struct ReduceOptions {
  Method method = Method::craig_bampton;
  std::optional<int> modes = {};
  std::optional<double> cutoff_Hz = {};
  std::optional<ModesByTolerance> tolerance = {};
  /// With cutoff_Hz: this many fixed-interface modes are kept even above it. With 0, a cut-off
  /// below the first mode is an error.
  int at_least = 0;
  /// With cutoff_Hz: methods with free masters may return the static shapes alone.
  bool may_have_none = false;
  /// With cutoff_Hz: number of fixed-interface modes that the search begins with.
  int expected = 32;
  /// The modes below this frequency get an error estimate, however many modes the basis has.
  /// Without it, those up to the last mode of the basis, or up to the end of the tolerance's range.
  std::optional<double> certified_up_to_Hz = {};
};

/// Whether the modes of a method can be chosen so that they keep a tolerance.
constexpr bool keeps_tolerances(Method method)
{
  return method == Method::craig_bampton || method == Method::mixed_interface ||
         method == Method::automatic;
}

}  // namespace chladni::reduce
