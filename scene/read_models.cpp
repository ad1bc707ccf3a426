#include <array>
#include <charconv>
#include <numbers>
#include <utility>

#include "scene/readers.hpp"

namespace chladni::scene {

using squeal::Drive, squeal::RigidEquations;

namespace {

void check_ring(const Table& table, std::string_view key, const std::string& ring,
                const Scene& scene)
{
  const std::vector<std::string> rings = ring_names(scene.mesh);
  if (!contains(rings, ring)) table.refuse(key, no_such_name("ring", ring, rings));
  if (!contains(scene.interface_nodes, ring))
    table.refuse(key, "must also be in interface.nodes; otherwise the body does not contain it");
}

/// ring = "track", or { inboard = "track_in", outboard = "track_out" }: the second ring is empty
/// for one ring alone.
std::pair<std::string, std::string> read_rings(const Table& squeal, const Scene& scene)
{
  if (!squeal.is_table("ring")) {
    check_ring(squeal, "ring", squeal.text("ring"), scene);
    return {squeal.text("ring"), {}};
  }
  const Table ring = squeal.table("ring");
  for (const char* key : {"inboard", "outboard"}) check_ring(ring, key, ring.text(key), scene);
  if (ring.text("inboard") == ring.text("outboard")) {
    ring.refuse("outboard",
                "must be another ring than inboard; one ring for both planes is ring = \"NAME\"");
  }
  return {ring.text("inboard"), ring.text("outboard")};
}

/// squeal.contact_planes = [lower, upper], m
std::optional<std::array<double, 2>> read_planes(const Table& squeal)
{
  if (!squeal.has("contact_planes")) return std::nullopt;
  const std::vector<double> z = squeal.numbers("contact_planes");
  if (z.size() != 2 || !(z[1] > z[0]))
    squeal.refuse("contact_planes", "must be [z of the lower plane, z of the upper one], in m");
  return std::array{z[0], z[1]};
}

/// The rings, what of them pads feel, and the contact planes.
void read_faces(squeal::SquealOptions& options, const Table& squeal, const Scene& scene)
{
  const auto [ring, opposite] = read_rings(squeal, scene);
  const std::optional<std::array<double, 2>> planes = read_planes(squeal);
  options.ring = ring;
  if (squeal.only_one_of({"thickness", "contact_planes"}) == "thickness")
    options.thickness = squeal.number("thickness");
  else
    options.thickness = (*planes)[1] - (*planes)[0];
  if (planes || !opposite.empty())
    options.planes = squeal::ContactPlanes{.opposite_ring = opposite, .heights = planes};
  if (!squeal.has("slopes_from")) return;
  options.slopes_from = squeal.texts("slopes_from");
  if (options.slopes_from.empty()) squeal.refuse("slopes_from", "must name at least one ring");
  for (const std::string& name : options.slopes_from)
    check_ring(squeal, "slopes_from", name, scene);
}

/// The rings of all grids are those of the body.
void check_grids(const Table& squeal, const Scene& scene)
{
  for (const Table& pad : squeal.tables("pads")) {
    if (!pad.has("grid") || !pad.table("grid").has("rings")) continue;
    const Table grid = pad.table("grid");
    if (!squeal.is_table("ring")) {
      for (const std::string& ring : grid.texts("rings")) check_ring(grid, "rings", ring, scene);
      continue;
    }
    for (const Table& pair : grid.tables("rings"))
      for (const char* key : {"inboard", "outboard"}) check_ring(pair, key, pair.text(key), scene);
  }
}

/// The n of "nodal-diameters n"; absent when the text is anything else.
std::optional<int> nodal_diameters(const std::string& text)
{
  constexpr std::string_view prefix = "nodal-diameters ";
  if (!text.starts_with(prefix)) return std::nullopt;
  int n = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + prefix.size(), end, n);
  if (error != std::errc{} || rest != end || n < 1) return std::nullopt;
  return n;
}

squeal::ModeChoice read_modes(const Table& squeal)
{
  squeal::ModeChoice modes;
  if (squeal.has("quasi_static_above_Hz"))
    modes.quasi_static_above = 2.0 * std::numbers::pi * squeal.number("quasi_static_above_Hz");
  if (!squeal.has("use_modes")) return modes;
  if (modes.quasi_static_above &&
      !(!squeal.is_list("use_modes") && squeal.text("use_modes") == "all"))
    squeal.refuse("quasi_static_above_Hz",
                  "needs use_modes = \"all\": modes that are named have their inertia");
  if (squeal.is_list("use_modes")) {
    modes.list = read_mode_list(squeal, "use_modes");
    return modes;
  }
  const std::string text = squeal.text("use_modes");
  modes.nodal_diameters = nodal_diameters(text);
  if (text != "all" && !modes.nodal_diameters) {
    squeal.refuse("use_modes",
                  "must be \"all\", \"nodal-diameters N\" with N >= 1, or a list of mode numbers");
  }
  return modes;
}

}  // namespace

