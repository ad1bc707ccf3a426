#include "cases/squeal/brake_fmu.hpp"

#include <fmt/format.h>

#include <array>
#include <cassert>
#include <numbers>
#include <utility>

#include "cases/squeal/squeal_case.hpp"
#include "common/error.hpp"
#include "squeal/fmu/brake_simulation.hpp"
#include "squeal/fmu/driven_brake.hpp"
#include "squeal/models/flexible_disc.hpp"

namespace chladni::cases {
namespace {

namespace formats = mbs_export::formats;
using formats::FmuVariable;
using Kind = FmuVariable::Kind;

/// As the scene has it, for where its inputs begin.
double first_speed(const squeal::StudyOptions& study)
{
  if (study.transient) return study.transient->speed;
  if (study.limit_cycle_direct) return study.limit_cycle_direct->speed;
  if (study.speeds.to > 0.0) return study.speeds.to;
  return 1.0;
}

struct PadVariable {
  const char *symbol, *unit, *description;
};
constexpr std::array<PadVariable, brake_fmu::n_pad_outputs> pad_variables{
    {{"N", "N", "normal force"},
     {"S", "N", "force along the axis of the pad"},
     {"f_r", "N", "radial friction force on the disc"},
     {"f_t", "N", "circumferential friction force on the disc"},
     {"z", "m", "height of the contact point"},
     {"v", "m/s", "its velocity"}}};

class Variables {
 public:
  explicit Variables(const brake_fmu::BrakeModel& model)
      : model_(model), references_(model.n_modes(), model.pads.n_pads())
  {}

  std::vector<FmuVariable> all()
  {
    add({.name = "time", .description = "time", .kind = Kind::independent, .unit = "s"});
    add({.name = "steps_per_period",
         .description = "steps of co-simulation in a period of the fastest oscillation",
         .kind = Kind::parameter,
         .start = brake_fmu::usual_steps_per_period});
    add_inputs();
    add({.name = "torque",
         .description = "of friction on the disc about its axis",
         .kind = Kind::output,
         .unit = "N.m",
         .depends_on_all = true});
    for (std::size_t pad = 0; pad < model_.pads.n_pads(); ++pad)
      for (const char* side : {"upper", "lower"}) add_outputs(pad, side);
    add_states();
    assert(variables_.size() == references_.end());
    return std::move(variables_);
  }

 private:
  void add(FmuVariable variable) { variables_.push_back(std::move(variable)); }

  void add_inputs()
  {
    add({.name = "speed",
         .description = "of the disc",
         .kind = Kind::input,
         .unit = "rad/s",
         .start = model_.speed});
    add({.name = "friction",
         .description = "coefficient of sliding friction",
         .kind = Kind::input,
         .start = model_.friction});
    const std::vector<double> preloads = brake_fmu::preloads_of(model_.pads);
    for (std::size_t pad = 0; pad < preloads.size(); ++pad) {
      add({.name = fmt::format("pad[{}].preload", pad + 1),
           .description = "of each pad of the pair",
           .kind = Kind::input,
           .unit = "N",
           .start = preloads[pad]});
    }
  }

  void add_outputs(std::size_t pad, const char* side)
  {
    for (const PadVariable& variable : pad_variables) {
      add({.name = fmt::format("pad[{}].{}.{}", pad + 1, side, variable.symbol),
           .description = fmt::format("{}, {} pad", variable.description, side),
           .kind = Kind::output,
           .unit = variable.unit,
           .depends_on_all = true});
    }
  }

  void add_modes(const char* name, Kind kind, bool is_derivative)
  {
    const Eigen::Index n_disc = model_.disc.n_modes();
    for (Eigen::Index i = 0; i < model_.n_modes(); ++i) {
      const bool is_of_disc = i < n_disc;
      const double omega = is_of_disc ? model_.disc.omega[i] : model_.pads.omega[i - n_disc];
      const std::string full = fmt::format("mode[{}].{}", i + 1, name);
      FmuVariable variable{.name = is_derivative ? fmt::format("der({})", full) : full,
                           .description = fmt::format("of the mode of the {} at {:.6g} Hz",
                                                      is_of_disc ? "disc" : "pads",
                                                      omega / (2.0 * std::numbers::pi)),
                           .kind = kind,
                           .depends_on_all = is_derivative};
      if (is_derivative) variable.derivative_of = derivative_of_++;
      add(std::move(variable));
    }
  }

