#include "plate/elements/assumed_strains.hpp"
#include "plate/elements/rotation_bubbles.hpp"

namespace chladni::plate {

namespace {

using Eigen::VectorXd;

/// A to C, near the corners, and D to F, at the distance 1e-4 from the centre.
Points tying_points()
{
  constexpr double third = 1.0 / 3.0, sixth = 1.0 / 6.0, d = 1e-4;
  Points points{.xi = VectorXd(6), .eta = VectorXd(6), .weight = {}};
  points.xi << sixth, 4.0 * sixth, sixth, third + d, third - 2.0 * d, third + d;
  points.eta << 4.0 * sixth, sixth, sixth, third - 2.0 * d, third + d, third + d;
  return points;
}

/// A constant shear and one that turns about the centre, from its values at `tying_points`.
std::array<StrainRows, 2> tied_shear(const std::array<StrainRows, 2>& g, const Points& integration)
{
  constexpr int A = 0, B = 1, C = 2, D = 3, E = 4, F = 5;
  const StrainRows mean_C = (g[0].row(C) + g[1].row(C)) / 3.0;
  const StrainRows constant_r = 2.0 / 3.0 * (g[0].row(B) - 0.5 * g[1].row(B)) + mean_C;
  const StrainRows constant_s = 2.0 / 3.0 * (g[1].row(A) - 0.5 * g[0].row(A)) + mean_C;
  const StrainRows turn = (g[0].row(F) - g[0].row(D) - g[1].row(F) + g[1].row(E)) / 3.0;
  const VectorXd ones = VectorXd::Ones(integration.size());
  return {ones * constant_r + (3.0 * integration.eta - ones) * turn,
          ones * constant_s + (ones - 3.0 * integration.xi) * turn};
}

}  // namespace

CovariantStrains linear_triangle_strains(const ShellNodes& nodes, const BubbleBasis& basis,
                                         const Points& points)
{
  static const BubbleBasis at_tying = basis_with_bubbles(1, tying_points());
  CovariantStrains strains = strains_with_bubbles(basis, nodes);
  const CovariantStrains tied = strains_with_bubbles(at_tying, nodes);
  strains.g0 = tied_shear(tied.g0, points);
  strains.g1 = tied_shear(tied.g1, points);
  return strains;
}

}  // namespace chladni::plate
