#pragma once

#include <optional>

#include "common/error.hpp"
#include "squeal/motion/motion.hpp"

namespace chladni::squeal {

/// Largest number of stored events, so that the memory of a long run is limited.
inline constexpr std::size_t events_max = 100000;

/// Thrown when a contact switches endlessly at one time, so that the motion cannot be continued.
class StuckContact : public Error {
 public:
  using Error::Error;
};

/// The explicit Runge-Kutta method of order 8 by Dormand and Prince with error estimates of order 5
/// and 3, dense output of order 7 and located zeros of the switching functions. A step ends at each
/// zero, so that the method keeps its order. A function that crosses zero and returns within one
/// step is detected too.
/// Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993),
/// sections II.5, II.6.
class DormandPrince final : public Integrator {
 public:
  /// @param motion  must outlive the integrator, which sets its sides
  DormandPrince(SwitchedMotion& motion, double t, const Eigen::VectorXd& y,
                const StepControl& control);

  /// See Integrator.
  /// @throws StuckContact when sides switch again and again without progress in time.
  const Eigen::VectorXd& at(double t) override;

  /// Takes one more step and returns its interval, in which `at` then interpolates. The sides of
  /// the motion are then those of the next step.
  struct Span {
    double begin, end;  ///< s
  };
  Span next_step();

  /// The first `events_max` zeros of the switching functions, by ascending time.
  const std::vector<SwitchEvent>& events() const { return events_; }

 private:
  /// A zero of the switching function i within the step being tried.
  struct Crossing {
    Eigen::Index i;
    double fraction;  ///< fraction of the step
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
  double t_begin_;     ///< begin of the last accepted step, s
  double step_;        ///< step accepted or being tried, s
  double step_next_;   ///< s
  Eigen::VectorXd y_;  ///< at t_
  Eigen::VectorXd begin_;
  Eigen::VectorXd end_;
  Eigen::VectorXd stage_;
  Eigen::VectorXd sample_;
  Eigen::MatrixXd K_;         ///< [2 n x 16] rates of the stages
  Eigen::MatrixXd s_;         ///< [n_switches x 16] switching functions at the stages
  Eigen::MatrixXd dense_;     ///< [2 n x 7] coefficients of the interpolation
  bool extended_ = false;     ///< dense_ belongs to the present step
  bool knows_slope_ = false;  ///< stage 12 is the rate at (t_, y_) on the present sides
  int n_stuck_ = 0;           ///< changes of sides since the last step with progress in time
  std::vector<SwitchEvent> events_;
};

}  // namespace chladni::squeal