  void add_states()
  {
    add({.name = "angle",
         .description = "by which the disc has turned",
         .kind = Kind::state,
         .unit = "rad"});
    add_modes("q", Kind::state, false);
    add_modes("q_dot", Kind::state, false);
    derivative_of_ = references_.angle();
    add({.name = "der(angle)",
         .description = "speed of the disc",
         .kind = Kind::derivative,
         .unit = "rad/s",
         .derivative_of = derivative_of_++,
         .depends_on = {brake_fmu::BrakeReferences::speed}});
    const std::size_t first = variables_.size();
    add_modes("q", Kind::derivative, true);
    for (std::size_t i = first; i < variables_.size(); ++i) {
      variables_[i].depends_on_all = false;
      variables_[i].depends_on = {references_.q_dot() + static_cast<std::uint32_t>(i - first)};
    }
    add_modes("q_dot", Kind::derivative, true);
  }

  const brake_fmu::BrakeModel& model_;
  brake_fmu::BrakeReferences references_;
  std::uint32_t derivative_of_ = 0;
  std::vector<FmuVariable> variables_;
};

/// The coefficient is an input of the FMU, one for all pads.
void require_one_friction(const squeal::PadSystem& pads)
{
  const squeal::FrictionLaw& first = pads.points.front().contact.friction;
  for (const squeal::PointPair& point : pads.points) {
    const squeal::FrictionLaw& law = point.contact.friction;
    if (!law.table && law.kinetic == first.kinetic && law.rise == first.rise) continue;
    throw Error(
        "squeal.friction: an FMU of a brake has one coefficient of friction for all pads as its "
        "input; tables, and pads with a friction of their own, have no place in it");
  }
}

brake_fmu::BrakeModel brake_model(const squeal::FlexibleDisc& brake)
{
  const squeal::SquealOptions& options = brake.options();
  brake_fmu::BrakeModel model{
      .token = {},
      .disc = brake.disc(),
      .pads = squeal::pad_system(options, squeal::ring_places(brake.disc())),
      .friction = 0.0,
      .speed = first_speed(options.study)};
  require_one_friction(model.pads);
  model.friction = model.pads.points.front().contact.friction.kinetic;
  return model;
}

}  // namespace

formats::Fmu fmu_of_brake(const scene::Scene& scene, const BrakeFmuOptions& options)
{
  if (!scene.squeal) {
    throw Error(
        fmt::format("{}: an FMU of a brake needs [squeal] with a disc of a body, its ring and pads",
                    scene.path));
  }
  const SquealFiles files = squeal_files(scene, options.folder, {});
  const auto body = body_for_squeal(scene, files, options.stale);
  SquealCase made = squeal_case(scene, body, files, options.stale);
  brake_fmu::BrakeModel model = brake_model(*made.brake->body());
  const std::vector<FmuVariable> variables = Variables(model).all();
  model.token = formats::fmu_token(brake_fmu::packed(model), variables);
  const std::string description = formats::fmu_description(variables,
                                                           {.name = scene.title,
                                                            .identifier = options.identifier,
                                                            .token = model.token,
                                                            .has_directional_derivatives = false},
                                                           options.version);
  made.notes.emplace_back(
      "motions are counted from the sliding equilibrium; a change of the speed is felt by friction "
      "and Coriolis terms, not as a force of inertia");
  return {.archive = formats::fmu_archive({.version = options.version,
                                           .identifier = options.identifier,
                                           .description = description,
                                           .library = "chladni-fmu-brake.so",
                                           .resource = brake_fmu::brake_file,
                                           .model = brake_fmu::packed(model)}),
          .notes = std::move(made.notes)};
}

}  // namespace chladni::cases
