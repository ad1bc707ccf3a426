#include "squeal/contact_branch.hpp"

#include <complex>

namespace chladni::squeal {

Eigen::Matrix<double, 3, 6> force_derivative(const PadContact& pad, const RingMotion<double>& m,
                                             double speed, std::span<const double> branches)
{
  using Complex = std::complex<double>;
  constexpr double step = 1e-30;  // f(x + i h) / h has no difference in it
  const std::array<double, 6> at{m.w, m.g_r, m.g_t, m.w_dot, m.g_r_dot, m.g_t_dot};
  Eigen::Matrix<double, 3, 6> D;
  for (int j = 0; j < 6; ++j) {
    std::array<Complex, 6> x{};
    for (std::size_t i = 0; i < 6; ++i) x[i] = at[i];
    x[static_cast<std::size_t>(j)] += Complex(0.0, step);
    D.col(j) = force_on_branch<Complex>(pad, {x[0], x[1], x[2], x[3], x[4], x[5]}, speed, branches)
                   .imag() /
               step;
  }
  return D;
}

}  // namespace chladni::squeal
