#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <future>
#include <thread>
#include <vector>

namespace chladni::squeal {

/// Step h of complex-step derivatives f(x + i h) / h. They have no cancellation, so h^2 may be far
/// below rounding.
inline constexpr double complex_step = 1e-30;

/// df/dx at x = 0 by complex steps, exact to rounding.
/// @param f  function of an Eigen::VectorXcd, analytic at 0
/// @param n  size of x
/// @return [m x n]
template <class Function>
Eigen::MatrixXd derivative_at_rest(const Function& f, Eigen::Index n)
{
  Eigen::MatrixXd D;
  for (Eigen::Index j = 0; j < n; ++j) {
    Eigen::VectorXcd x = Eigen::VectorXcd::Zero(n);
    x[j] = std::complex<double>(0.0, complex_step);
    const Eigen::VectorXd column = f(x).imag() / complex_step;
    if (j == 0) D.resize(column.size(), n);
    D.col(j) = column;
  }
  return D;
}

/// Whether this thread executes a loop of `for_each_index`.
inline thread_local bool is_within_loop = false;

/// Calls f(i) for i = 0 ... n - 1 on `n_threads` threads, 0 for the number of processors. Each
/// index is computed independently, so a result stored by index does not depend on the number of
/// threads. A loop inside another one runs on its caller's thread, because all processors are
/// already in use.
/// @throws the first exception of the thread with the lowest index
template <class Function>
void for_each_index(int n, const Function& f, unsigned n_threads = 0)
{
  if (is_within_loop) {
    for (int i = 0; i < n; ++i) f(i);
    return;
  }
  if (n_threads == 0) n_threads = std::max(1U, std::thread::hardware_concurrency());
  const int stride = std::min(std::max(n, 1), static_cast<int>(n_threads));
  std::vector<std::future<void>> parts;
  for (int first = 0; first < stride; ++first)
    parts.push_back(std::async(std::launch::async, [&f, n, first, stride] {
      is_within_loop = true;
      for (int i = first; i < n; i += stride) f(i);
    }));
  for (std::future<void>& part : parts) part.wait();
  for (std::future<void>& part : parts) part.get();
}

/// Root of a continuous function between `low`, where it is negative, and `high`, where it is
/// positive, by regula falsi with the Illinois rule: the value at an end that remains twice is
/// halved.
/// @param tolerance  relative change of the root at which the iteration ends
template <class Function>
double root(const Function& f, double low, double high, double tolerance = 1e-14)
{
  double f_low = f(low), f_high = f(high), last = low;
  int stay = 0;  // > 0: `high` stayed, < 0: `low` stayed
  for (int i = 0; i < 100; ++i) {
    const double x = (low * f_high - high * f_low) / (f_high - f_low);
    const double f_x = f(x);
    if (f_x == 0.0 || std::abs(x - last) <= tolerance * x) return x;
    last = x;
    if (f_x < 0.0) {
      low = x;
      f_low = f_x;
      stay = std::max(stay, 0) + 1;
      if (stay > 1) f_high *= 0.5;
    } else {
      high = x;
      f_high = f_x;
      stay = std::min(stay, 0) - 1;
      if (stay < -1) f_low *= 0.5;
    }
  }
  return last;
}

}  // namespace chladni::squeal
