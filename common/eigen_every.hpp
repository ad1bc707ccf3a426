#pragma once

#include <Eigen/Core>

namespace chladni {

/// All rows, or all columns, of a matrix that is indexed: A(rows, every). Eigen 3.4 and 5 have it
/// in different namespaces.
#if EIGEN_VERSION_AT_LEAST(3, 4, 90)
inline const auto every = Eigen::placeholders::all;
inline const auto last = Eigen::placeholders::last;
#else
inline const auto every = Eigen::all;
inline const auto last = Eigen::last;
#endif

}  // namespace chladni
