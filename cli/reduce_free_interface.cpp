#include "cli/reduce_steps.hpp"
#include "reduce/free_interface.hpp"

namespace chladni::cli {

bool is_free_interface(reduce::Method method)
{
  return method == reduce::Method::rubin || method == reduce::Method::macneal;
}

Reduced reduce_by_free_modes(const Scene& scene, const FeModel& fe, const Partitioned& blocks,
                             const reduce::Factorization& K_ss, Phases& phases)
{
  reduce::CraigBamptonBasis Q = constraint_basis(blocks, K_ss, phases);
  const reduce::WholeSystem body{.K = fe.system.K,
                                 .M = fe.system.M,
                                 .dofs = blocks.rows,
                                 .K_blocks = blocks.K,
                                 .M_blocks = blocks.M,
                                 .K_ss = K_ss};
  const reduce::FreeInterfaceModes free = phases.run("free-interface modes", [&] {
    return reduce::free_interface_modes(body, Q.Psi, scene.reduce);
  });
  Q.modes =
      phases.run("residual flexibility", [&] { return reduce::rubin_modes(body, Q.Psi, free); });
  Reduced reduced = project_blocks(scene, fe, blocks, std::move(Q), phases);
  if (scene.reduce.method == reduce::Method::macneal) {
    reduced.model.M = phases.run(
        "mass of the modes", [&] { return reduce::macneal_mass(reduced.Q_CB, blocks.M, free); });
    reduced.system.M = to_file_order(scene, fe, reduced.model, reduced.places).M;
  }
  return reduced;
}

}  // namespace chladni::cli
