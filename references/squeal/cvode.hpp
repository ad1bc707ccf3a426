#pragma once

#include <Eigen/Core>

#include "squeal/motion/motion.hpp"

namespace chladni::squeal {

enum class CvodeMethod { adams, bdf };

/// Whether this program was built with SUNDIALS.
extern const bool has_cvode;

/// y at `duration` (s) by CVODE, with sides as they are at each evaluation: Adams formulas with
/// fixed-point iteration, or BDF with Newton's method and a dense Jacobian by differences.
/// @param tolerance  relative; the absolute one is the same part of |y| at the start
/// @throws chladni::Error when CVODE fails or is not there.
Eigen::VectorXd cvode(Motion& motion, const Eigen::VectorXd& y, double duration, double tolerance,
                      CvodeMethod method);

}  // namespace chladni::squeal
