#include "common/error.hpp"
#include "tests/references/squeal/cvode.hpp"

namespace chladni::squeal {

const bool has_cvode = false;

Eigen::VectorXd cvode(Motion&, const Eigen::VectorXd&, double, double, CvodeMethod)
{
  throw Error("this program was built without SUNDIALS");
}

}  // namespace chladni::squeal
