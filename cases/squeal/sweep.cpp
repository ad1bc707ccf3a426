#include "cases/squeal/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "cases/squeal/squeal_case.hpp"
#include "cases/squeal/sweep_columns.hpp"
#include "common/error.hpp"
#include "report/output.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/parallel.hpp"
#include "squeal/study/run.hpp"
#include "squeal/study/validate.hpp"

namespace chladni::cases {
namespace {

using squeal::SweepTable, squeal::VariantState;

/// Whether pads of other options find the same modes of the body; rings have names, which do not
/// vary.
bool use_same_modes(const squeal::ModeChoice& a, const squeal::ModeChoice& b)
{
  return a.nodal_diameters == b.nodal_diameters && a.list == b.list &&
         a.quasi_static_above == b.quasi_static_above;
}

std::shared_ptr<const squeal::Brake> brake_of(const SweepCase& sweep, const scene::Scene& scene)
{
  const squeal::FlexibleDisc* const disc = sweep.brake->body();
  if (!disc || !use_same_modes(disc->options().modes, scene.squeal.value().modes))
    return sweep.make_brake(scene);
  return disc->between(*scene.squeal);
}

/// What one variant yields.
struct Outcome {
  std::vector<std::optional<double>> row;
  std::string failure;
};

Outcome outcome_of(const SweepCase& sweep, const Eigen::VectorXd& values)
{
  try {
    const Variant variant = variant_of(sweep, values);
    const squeal::SquealResults results = squeal::run(*variant.brake, variant.study);
    return {sweep_row(variant.study, results), results.failure.value_or("")};
  } catch (const std::exception& error) {
    return {{}, report::said(error)};
  }
}

void keep(SweepTable& table, Eigen::Index i, const Outcome& outcome)
{
  for (std::size_t j = 0; j < outcome.row.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    table.known(i, column) = outcome.row[j] ? 1 : 0;
    table.results(i, column) = outcome.row[j].value_or(0.0);
  }
  table.failures[static_cast<std::size_t>(i)] = outcome.failure;
  table.states[static_cast<std::size_t>(i)] =
      outcome.failure.empty() ? VariantState::done : VariantState::failed;
}

}  // namespace

Variant variant_of(const SweepCase& sweep, const Eigen::VectorXd& values)
{
  const std::string text = scene::with_numbers(
      sweep.scene.text, sweep.places, {values.data(), static_cast<std::size_t>(values.size())});
  const scene::Scene scene = scene::parse_scene(text, sweep.scene.path);
  squeal::StudyOptions study = study_of(scene);
  study.analyses = sweep.analyses;
  return {std::move(study), brake_of(sweep, scene)};
}

void check_variants(const SweepCase& sweep, const SweepTable& table)
{
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    try {
      const Variant variant = variant_of(sweep, table.values.row(i));
      squeal::validate(*variant.brake, variant.study);
    } catch (const Error& error) {
      throw Error(fmt::format("variant {} ({}): {}", i + 1,
                              name_of_variant(table, static_cast<std::size_t>(i)), error.what()));
    }
  }
}

SweepTable sweep(const SweepCase& sweep, SweepTable table, const SweepKeeping& keeping)
{
  std::vector<Eigen::Index> to_do;
  for (std::size_t i = 0; i < table.n_variants(); ++i)
    if (table.states[i] == VariantState::to_do) to_do.push_back(static_cast<Eigen::Index>(i));
  std::atomic<std::size_t> next = 0;
  std::mutex keeping_one;
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  const unsigned n_threads = keeping.n_threads == 0 ? processors : keeping.n_threads;
  // Variants differ in cost: each thread takes the next one, where a loop would deal them out.
  const auto work = [&](int /*thread*/) {
    for (std::size_t k = next++; k < to_do.size(); k = next++) {
      const Outcome outcome = outcome_of(sweep, table.values.row(to_do[k]));
      const std::lock_guard lock(keeping_one);
      keep(table, to_do[k], outcome);
      if (keeping.done_another) keeping.done_another(table);
    }
  };
  squeal::for_each_index(static_cast<int>(n_threads), work, n_threads);
  return table;
}

}  // namespace chladni::cases
