// The columns of the transformation, as the settings say.
#include "reduce/free_interface.hpp"
#include "reduce/plugin/cms_impl.hpp"
#include "reduce/plugin/free_model.hpp"
#include "reduce/tolerance_search.hpp"

namespace chladni::reduce::plugin {

namespace {

petsc::Matrix timed_constraint_modes(CMS cms)
{
  Phase phase(cms, events.constraint, "constraint modes");
  petsc::Matrix Psi = constraint_modes(cms->inside->set_up->K_ss, cms->inside->set_up->K_blocks);
  phase.done();
  return Psi;
}

/// The fixed-interface modes that the user wants, with nothing for Guyan.
std::optional<FixedInterfaceModes> modes_as_told(CMS cms)
{
  const SetUp& set_up = *cms->inside->set_up;
  const ReduceOptions& wanted = cms->inside->settings.options;
  if (wanted.method == Method::guyan) return std::nullopt;
  Phase phase(cms, events.modes, "fixed-interface modes");
  FixedInterfaceModes modes = fixed_interface_modes(set_up.K_ss, set_up.M_blocks.ss, wanted);
  phase.done();
  return modes;
}

/// As few modes as keep the tolerance.
FixedInterfaceModes modes_to_tolerance(CMS cms, Mat Psi)
{
  const SetUp& set_up = *cms->inside->set_up;
  const Settings& settings = cms->inside->settings;
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(cms));
  // What the estimates from the small matrices and those from the full ones may differ by.
  constexpr double margin = 0.99;
  const ModesByTolerance& wanted = *settings.options.tolerance;
  // Frequencies of too few modes are too high: some beyond the range belong into it.
  constexpr double beyond = 1.25;
  Settings further = settings;
  further.options.tolerance->up_to_Hz *= beyond;
  ToleranceSearch search(
      {.K_ss = set_up.K_ss, .Psi = Psi, .K = set_up.K_blocks, .M = set_up.M_blocks},
      {.tolerance = margin * wanted.tolerance, .up_to_Hz = wanted.up_to_Hz},
      [&](const ReducedModel& model) {
        return certified_pairs(free_model_everywhere(model, comm), further, model);
      });
  for (bool enough = false; !enough;) {
    Phase finding(cms, events.modes, "fixed-interface modes");
    search.find_modes();
    finding.done();
    Phase choosing(cms, events.errors, "choice of modes");
    enough = search.is_enough();
    choosing.done();
  }
  return search.modes();
}

/// Rubin's basis, and for MacNeal the mass that is not the projected one.
Basis basis_of_free_modes(CMS cms)
{
  const SetUp& set_up = *cms->inside->set_up;
  const ReduceOptions& wanted = cms->inside->settings.options;
  Basis basis{.Q = {.Psi = timed_constraint_modes(cms), .modes = {}}, .mass = {}};
  const WholeSystem body{.K = set_up.K,
                         .M = set_up.M,
                         .dofs = set_up.rows,
                         .K_blocks = set_up.K_blocks,
                         .M_blocks = set_up.M_blocks,
                         .K_ss = set_up.K_ss};
  Phase phase(cms, events.modes, "free-interface modes");
  const FreeInterfaceModes free = free_interface_modes(body, basis.Q.Psi, wanted);
  basis.Q.modes = rubin_modes(body, basis.Q.Psi, free);
  if (wanted.method == Method::macneal) {
    basis.mass = macneal_mass(basis.Q, set_up.M_blocks, free);
  }
  phase.done();
  return basis;
}

}  // namespace

Basis make_basis(CMS cms)
{
  const ReduceOptions& wanted = cms->inside->settings.options;
  if (wanted.method == Method::rubin || wanted.method == Method::macneal) {
    return basis_of_free_modes(cms);
  }
  Basis basis{.Q = {.Psi = {}, .modes = {}}, .mass = {}};
  if (wanted.tolerance && wanted.method == Method::craig_bampton) {
    basis.Q.Psi = timed_constraint_modes(cms);
    basis.Q.modes = modes_to_tolerance(cms, basis.Q.Psi);
  } else {
    // The modes first: the subspace of the eigen-solve is as large as the constraint modes.
    basis.Q.modes = modes_as_told(cms);
    basis.Q.Psi = timed_constraint_modes(cms);
  }
  return basis;
}

}  // namespace chladni::reduce::plugin
