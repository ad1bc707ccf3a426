#include "cases/local_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "cases/size_of_mesh.hpp"

namespace chladni::cases {

// An element of size h at a place has the error c h^r for each area, and 1 / h^2 elements fill it.
// Of all sizes with the same error the fewest elements have h = kappa c^(-1 / (r + 2)); with I the
// integral of c^(2 / (r + 2)) their error is kappa^r I.
LocalSizes local_sizes(const std::vector<ErrorShare>& shares, double reduction, double rate)
{
  constexpr double smallest_step = 0.1, largest_step = 1.4;
  const auto density = [&](const ErrorShare& at) {
    return at.share / at.area / std::pow(at.size, rate);
  };
  double error = 0.0, integral = 0.0;
  for (const ErrorShare& at : shares) {
    error += at.share;
    integral += at.area * std::pow(density(at), 2.0 / (rate + 2.0));
  }
  const double kappa = std::pow(reduction * error / integral, 1.0 / rate);
  LocalSizes found{.sizes = {}, .n_elements = 0.0};
  for (const ErrorShare& at : shares) {
    const double wanted =
        kappa * std::pow(density(at), -1.0 / (rate + 2.0));  // infinite without error
    const double size =
        rounded(std::clamp(wanted, smallest_step * at.size, largest_step * at.size));
    found.sizes.push_back({.x = at.x, .size = size});
    found.n_elements += at.area / (size * size);
  }
  return found;
}

double n_elements(const std::vector<ErrorShare>& shares)
{
  double n = 0.0;
  for (const ErrorShare& at : shares) n += at.area / (at.size * at.size);
  return n;
}

}  // namespace chladni::cases
