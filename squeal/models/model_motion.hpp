#pragma once

#include <Eigen/Core>
#include <complex>
#include <utility>

#include "squeal/brake/switching_contact.hpp"
#include "squeal/motion/motion.hpp"
#include "squeal/numerics.hpp"

namespace chladni::squeal {

/// Rate f and switching functions s at one state.
template <class Scalar>
struct SwitchedRate {
  Eigen::VectorX<Scalar> f;
  Eigen::VectorX<Scalar> s;
};

/// A model without a modal body as a motion with switching contact; derivatives are computed by
/// complex steps. `Equations` has `evaluate(x, branches)` for real and complex x, which returns a
/// SwitchedRate with each pad on its branch (contact_branch.hpp), and `contact(x)`, which returns a
/// ContactResult.
template <class Equations>
class ModelMotion final : public AutonomousMotion {
 public:
  /// Properties of the model that the equations do not provide.
  struct Properties {
    Eigen::Index size;        ///< number of entries of x
    Eigen::Index n_switches;  ///< number of contacts
    double omega_highest;     ///< highest angular frequency, rad/s
    ContactLaw law;
  };

  ModelMotion(Equations equations, const Properties& properties)
      : equations_(std::move(equations)),
        properties_(properties),
        branches_(Eigen::VectorXd::Ones(properties.n_switches))
  {
    at_.s = Eigen::VectorXd::Zero(n_switches());
  }

  Eigen::Index size() const override { return properties_.size; }
  double omega_highest() const override { return properties_.omega_highest; }

  const Eigen::VectorXd& rate(double /*t*/, const Eigen::VectorXd& x) override
  {
    ++n_evaluations_;
    at_ = equations_.template evaluate<double>(x, branches_);
    at_.s.conservativeResize(n_switches());
    return at_.f;
  }
  const Eigen::VectorXd& switches() const override { return at_.s; }
  double side(Eigen::Index i) const override { return branches_[i] == 1.0 ? 1.0 : -1.0; }
  void set_side(Eigen::Index i, double side) override
  {
    branches_[i] = side > 0.0 ? 1.0 : pulled_branch(properties_.law);
  }

  Eigen::MatrixXd jacobian(const Eigen::VectorXd& x) override
  {
    using Complex = std::complex<double>;
    n_evaluations_ += size();
    Eigen::MatrixXd J(size(), size());
    for (Eigen::Index j = 0; j < size(); ++j) {
      Eigen::VectorXcd at = x.cast<Complex>();
      at[j] += Complex(0.0, complex_step);
      J.col(j) = equations_.template evaluate<Complex>(at, branches_).f.imag() / complex_step;
    }
    return J;
  }

  ContactResult<double> first_contact(const Eigen::VectorXd& x) override
  {
    ++n_evaluations_;
    return equations_.contact(x);
  }

 private:
  /// The signed law has a single branch, so nothing switches.
  Eigen::Index n_switches() const
  {
    return properties_.law == ContactLaw::signed_force ? 0 : properties_.n_switches;
  }

  Equations equations_;
  Properties properties_;
  Eigen::VectorXd branches_;
  SwitchedRate<double> at_;
};

}  // namespace chladni::squeal
