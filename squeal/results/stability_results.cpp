#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

const char* name_of(Stability stability)
{
  switch (stability) {
    case Stability::stable:
      return "stable in the whole range";
    case Stability::unstable:
      return "unstable in the whole range";
    case Stability::lost:
      return "lost within the range";
    case Stability::regained:
      return "regained within the range";
  }
  return "";
}

}  // namespace chladni::squeal
