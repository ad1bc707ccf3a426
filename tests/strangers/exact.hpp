#pragma once

#include <Eigen/Core>
#include <vector>

#include "pencils.hpp"

/// Spectra by dense matrices, in long double where that is quick enough.
namespace chladni::strangers {

using Dense = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

/// Sums the entries.
Eigen::MatrixXd dense(const std::vector<Entry>& A, int n);

/// The finite eigenvalues of a pencil, ascending.
struct Spectrum {
  std::vector<double> lambda;
  std::vector<double> doubt;  ///< of lambda by its rounding: an absolute error, one for each
};

/// Of M x = mu (K + s M) x, so that M may be singular; infinite eigenvalues are left out.
/// @param n_rigid  so many are exactly zero
Spectrum spectrum(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M, int n_rigid);

/// The same without rows and columns of the masters.
Spectrum held_spectrum(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                       const std::vector<int>& masters);

/// How many are surely and how many may be below sigma.
struct CountBelow {
  int surely, perhaps;
};
CountBelow count_below(const Spectrum& spectrum, double sigma);

}  // namespace chladni::strangers
