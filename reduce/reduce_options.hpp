#pragma once

#include <optional>

namespace chladni::reduce {

enum class Method { guyan, craig_bampton };

/// How many fixed-interface modes: exactly one member is set (none for Guyan).
struct ReduceOptions {
  Method method = Method::craig_bampton;
  std::optional<int> modes;
  std::optional<double> cutoff_Hz;
};

}  // namespace chladni::reduce