bool read_radiation(const Table& root)
{
  if (!root.has("squeal")) return false;
  const Table squeal = root.table("squeal");
  return squeal.has("radiation") && squeal.truth("radiation");
}

std::optional<squeal::SquealOptions> read_squeal(const Table& root, const Scene& scene)
{
  if (!root.has("squeal")) return std::nullopt;
  const Table squeal = root.table("squeal");
  squeal::SquealOptions options{};
  read_faces(options, squeal, scene);
  options.modes = read_modes(squeal);
  options.friction = read_friction(squeal);
  options.contact = read_contact(squeal);
  options.pads = read_pads(squeal);
  check_grids(squeal, scene);
  if (squeal.has("asymmetry")) {
    options.keeps_asymmetry =
        squeal.choice<bool>("asymmetry", {{"averaged", false}, {"kept", true}});
  }
  options.study = read_study(squeal, StudyOf::body);
  options.study.rotation_method = read_rotation_method(squeal);
  return options;
}

namespace {

enum class ModelChoice {
  flexible_disc,
  rigid_disc,
  oscillator,
  two_masses,
  tilting_block,
  assembly
};

/// The only pad pair of a rigid disc; its angle does not matter.
Table read_only_pad(const Table& squeal)
{
  const std::vector<Table> pads = squeal.tables("pads");
  if (pads.size() != 1) squeal.refuse("pads", "must hold one pad pair: the rigid disc has no more");
  return pads.front();
}

/// A drive by a constant moment is in balance with a constant coefficient only.
Drive read_drive(const Table& table, const squeal::FrictionLaw& friction)
{
  if (!table.has("drive")) return Drive::speed;
  const auto drive =
      table.choice<Drive>("drive", {{"speed", Drive::speed}, {"moment", Drive::moment}});
  if (drive == Drive::moment && (friction.rise != 0.0 || friction.regularisation > 0.0))
    table.refuse("drive", "the constant moment 2 mu r_0 N_0 needs a constant friction coefficient");
  return drive;
}

squeal::RigidDiscStudy read_rigid_disc(const Table& squeal)
{
  const Table table = squeal.table("rigid_disc");
  const Table pad = read_only_pad(squeal);
  const squeal::FrictionLaw friction = read_plain_friction(squeal);
  squeal::RigidDiscStudy study{.disc = {.Theta = table.number("diametral_inertia"),
                                        .Phi = table.number("axial_inertia"),
                                        .k_t = table.number("stiffness"),
                                        .d_t = table.number("damping"),
                                        .radius = table.number("pad_radius"),
                                        .thickness = squeal.number("thickness"),
                                        .spring = read_pad_spring(pad),
                                        .damping = pad.number("damping"),
                                        .preload = pad.number("preload"),
                                        .friction = friction,
                                        .law = read_contact(squeal)},
                               .drive = read_drive(table, friction)};
  if (table.has("equations")) {
    study.equations = table.choice<RigidEquations>(
        "equations",
        {{"nonlinear", RigidEquations::nonlinear}, {"linear", RigidEquations::linear}});
  }
  return study;
}

squeal::Oscillator read_oscillator(const Table& squeal)
{
  const Table table = squeal.table("oscillator");
  const auto stiffness = [&](const char* key) { return table.number(key); };
  const auto damping = [&](const char* key) { return table.number(key); };
  squeal::Oscillator oscillator{.mass = table.number("mass"),
                                .k_x = stiffness("stiffness_along"),
                                .k_y = stiffness("stiffness_normal"),
                                .k_xy = table.number("stiffness_coupling"),
                                .d_x = damping("damping_along"),
                                .d_y = damping("damping_normal"),
                                .contact_stiffness = stiffness("contact_stiffness"),
                                .preload = table.number("preload"),
                                .radius = table.number("radius"),
                                .friction = read_plain_friction(squeal),
                                .law = read_contact(squeal)};
  if (!(oscillator.k_xy * oscillator.k_xy < oscillator.k_x * oscillator.k_y)) {
    table.refuse("stiffness_coupling",
                 "its square must be below stiffness_along times stiffness_normal, or the springs "
                 "do not hold the mass");
  }
  return oscillator;
}

squeal::TwoMasses read_two_masses(const Table& squeal)
{
  const Table table = squeal.table("two_masses");
  return {.m_1 = table.number("pad_mass"),
          .k_1 = table.number("pad_stiffness"),
          .d_1 = table.number("pad_damping"),
          .m_2 = table.number("disc_mass"),
          .k_2 = table.number("disc_stiffness"),
          .d_2 = table.number("disc_damping"),
          .preload = table.number("preload"),
          .radius = table.number("radius"),
          .friction = read_plain_friction(squeal)};
}

squeal::TiltingBlock read_tilting_block(const Table& squeal)
{
  const Table table = squeal.table("tilting_block");
  return {.mass = table.number("mass"),
          .inertia = table.number("inertia"),
          .k_x = table.number("stiffness_along"),
          .k_y = table.number("stiffness_normal"),
          .k_phi = table.number("stiffness_tilting"),
          .d_x = table.number("damping_along"),
          .d_y = table.number("damping_normal"),
          .d_phi = table.number("damping_tilting"),
          .height = table.number("height"),
          .foot_length = table.number("foot_length"),
          .foot_offset = table.number("foot_offset"),
          .contact_stiffness = table.number("contact_stiffness"),
          .preload = table.number("preload"),
          .radius = table.number("radius"),
          .friction = read_plain_friction(squeal),
          .law = read_contact(squeal)};
}

/// The model that a scene asks for; a scene without [squeal] asks for none of these.
ModelChoice read_choice(const Table& root)
{
  if (!root.has("squeal")) return ModelChoice::flexible_disc;
  const Table squeal = root.table("squeal");
  if (!squeal.has("model")) return ModelChoice::flexible_disc;
  return squeal.choice<ModelChoice>("model", {{"flexible disc", ModelChoice::flexible_disc},
                                              {"rigid disc", ModelChoice::rigid_disc},
                                              {"oscillator", ModelChoice::oscillator},
                                              {"two masses", ModelChoice::two_masses},
                                              {"tilting block", ModelChoice::tilting_block},
                                              {"assembly", ModelChoice::assembly}});
}

/// Tables of an assembly in the scene of another model are a slip of `model`.
void refuse_parts(const Table& root)
{
  // Not by has(), which would let messages about other keys name these.
  const std::vector<std::string> there = root.names();
  for (const char* key : {"part", "joint", "contact"})
    if (contains(there, key))
      root.refuse(key, "belongs to an assembly: give [squeal] with model = \"assembly\"");
}

/// An assembly has small motions about sliding alone.
void check_linear(const Table& squeal, const squeal::StudyOptions& study)
{
  const std::vector<std::string> linear{"eigenvalues",   "critical-speed",  "stability",
                                        "stability-map", "critical-values", "gradients"};
  for (std::size_t i = 0; i < study.analyses.size(); ++i)
    if (!contains(linear, study.analyses[i])) {
      squeal.refuse_element(
          "analyses", i,
          "is not available for an assembly, whose contact is linear; available are " +
              quoted_list(linear));
    }
  if (study.transient) {
    squeal.refuse("transient",
                  "is not available for an assembly, whose contact is linear; take it out");
  }
}

}  // namespace

