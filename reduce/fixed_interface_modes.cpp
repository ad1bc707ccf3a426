#include "reduce/fixed_interface_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/told_apart.hpp"
#include "reduce/mode_search.hpp"

namespace chladni::reduce {

namespace {

FixedInterfaceModes modes_by_number(ModeSearch& search, PetscInt n_modes)
{
  if (n_modes < 1 || n_modes > search.n_slaves()) {
    throw Error(fmt::format("fixed_interface_modes: {} modes asked of {} slaves; give 1 to {}",
                            n_modes, search.n_slaves(), search.n_slaves()));
  }
  search.find(n_modes);
  if (std::ssize(search.omega()) < n_modes) {
    search.require_resolved(linear::all_of_them);
    throw Error(
        fmt::format("fixed_interface_modes: {} of {} modes found; M_ss has no more: ask for fewer",
                    search.omega().size(), n_modes));
  }
  return search.leading(search.complete_cluster(n_modes));
}

FixedInterfaceModes modes_below(ModeSearch& search, const ReduceOptions& wanted)
{
  const double omega_cutoff = 2.0 * std::numbers::pi * *wanted.cutoff_Hz;
  const std::vector<double>& omega = search.omega();
  PetscInt n_asked = 0;
  PetscInt n_found = 0;
  do {  // half as many more, until one is above or there are no others
    n_found = static_cast<PetscInt>(omega.size());
    n_asked = std::max<PetscInt>(wanted.expected, n_found + n_found / 2);
    search.find(n_asked);
    if (omega.empty()) {
      search.require_resolved(linear::all_of_them);
      throw Error("fixed_interface_modes: no mode found; M_ss is zero or indefinite, use Guyan");
    }
  } while (omega.back() < omega_cutoff && std::ssize(omega) > n_found);
  search.require_resolved(std::pow(omega_cutoff, 2));
  const auto n_below =
      static_cast<PetscInt>(std::ranges::lower_bound(omega, omega_cutoff) - omega.begin());
  const auto n_there = static_cast<PetscInt>(omega.size());
  const PetscInt n = std::max(n_below, std::min<PetscInt>(wanted.at_least, n_there));
  if (n > 0) return search.leading(search.complete_cluster(n));
  const auto [first_Hz, cutoff_Hz] = told_apart(omega.front() / (2.0 * std::numbers::pi),
                                                omega_cutoff / (2.0 * std::numbers::pi), 6);
  throw Error(
      fmt::format("fixed_interface_modes: no mode below {} Hz (the first is at {} Hz); raise "
                  "cutoff_Hz or use Guyan",
                  cutoff_Hz, first_Hz));
}

}  // namespace

FixedInterfaceModes fixed_interface_modes(const linear::Factorization& K_ss, Mat M_ss,
                                          const ReduceOptions& wanted,
                                          const MemoryCheck& require_memory)
{
  ModeSearch search(K_ss, M_ss, require_memory);
  if (wanted.modes) return modes_by_number(search, *wanted.modes);
  if (wanted.cutoff_Hz) return modes_below(search, wanted);
  throw Error("fixed_interface_modes: give the number of modes or cutoff_Hz");
}

}  // namespace chladni::reduce
