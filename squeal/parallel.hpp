#pragma once

#include <algorithm>
#include <future>
#include <thread>
#include <vector>

namespace chladni::squeal {

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

}  // namespace chladni::squeal
