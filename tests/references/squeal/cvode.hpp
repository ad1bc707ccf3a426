#pragma once

#include <Eigen/Core>

#include "squeal/motion/motion.hpp"

namespace chladni::squeal {

/// Formulas of CVODE: Adams formulas with fixed-point iteration, or BDF with Newton's method.
enum class CvodeMethod { adams, bdf };

/// Whether this program was built with SUNDIALS.
extern const bool has_cvode;

/// Integrates y' over `duration` (s) by CVODE and returns y at the end. Contact states are
/// evaluated anew at each evaluation. BDF uses a dense Jacobian by differences.
/// @param tolerance  relative tolerance; the absolute one is tolerance times |y| at the start
/// @throws chladni::Error when CVODE fails or the program was built without it.
Eigen::VectorXd cvode(Motion& motion, const Eigen::VectorXd& y, double duration, double tolerance,
                      CvodeMethod method);

}  // namespace chladni::squeal
