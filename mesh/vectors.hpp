#pragma once

#include <array>
#include <cmath>

namespace chladni::mesh {

/// A position or a direction in space.
using Vector = std::array<double, 3>;

inline Vector minus(const Vector& a, const Vector& b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline double dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline double norm(const Vector& a)
{
  return std::sqrt(dot(a, a));
}

inline Vector cross(const Vector& a, const Vector& b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The direction of `a` with length 1; `a` must not vanish.
inline Vector unit(const Vector& a)
{
  const double length = norm(a);
  return {a[0] / length, a[1] / length, a[2] / length};
}

}  // namespace chladni::mesh
