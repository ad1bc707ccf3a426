#include "report/page/order_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "report/page/numbers.hpp"

namespace chladni::report {
namespace {

using Eigen::Index;

constexpr double range_dB = 60.0;
constexpr Index frequencies_max = 320, times_max = 120;

/// The largest amplitude of each block of times and frequencies, in dB above the floor.
Eigen::MatrixXd levels(const squeal::Spectrogram& of, Index every_t, Index every_f)
{
  const double floor = of.amplitude.maxCoeff() * std::pow(10.0, -range_dB / 20.0);
  const Index n_t = of.amplitude.rows() / every_t, n_f = of.amplitude.cols() / every_f;
  Eigen::MatrixXd dB(n_f, n_t);
  for (Index i = 0; i < n_f; ++i)
    for (Index k = 0; k < n_t; ++k) {
      const double a =
          of.amplitude.block(k * every_t, i * every_f, every_t, every_f).maxCoeff() / floor;
      const double level = std::max(-range_dB, 20.0 * std::log10(std::max(a, 1e-9)));
      dB(i, k) = std::round(10.0 * level) / 10.0;  // shorter in the page
    }
  return dB;
}

}  // namespace

Json spectrogram_page(const squeal::Spectrogram& spectrogram)
{
  const squeal::Spectrogram& of = spectrogram;
  const Index every_t = (of.t.size() + times_max - 1) / times_max,
              every_f = (of.frequency_Hz.size() + frequencies_max - 1) / frequencies_max;
  const auto some = [](const Eigen::VectorXd& x, Index every) -> Eigen::VectorXd {
    return x(Eigen::seqN(0, x.size() / every, every));
  };
  std::vector<Json> lines, orders;
  for (Index j = 0; j < of.line_Hz.cols(); ++j) {
    // Lines a thousandth as strong as the strongest of their window are no tracks.
    const auto weak = of.line_amplitude.col(j).array() < 1e-3 * of.line_amplitude.col(0).array();
    const Eigen::VectorXd f_Hz =
        weak.select(std::numeric_limits<double>::quiet_NaN(), of.line_Hz.col(j));
    lines.push_back(rounded(f_Hz));
    // A disc that nearly stands has no orders.
    const auto turns = of.speed.array() > 1e-3 * of.speed.maxCoeff();
    const Eigen::VectorXd order = 2.0 * std::numbers::pi * f_Hz.cwiseQuotient(of.speed);
    orders.push_back(
        rounded(Eigen::VectorXd(turns.select(order, std::numeric_limits<double>::quiet_NaN()))));
  }
  Eigen::VectorXd t = some(of.t, every_t);
  return Json::object({{"map_t", rounded(t)},
                       {"t", rounded(of.t)},
                       {"speed", rounded(of.speed)},
                       {"envelope", rounded(of.envelope)},
                       {"frequency_Hz", rounded(some(of.frequency_Hz, every_f))},
                       {"level_dB", rounded_rows(levels(of, every_t, every_f))},
                       {"range_dB", range_dB},
                       {"line_Hz", Json::array(lines)},
                       {"line_order", Json::array(orders)}});
}

}  // namespace chladni::report
