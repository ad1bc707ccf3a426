// What does an integrator of squeal cost for a given error, and are the targets of speed met?
//
// Three cases: growth just above the critical speed (1.7e-2 1/s), motion with contact loss of two
// modes, and the same of the 35 modes below 16 kHz; SUNDIALS CVODE beside our own integrators where
// it is installed. Usage: squeal_work_precision [--smallest] FILE.json

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "benchmarks/squeal/hard_cases.hpp"
#include "benchmarks/squeal/targets.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/motion/disc_motion.hpp"
#include "squeal/motion/dormand_prince.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/transient/integrator_choice.hpp"
#include "squeal/transient/transient.hpp"
#include "squeal/transient/transient_steps.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/references/squeal/cvode.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"

namespace {

using namespace chladni::squeal;
using namespace chladni::squeal::test;
using namespace chladni::squeal::bench;

/// One run: what it cost, and how far it was from the truth.
struct Point {
  std::string integrator;
  double setting;  ///< steps per period of the highest mode, or the tolerance
  double error;
  double time;         ///< of the processor, s for each second simulated
  double evaluations;  ///< of the contact forces, for each second simulated
};

struct Case {
  std::string name;
  Disc disc;
  SquealOptions options;
  double speed;
  double duration;

  double period() const { return 2.0 * pi / disc.omega.maxCoeff(); }
};

ModalState large_motion(const Disc& disc)
{
  return {Eigen::VectorXd::Constant(disc.n_modes(), 1e-3 / std::sqrt(disc.n_modes())),
          Eigen::VectorXd::Constant(disc.n_modes(), 8.0 / std::sqrt(disc.n_modes()))};
}

Eigen::VectorXd scaled(const Disc& disc, const ModalState& x)
{
  Eigen::VectorXd y(2 * disc.n_modes());
  y << disc.omega.cwiseProduct(x.q), x.v;
  return y;
}

/// The state at `t` by the integrator of order 8 at a tolerance close to rounding.
Eigen::VectorXd truth(const Case& study, double t)
{
  RotatingDisc motion(study.disc, study.options, study.speed);
  DormandPrince integrator(motion, 0.0, scaled(study.disc, large_motion(study.disc)),
                           {1e-13, study.period() / 10.0, study.period() / 100.0});
  return integrator.at(t);
}

double relative_error(const Case& study, double t, const Eigen::VectorXd& y)
{
  const Eigen::VectorXd exact = truth(study, t);
  return (y - exact).norm() / exact.norm();
}

/// A run of the case by one of our integrators, to a single sample at its end.
Point motion_point(const Case& study, IntegratorKind kind, double setting)
{
  const bool fixed = kind == IntegratorKind::splitting || kind == IntegratorKind::exponential;
  const bool by_tolerance = kind == IntegratorKind::dormand_prince;
  const double steps = by_tolerance ? 4.0 : setting, omega_h = 2.0 * pi / steps;
  const IntegratorChoice choice{kind, static_cast<int>(steps),
                                by_tolerance ? setting : omega_h * omega_h * omega_h / 12.0, ""};
  const auto n = fixed ? static_cast<std::int64_t>(study.duration * steps / study.period()) : 1;
  const double step = fixed ? study.period() / steps : 2.0 * study.duration;
  const TransientCase constant_speed{
      .speed = study.speed, .duration = study.duration, .initial_pad_displacement = 0.0};
  std::int64_t evaluations = 0;
  ModalState end;
  const double time = seconds_of([&] {
    const auto run = transient_steps(study.disc, study.options, constant_speed, choice, step,
                                     large_motion(study.disc));
    for (std::int64_t i = 0; i < n; ++i) run->next();
    end = run->state();
    evaluations = run->n_contact_evaluations();
  });
  const double t = (double(n) - 0.5) * step;
  Eigen::VectorXd y = scaled(study.disc, end);
  return {name_of(kind), setting, relative_error(study, t, y), time / t, double(evaluations) / t};
}

Point cvode_point(const Case& study, CvodeMethod method, double tolerance)
{
  RotatingDisc motion(study.disc, study.options, study.speed);
  Eigen::VectorXd y;
  const double time = seconds_of([&] {
    y = cvode(motion, scaled(study.disc, large_motion(study.disc)), study.duration, tolerance,
              method);
  });
  const auto evaluations = double(motion.n_evaluations());
  return {method == CvodeMethod::adams ? "cvode-adams" : "cvode-bdf", tolerance,
          relative_error(study, study.duration, y), time / study.duration,
          evaluations / study.duration};
}

/// Growth rate of a run from a tiny displacement, against the eigenvalue.
Point growth_point(const Case& study, IntegratorKind kind, double setting)
{
  TransientCase run{.speed = study.speed,
                    .duration = study.duration,
                    .initial_pad_displacement = 1e-8,
                    .integrator = kind};
  if (kind == IntegratorKind::dormand_prince)
    run.growth_error = setting;
  else
    run.steps_per_period = static_cast<int>(setting);
  Transient result{};
  const double time =
      seconds_of([&] { result = transient(FlexibleDisc(study.disc, study.options), run); });
  const double exact =
      least_stable_eigenvalue(state_matrix(inertial_disc(study.disc), study.options, study.speed))
          .real();
  return {name_of(kind), setting, std::abs(result.growth_rate.value_or(NAN) - exact),
          time / study.duration, double(result.n_contact_evaluations) / study.duration};
}

std::vector<double> settings_of(IntegratorKind kind, bool smallest)
{
  if (kind == IntegratorKind::dormand_prince)
    return smallest ? std::vector{1e-6} : std::vector{1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10};
  if (kind == IntegratorKind::generalised_alpha)
    return smallest ? std::vector{40.0} : std::vector{20.0, 40.0, 80.0, 160.0, 320.0};
  return smallest ? std::vector{20.0} : std::vector{8.0, 12.0, 16.0, 20.0, 28.0, 40.0, 80.0, 160.0};
}

constexpr IntegratorKind kinds[] = {IntegratorKind::splitting, IntegratorKind::exponential,
                                    IntegratorKind::dormand_prince,
                                    IntegratorKind::generalised_alpha};

std::string json_of(const Case& study, const std::string& error, const std::vector<Point>& points)
{
  std::string text = fmt::format(
      "{{\"name\": \"{}\", \"modes\": {}, \"duration_s\": {}, \"error\": \"{}\", \"points\": [",
      study.name, study.disc.n_modes(), study.duration, error);
  for (std::size_t i = 0; i < points.size(); ++i) {
    text += fmt::format(
        "{}\n  {{\"integrator\": \"{}\", \"setting\": {:g}, \"error\": {:.3e}, \"time\": {:.3e}, "
        "\"evaluations\": {:.4e}}}",
        i == 0 ? "" : ",", points[i].integrator, points[i].setting, points[i].error, points[i].time,
        points[i].evaluations);
  }
  return text + "]}";
}

std::string motion_json(const Case& study, bool smallest)
{
  std::vector<Point> points;
  for (const IntegratorKind kind : kinds)
    for (const double setting : settings_of(kind, smallest))
      points.push_back(motion_point(study, kind, setting));
  if (has_cvode)
    for (const CvodeMethod method : {CvodeMethod::adams, CvodeMethod::bdf})
      for (const double tolerance : settings_of(IntegratorKind::dormand_prince, smallest))
        points.push_back(cvode_point(study, method, tolerance));
  return json_of(study, "of the state, relative", points);
}

std::string growth_json(const Case& study, bool smallest)
{
  std::vector<Point> points;
  for (const IntegratorKind kind : kinds) {
    std::vector<double> settings = settings_of(kind, smallest);
    if (kind == IntegratorKind::dormand_prince && !smallest) settings = {1e-1, 1e-2, 1e-3, 1e-4};
    for (const double setting : settings) points.push_back(growth_point(study, kind, setting));
  }
  return json_of(study, "of the growth rate, 1/s", points);
}

/// Largest error of all growth rates by the eigenvalues of one discrete step, near 4.28 pi.
std::string discrete_json(const Disc& disc, IntegratorKind kind)
{
  std::string text = fmt::format("{{\"modes\": {}, \"integrator\": \"{}\", \"points\": [",
                                 disc.n_modes(), name_of(kind));
  const InertialDisc inertial = inertial_disc(disc);
  for (const int steps : {10, 20, 40, 80, 160, 320}) {
    text += fmt::format("{}[{}, {:.3e}]", steps == 10 ? "" : ", ", steps,
                        growth_error_of(kind, inertial, reference_options(), 4.28 * pi, steps));
  }
  return text + "]}";
}

}  // namespace

