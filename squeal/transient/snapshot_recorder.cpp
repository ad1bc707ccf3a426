#include "squeal/transient/snapshot_recorder.hpp"

#include "squeal/motion/speed_program.hpp"

namespace chladni::squeal {
namespace {

/// q in the inertial frame but along the modes of the body.
Eigen::VectorXd in_inertial_frame(const InertialDisc& inertial, const Eigen::VectorXd& q,
                                  double angle)
{
  return inertial.R * turned(inertial, inertial.R.transpose() * q, angle);
}

}  // namespace

SnapshotRecorder::SnapshotRecorder(const Disc& disc, const std::optional<InertialDisc>& inertial,
                                   const RecordingPlan& plan, const TransientCase& run)
    : omega_(disc.omega), inertial_(inertial), plan_(plan), run_(run)
{
  const auto n_kept = static_cast<Eigen::Index>((plan.n_steps - 1) / plan.snapshots + 1);
  snapshots_.q.setZero(disc.n_modes(), n_kept);
  snapshots_.v.setZero(disc.n_modes(), n_kept);
  if (inertial) tail_a_.setZero(disc.n_modes(), static_cast<Eigen::Index>(plan.n_tail));
}

void SnapshotRecorder::add(std::int64_t i, double t, const ModalSteps& steps)
{
  const bool in_tail = inertial_ && i >= plan_.n_steps - plan_.n_tail;
  if (!in_tail && i % plan_.snapshots != 0) return;
  const ModalState x = steps.state();
  if (in_tail) tail_a_.col(n_tail_++) = in_inertial_frame(*inertial_, x.q, turn_at(run_, t).angle);
  if (i % plan_.snapshots != 0) return;
  const auto column = static_cast<Eigen::Index>(snapshots_.t.size());
  snapshots_.q.col(column) = x.q;
  snapshots_.v.col(column) = x.v;
  snapshots_.t.push_back(t);
  snapshots_.energy.push_back(0.5 * (x.v.squaredNorm() + omega_.cwiseProduct(x.q).squaredNorm()));
}

Snapshots SnapshotRecorder::snapshots() const
{
  const auto n = static_cast<Eigen::Index>(snapshots_.t.size());
  return {snapshots_.t, snapshots_.q.leftCols(n), snapshots_.v.leftCols(n), snapshots_.energy};
}

void SnapshotRecorder::exchange(StateArchive& archive)
{
  archive(snapshots_.t, snapshots_.q, snapshots_.v, snapshots_.energy, tail_a_, n_tail_);
}

}  // namespace chladni::squeal
