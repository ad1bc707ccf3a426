#pragma once

#include <optional>

#include "common/error.hpp"
#include "squeal/motion/integrator.hpp"

namespace chladni::squeal {

/// Events that are kept: a run that has more of them may be long, and its memory may not grow.
inline constexpr std::size_t events_max = 100000;

/// Sides that change again and again at one time: no motion leads on from there.
class StuckContact : public Error {
 public:
  using Error::Error;
};

/// The explicit Runge-Kutta method of order 8 by Dormand and Prince with an error estimate of
/// orders 5 and 3, dense output of order 7 and located zeros of the switching functions: at each of
/// them a step ends, so that the method keeps its order. A function that passes zero and returns
/// within one step is seen too.
/// Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993),
/// sections II.5, II.6.
class DormandPrince final : public Integrator {
 public:
  /// @param motion  outlives the integrator, which sets its sides
  DormandPrince(SwitchedMotion& motion, double t, const Eigen::VectorXd& y,
                const StepControl& control);

  /// @throws StuckContact when the sides change again and again without progress in time.
  const Eigen::VectorXd& at(double t) override;

  /// Takes one more step, between `begin` and `end` of which `at` then interpolates. The sides of
  /// the motion are those of the next step.
  struct Span {
    double begin, end;  ///< s
  };
  Span next_step();

  /// The first `events_max` zeros of the switching functions, by rising time.
  const std::vector<SwitchEvent>& events() const { return events_; }

  /// All that the motion to come depends on; the sides are the motion's.
  void exchange(StateArchive& archive);

 private:
  /// A zero of the switching function i within the step under trial.
  struct Crossing {
    Eigen::Index i;
    double fraction;  ///< of the step
  };

  void advance();
  double try_step(double step);
  void accept(double step);
  void cross(const Crossing& crossing, double step);
  const Eigen::VectorXd& slope(int stage, const Eigen::VectorXd& y);
  void extend();
  const Eigen::VectorXd& interpolated(double fraction);
  double switch_at(Eigen::Index i, double fraction);
  std::optional<Crossing> first_crossing();
  std::optional<double> crossing_of(Eigen::Index i, const Eigen::MatrixXd& samples);

  SwitchedMotion& motion_;
  StepControl control_;
  double t_;           ///< end of the last accepted step, s
  double t_begin_;     ///< its begin, s
  double step_;        ///< accepted or under trial, s
  double step_next_;   ///< s
  Eigen::VectorXd y_;  ///< at t_
  Eigen::VectorXd begin_;
  Eigen::VectorXd end_;
  Eigen::VectorXd stage_;
  Eigen::VectorXd sample_;
  Eigen::MatrixXd K_;         ///< [2 n x 16] slopes of the stages
  Eigen::MatrixXd s_;         ///< [n_switches x 16] switching functions at the stages
  Eigen::MatrixXd dense_;     ///< [2 n x 7] coefficients of the interpolation over the step
  bool extended_ = false;     ///< dense_ belongs to the step
  bool knows_slope_ = false;  ///< stage 12 belongs to (t_, y_) on the present sides
  int n_stuck_ = 0;           ///< changes of side since the last step of any length
  std::vector<SwitchEvent> events_;
};

}  // namespace chladni::squeal
