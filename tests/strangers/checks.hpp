#pragma once

#include "exact.hpp"
#include "solve.hpp"

/// What must hold of every answer, by dense matrices.
namespace chladni::strangers {

/// A property that does not hold, by its name in one word, and the figures.
struct Failure {
  std::string property, figures;
};
using Failures = std::vector<Failure>;

/// A pencil with its spectra.
struct Reference {
  Pencil pencil;
  Eigen::MatrixXd K, M;
  int n_rigid = 0;       ///< motions without energy that the support leaves
  int n_free_rigid = 0;  ///< without a support
  Spectrum whole{};      ///< under the support
  Spectrum held{};       ///< with all masters held
};
Reference reference(const Pencil& pencil);

/// The lowest eigenvalue of K_ss with its diagonal made 1; 0 where that cannot be.
double least_of_slaves(const Reference& exact);

/// What holds of frequencies, errors, bounds and counts, whatever the coordinates are.
void check_spectrum(const Reference& exact, const Answer& answer, Failures& failures);

/// A refusal, and the reason that it gives.
Failures check_refusal(const Pencil& pencil, const Answer& answer);

/// Everything that a projection promises.
Failures check(const Reference& exact, const Reduction& how, const Answer& answer);

/// n eigenvalues closest to the target, and residuals of all.
Failures check(const Reference& exact, int n, double target, const Eigenpairs& pairs);

/// The same figures from all ranks and from one.
Failures compare(const Reference& exact, const Answer& all, const Answer& one);

}  // namespace chladni::strangers
