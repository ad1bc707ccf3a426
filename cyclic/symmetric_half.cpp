#include "cyclic/symmetric_half.hpp"

namespace chladni::cyclic {

namespace {

using Eigen::Index, Eigen::MatrixXd;

std::vector<double> each_twice(const std::vector<double>& values)
{
  std::vector<double> twice;
  for (const double value : values) twice.insert(twice.end(), 2, value);
  return twice;
}

reduce::EigenvalueCount twice(reduce::EigenvalueCount count)
{
  count.expected *= 2;
  count.found *= 2;
  return count;
}

/// Masters of the half and their modes, each of these now and later.
MatrixXd spread(const MatrixXd& rows, const MatrixXd& masters, Index first_mode)
{
  const Index n_half = masters.cols(), n_m = masters.rows(), n_modes = rows.cols() - n_half;
  MatrixXd wide = MatrixXd::Zero(rows.rows(), n_m + 2 * n_modes);
  wide.leftCols(n_m) = rows.leftCols(n_half) * masters.transpose();
  for (Index k = 0; k < n_modes; ++k) wide.col(n_m + 2 * k + first_mode) = rows.col(n_half + k);
  return wide;
}

}  // namespace

HarmonicCoordinates symmetric_half(const HarmonicCoordinates& c)
{
  const SparseRows& B = c.symmetric;
  HarmonicCoordinates half{.order = c.order,
                           .count = c.count,
                           .weight = c.weight,
                           .X = SparseRows(c.X * B),
                           .Y = SparseRows(c.Y * B),
                           .masters = {},
                           .partner = {},
                           .sign = {},
                           .origins = {}};
  std::vector<bool> is_known(std::size_t(B.cols()), false);
  for (const Master& master : c.masters) {
    for (SparseRows::InnerIterator it(B, master.coordinate); it; ++it) {
      if (is_known[std::size_t(it.index())]) continue;
      is_known[std::size_t(it.index())] = true;
      half.masters.push_back(master);
      half.masters.back().coordinate = int(it.index());
    }
  }
  return half;
}

MasterHalves master_halves(const HarmonicCoordinates& c, const HarmonicCoordinates& half)
{
  const SparseRows& B = c.symmetric;
  std::vector<Index> place(std::size_t(B.cols()), -1);
  for (Index k = 0; k < std::ssize(half.masters); ++k)
    place[std::size_t(half.masters[std::size_t(k)].coordinate)] = k;
  const Index n_m = std::ssize(c.masters);
  MasterHalves masters{.now = MatrixXd::Zero(n_m, std::ssize(half.masters)),
                       .later = MatrixXd::Zero(n_m, std::ssize(half.masters))};
  for (Index i = 0; i < n_m; ++i) {
    const auto row = std::size_t(c.masters[std::size_t(i)].coordinate);
    for (SparseRows::InnerIterator it(B, Index(row)); it; ++it)
      masters.now(i, place[std::size_t(it.index())]) = it.value();
    for (SparseRows::InnerIterator it(B, c.partner[row]); it; ++it)
      masters.later(i, place[std::size_t(it.index())]) = c.sign[row] * it.value();
  }
  return masters;
}

MatrixXd unfolded_form(const MatrixXd& A, const MasterHalves& masters)
{
  const auto both = [&](const MatrixXd& half, Index first_mode) {
    const MatrixXd rows = spread(A, half, first_mode);
    return spread(rows.transpose(), half, first_mode).transpose().eval();
  };
  return both(masters.now, 0) + both(masters.later, 1);
}

SectorMotion unfolded_motion(const SectorMotion& half, const MasterHalves& masters)
{
  // A quarter of a period later (x, y) is (-y, x).
  return {.x = spread(half.x, masters.now, 0) - spread(half.y, masters.later, 1),
          .y = spread(half.y, masters.now, 0) + spread(half.x, masters.later, 1)};
}

reduce::Certificate unfolded_certificate(const reduce::Certificate& half)
{
  reduce::Certificate whole = half;
  for (auto member :
       {&reduce::Certificate::lambda, &reduce::Certificate::eta2, &reduce::Certificate::estimates,
        &reduce::Certificate::rounding, &reduce::Certificate::bounds})
    whole.*member = each_twice(half.*member);
  for (auto member : {&reduce::Certificate::fixed_interface, &reduce::Certificate::range,
                      &reduce::Certificate::complete})
    whole.*member = twice(half.*member);
  whole.n_zero = 2 * half.n_zero;
  return whole;
}

}  // namespace chladni::cyclic
