#include "linear/dense/decoupled_coordinates.hpp"

#include <algorithm>

namespace chladni::linear {

using Eigen::Index;

std::vector<std::vector<Index>> decoupled_coordinates(const Eigen::MatrixXd& K,
                                                      const Eigen::MatrixXd& M)
{
  std::vector<std::vector<Index>> sets;
  std::vector<bool> is_known(static_cast<std::size_t>(K.cols()), false);
  for (Index first = 0; first < K.cols(); ++first) {
    if (is_known[static_cast<std::size_t>(first)]) continue;
    std::vector<Index> set{first};
    is_known[static_cast<std::size_t>(first)] = true;
    for (std::size_t next = 0; next < set.size(); ++next) {
      for (Index i = 0; i < K.rows(); ++i) {
        if (is_known[static_cast<std::size_t>(i)]) continue;
        if (K(i, set[next]) == 0.0 && M(i, set[next]) == 0.0) continue;
        is_known[static_cast<std::size_t>(i)] = true;
        set.push_back(i);
      }
    }
    std::ranges::sort(set);
    sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace chladni::linear