int main(int argc, char** argv)
{
  const bool smallest = argc == 3 && std::string(argv[1]) == "--smallest";
  if (argc != 2 && !smallest) {
    fmt::print(stderr, "usage: squeal_work_precision [--smallest] FILE.json\n");
    return 2;
  }
  const Disc pair = disc_of({kirchhoff_3()}), all = disc_of(kirchhoff_modes());
  const SquealOptions bilateral = reference_options(),
                      unilateral = reference_options(ContactLaw::unilateral);
  const double squeal = 1.0 / 1750.0;
  const std::vector<Target> targets = measured_targets(smallest);
  for (const Target& target : targets) {
    fmt::print("{}: {:.3g} {} (target {:g})\n", target.name, target.measured, target.unit,
               target.limit);
  }
  std::ofstream file(argv[argc - 1]);
  file << "{\"targets\": " << json_of(targets) << ",\n\"discrete\": [\n"
       << discrete_json(pair, IntegratorKind::splitting) << ",\n"
       << discrete_json(pair, IntegratorKind::generalised_alpha) << ",\n"
       << discrete_json(all, IntegratorKind::splitting) << ",\n"
       << discrete_json(all, IntegratorKind::generalised_alpha) << "],\n\"cases\": [\n"
       << growth_json({"growth at 4.28 pi", pair, bilateral, 4.28 * pi, smallest ? 0.3 : 2.0},
                      smallest)
       << ",\n"
       << motion_json({"two modes with contact loss", pair, unilateral, 6.0 * pi, 20.0 * squeal},
                      smallest)
       << ",\n"
       << motion_json({"35 modes with contact loss", all, unilateral, 6.0 * pi, 5.0 * squeal},
                      smallest)
       << "\n],\n\"hard_cases\": " << hard_cases_json(smallest) << "}\n";
  return file ? 0 : 1;
}