std::optional<squeal::ModelOptions> read_squeal_model(const Table& root)
{
  const ModelChoice choice = read_choice(root);
  if (choice != ModelChoice::assembly) refuse_parts(root);
  if (choice == ModelChoice::flexible_disc) return std::nullopt;
  const Table squeal = root.table("squeal");
  squeal::ModelOptions options{};
  if (choice == ModelChoice::rigid_disc)
    options.model = read_rigid_disc(squeal);
  else if (choice == ModelChoice::oscillator)
    options.model = read_oscillator(squeal);
  else if (choice == ModelChoice::two_masses)
    options.model = read_two_masses(squeal);
  else if (choice == ModelChoice::tilting_block)
    options.model = read_tilting_block(squeal);
  else
    options.model = read_assembly(root);
  options.study = read_study(squeal, StudyOf::model);
  if (choice == ModelChoice::assembly) check_linear(squeal, options.study);
  const std::optional<squeal::TransientCase>& transient = options.study.transient;
  if (transient &&
      (transient->integrator != squeal::IntegratorKind::automatic || !transient->is_constant())) {
    squeal.refuse("transient",
                  "integrator, speed_program and preload_program are for a flexible disc; this "
                  "model takes steps of "
                  "order 8 at a constant speed");
  }
  return options;
}

}  // namespace chladni::scene
