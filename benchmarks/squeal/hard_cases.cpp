#include "benchmarks/squeal/hard_cases.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "benchmarks/squeal/targets.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal::bench {
namespace {

using namespace test;

/// One line of the table.
struct Row {
  std::string name, setting, result, reference;
};

double eigenvalue_growth(const Disc& disc, double speed)
{
  return least_stable_eigenvalue(state_matrix(inertial_disc(disc), reference_options(), speed))
      .real();
}

/// Growth at 4.28 pi: 1.5e-6 of the frequency.
std::vector<Row> slow_growth(bool smallest)
{
  const Disc disc = disc_of({kirchhoff_3()});
  std::vector<Row> rows;
  for (const IntegratorKind kind :
       {IntegratorKind::exponential, IntegratorKind::splitting, IntegratorKind::dormand_prince}) {
    const Transient run =
        transient(FlexibleDisc(disc, reference_options()), {.speed = 4.28 * pi,
                                                            .duration = smallest ? 0.3 : 3.0,
                                                            .initial_pad_displacement = 1e-8,
                                                            .integrator = kind});
    rows.push_back(
        {"slow growth at 4.28 pi", run.integrator + ", default settings",
         fmt::format("{:.5f} 1/s", run.growth_rate.value_or(NAN)),
         fmt::format("{:.5f} 1/s by the eigenvalues", eigenvalue_growth(disc, 4.28 * pi))});
  }
  return rows;
}

std::vector<Row> split_pairs()
{
  std::vector<Row> rows;
  for (const double split_Hz : {0.0, 0.3, 1.0, 3.0, 10.0}) {
    PlatePair pair = kirchhoff_3();
    pair.f_Hz -= 0.5 * split_Hz;
    pair.split = split_Hz / pair.f_Hz;
    rows.push_back(
        {"nearly equal frequencies, 6 pi", fmt::format("{:g} Hz apart", split_Hz),
         fmt::format("{:.4f} 1/s",
                     rotation_growth(disc_of({pair}), reference_options(), 6.0 * pi).growth),
         fmt::format("{:.4f} 1/s with their mean", eigenvalue_growth(disc_of({pair}), 6.0 * pi))});
  }
  return rows;
}

std::vector<Row> low_speeds()
{
  std::vector<Row> rows;
  const InertialDisc disc = inertial_disc(disc_of({kirchhoff_3()}));
  for (const double by_pi : {1.0, 0.1, 0.01, 1e-3, 1e-4}) {
    const Eigen::VectorXcd lambda =
        state_matrix(disc, reference_options(), by_pi * pi).eigenvalues();
    rows.push_back({"speed to zero", fmt::format("{:g} pi rad/s", by_pi),
                    fmt::format("growth {:.3g}, fastest decay {:.4g} 1/s", lambda.real().maxCoeff(),
                                -lambda.real().minCoeff()),
                    "-"});
  }
  return rows;
}

std::string cycle_text(const DirectLimitCycle& cycle)
{
  return fmt::format("{:.4f} Hz, {:.4f} m/s, slip {:.3g} m/s, multiplier along the cycle 1 {:+.0e}",
                     cycle.frequency_Hz, cycle.pad_velocity, cycle.slip_speed_min,
                     cycle.multipliers[0].real() - 1.0);
}

/// Contact loss, and sliding that nearly stops, by the direct search beside a transient.
std::vector<Row> cycles(bool smallest)
{
  const Disc disc = disc_of({kirchhoff_3()});
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, ContactLaw law, double by_pi) {
    rows.push_back(
        {name, fmt::format("{:g} pi", by_pi),
         cycle_text(limit_cycle_direct(FlexibleDisc(disc, reference_options(law)), by_pi * pi)),
         "-"});
  };
  add("contact just lost", ContactLaw::unilateral, 4.3);
  add("contact lost", ContactLaw::unilateral, 6.0);
  if (!smallest) add("contact lost", ContactLaw::unilateral, 20.0);
  add("relative velocity near zero, signed law", ContactLaw::signed_force, 7.0);
  return rows;
}

std::vector<Row> stiff_pads(bool smallest)
{
  const Disc disc = disc_of({kirchhoff_3()});
  std::vector<Row> rows;
  for (const double factor : {1.0, 1e2, 1e4}) {
    SquealOptions options = reference_options();
    options.pads[0].stiffness *= factor;
    const Transient run =
        transient(FlexibleDisc(disc, options), {.speed = 6.0 * pi,
                                                .duration = smallest ? 0.01 : 0.1,
                                                .initial_pad_displacement = 1e-6 / factor});
    rows.push_back(
        {"stiff pads, 6 pi", fmt::format("k = {:g} N/m", options.pads[0].stiffness),
         fmt::format("{}, {} steps for 1 s, {}", run.integrator,
                     static_cast<int>(double(run.n_steps) / (smallest ? 0.01 : 0.1)),
                     run.finished ? "bounded" : "diverged"),
         fmt::format("growth {:.3g} 1/s by the eigenvalues",
                     least_stable_eigenvalue(state_matrix(inertial_disc(disc), options, 6.0 * pi))
                         .real())});
  }
  return rows;
}

}  // namespace

std::string hard_cases_json(bool smallest)
{
  std::vector<Row> rows;
  for (const std::vector<Row>& part :
       {slow_growth(smallest), split_pairs(), low_speeds(), cycles(smallest), stiff_pads(smallest)})
    rows.insert(rows.end(), part.begin(), part.end());
  std::string text = "[";
  for (const Row& row : rows) {
    text += fmt::format(
        "{}\n  {{\"case\": \"{}\", \"setting\": \"{}\", \"result\": \"{}\", \"reference\": "
        "\"{}\"}}",
        text.size() > 1 ? "," : "", row.name, row.setting, row.result, row.reference);
  }
  return text + "]";
}

}  // namespace chladni::squeal::bench
