#include "squeal/results/rotation_file.hpp"

#include <complex>
#include <cstdint>

#include "mbs_export/files/file_parts.hpp"
#include "squeal/results/file_checks.hpp"
#include "squeal/results/transient_file.hpp"

namespace chladni::squeal {

void write_rotation_stability(files::Writer& file, const RotationStability& stability)
{
  file.write("rotation_stability/speeds", stability.speeds, "rad/s");
  file.write("rotation_stability/growth", stability.growth, "1/s");
  file.write("rotation_stability/frequency", stability.frequency_Hz, "Hz");
  write_optional(file, "rotation_stability/critical_speed", stability.critical_speed, "rad/s");
  if (stability.frozen_growth.size() > 0)
    file.write("rotation_stability/frozen_growth", stability.frozen_growth, "1/s");
  if (stability.method.empty()) return;
  file.write("rotation_stability/method", stability.method);
  if (stability.exponents.size() == 0) return;
  file.write("rotation_stability/harmonics", std::int64_t{stability.harmonics}, "1");
  file.write("rotation_stability/error", stability.error, "1/s");
  file.write("rotation_stability/exponents_re", Eigen::MatrixXd(stability.exponents.real()), "1/s");
  file.write("rotation_stability/exponents_im", Eigen::MatrixXd(stability.exponents.imag()),
             "rad/s");
}

RotationStability read_rotation_stability(const files::Reader& file)
{
  const Eigen::VectorXd speeds = read_some(file, "rotation_stability/speeds");
  RotationStability stability{speeds, file.vector("rotation_stability/growth", speeds.size()),
                              file.vector("rotation_stability/frequency", speeds.size()),
                              read_optional(file, "rotation_stability/critical_speed")};
  if (file.contains("rotation_stability/frozen_growth"))
    stability.frozen_growth = file.vector("rotation_stability/frozen_growth", speeds.size());
  if (file.contains("rotation_stability/method"))
    stability.method = file.text("rotation_stability/method");
  if (!file.contains("rotation_stability/exponents_re")) return stability;
  stability.harmonics = mbs_export::file_parts::read_count(file, "rotation_stability/harmonics");
  stability.error = file.real("rotation_stability/error");
  const Eigen::MatrixXd re = file.matrix("rotation_stability/exponents_re");
  const Eigen::MatrixXd im = file.matrix("rotation_stability/exponents_im", {re.rows(), re.cols()});
  if (re.rows() != speeds.size())
    file.fail("rotation_stability/exponents_re", "it must have one row for each speed");
  stability.exponents = re + std::complex<double>(0.0, 1.0) * im;
  return stability;
}

}  // namespace chladni::squeal
