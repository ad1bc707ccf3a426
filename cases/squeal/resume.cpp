#include "cases/squeal/resume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "common/error.hpp"
#include "files/hdf5.hpp"
#include "mbs_export/files/provenance.hpp"
#include "scene/changes.hpp"
#include "squeal/results/result_file.hpp"
#include "squeal/results/sweep_file.hpp"

namespace chladni::cases {
namespace {

using std::filesystem::path;

/// Refuses what another run left in `file`.
void require_same(const path& file, const squeal::RunOrigin& then, const squeal::RunOrigin& now)
{
  const std::vector<std::string> changed =
      scene::changed_keys(then.provenance.scene, now.provenance.scene, scene::Step::squeal);
  if (!changed.empty()) {
    throw Error(fmt::format(
        "{}: cannot be resumed, since the scene has changed: {}; --overwrite begins anew",
        file.string(), fmt::join(changed, ", ")));
  }
  if (then.inputs != now.inputs) {
    throw Error(
        fmt::format("{}: cannot be resumed: it was made from {}, and this run has {}; "
                    "--overwrite begins anew",
                    file.string(), then.inputs, now.inputs));
  }
}

/// The origin of the state that was left behind.
squeal::RunOrigin read_state(squeal::Checkpoint& checkpoint)
{
  try {
    return checkpoint.read();
  } catch (const Error& error) {
    throw Error(fmt::format("{}\nRemove it: --resume then keeps the analyses that are finished",
                            error.what()));
  }
}

}  // namespace

squeal::SquealResults resume(const LeftBehind& left, const squeal::RunOrigin& origin,
                             squeal::Checkpoint& checkpoint)
{
  squeal::SquealResults begin;
  if (exists(left.results)) {
    const files::Reader reader(left.results.string());
    begin = squeal::read_results(reader);
    if (!begin.missing.empty()) {
      require_same(left.results, {mbs_export::file_parts::read_provenance(reader), begin.inputs},
                   origin);
    }
  }
  const bool has_checkpoint = exists(left.checkpoint);
  if (has_checkpoint) require_same(left.checkpoint, read_state(checkpoint), origin);
  if (!has_checkpoint && begin.missing.empty()) {
    throw Error(fmt::format(
        "--resume: no run was interrupted here: there is neither {} nor an unfinished {}; run "
        "without --resume",
        left.checkpoint.string(), left.results.string()));
  }
  return begin.missing.empty() ? squeal::SquealResults{} : begin;
}

squeal::SweepTable resume(const path& file, const squeal::SweepTable& wanted,
                          const squeal::RunOrigin& origin)
{
  if (!exists(file))
    throw Error(fmt::format("--resume: there is no {}; run without --resume", file.string()));
  const files::Reader reader(file.string());
  squeal::SweepTable left = squeal::read_sweep(reader);
  const auto refuse = [&](const std::string& why) {
    throw Error(fmt::format("{}: cannot be resumed, since {}; --overwrite begins anew",
                            file.string(), why));
  };
  if (left.count(squeal::VariantState::to_do) == 0) refuse("no variant is left to do");
  if (left.keys != wanted.keys) refuse("other keys vary");
  if (left.values.rows() != wanted.values.rows() || left.values != wanted.values)
    refuse("the keys take other values");
  const auto changed = scene::changed_keys(mbs_export::file_parts::read_provenance(reader).scene,
                                           origin.provenance.scene, scene::Step::squeal);
  if (!changed.empty()) refuse("the scene has changed: " + changed.front());
  if (left.columns != wanted.columns || left.inputs != wanted.inputs)
    refuse(fmt::format("it was made from {}, and this run has {}", left.inputs, wanted.inputs));
  return left;
}

void require_no_unfinished_sweep(const path& file)
{
  if (!exists(file)) return;
  const files::Reader reader(file.string());
  if (reader.text_attribute("/", "format") != squeal::sweep_format) return;
  const squeal::SweepTable left = squeal::read_sweep(reader);
  if (left.count(squeal::VariantState::to_do) == 0) return;
  throw Error(
      fmt::format("{}: a sweep that was interrupted; --resume goes on from it, --overwrite begins "
                  "anew",
                  file.string()));
}

}  // namespace chladni::cases
