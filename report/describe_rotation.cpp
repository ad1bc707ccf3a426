#include "report/describe_rotation.hpp"

#include <numbers>

#include "report/quantities.hpp"

namespace chladni::report {
namespace {

using Eigen::Index;

/// Those that grow at the speed of the largest growth, the worst first; that one at least.
void add_worst(TextTable& table, const squeal::RotationStability& stability)
{
  Index at = 0;
  stability.growth.maxCoeff(&at);
  for (Index j = 0; j < stability.exponents.cols(); ++j) {
    const std::complex<double> lambda = stability.exponents(at, j);
    if (j > 0 && !(lambda.real() > 0.0)) return;
    add(table,
        fmt::format("growth at {:.6g} rad/s of {:.2f} Hz (rotation)", stability.speeds[at],
                    lambda.imag() / (2.0 * std::numbers::pi)),
        lambda.real(), "1/s");
  }
}

void add_frozen(TextTable& table, const squeal::RotationStability& stability)
{
  add(table, "the same from a disc that stands at its worst angle",
      stability.frozen_growth.maxCoeff(), "1/s");
  const Index misled =
      ((stability.frozen_growth.array() > 0.0) != (stability.growth.array() > 0.0)).count();
  if (misled > 0)
    add_count(table, "speeds at which the standing disc misleads about stability", misled);
}

}  // namespace

void add_rotation_method(TextTable& table, const squeal::RotationStability& stability)
{
  if (stability.method == "hill") {
    table.rows.push_back(
        {"method (rotation)",
         fmt::format("Hill, K = {} harmonics of the rotation", stability.harmonics), ""});
    add(table, "estimated error of its growth rates", stability.error, "1/s");
  } else if (!stability.method.empty()) {
    table.rows.push_back({"method (rotation)", "Floquet, integrated over one rotation", ""});
  }
  if (stability.exponents.size() > 0) add_worst(table, stability);
  if (stability.frozen_growth.size() > 0) add_frozen(table, stability);
}

}  // namespace chladni::report
