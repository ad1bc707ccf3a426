#include "cases/reduce_stages.hpp"

namespace chladni::cases {

std::vector<report::Stage> stages_of(const reduce::ReduceOptions& wanted)
{
  using report::Times;
  std::vector<report::Stage> stages{
      {"mesh", 1.0}, {"assembly", 3.0}, {"partition", 1.0}, {"factorization", 4.0}};
  const report::Stage constraint{"constraint modes", 4.0};
  const auto add = [&](const std::vector<report::Stage>& more) {
    stages.insert(stages.end(), more.begin(), more.end());
  };
  if (wanted.method == reduce::Method::guyan)
    add({constraint});
  else if (wanted.method == reduce::Method::mixed_interface)
    add({constraint, {"mixed-interface modes", 25.0}, {"residual flexibility", 5.0}});
  else if (wanted.method == reduce::Method::automatic)
    add({constraint,
         {"fixed-interface modes", 25.0, Times::unknown},
         {"mixed-interface modes", 25.0},
         {"residual flexibility", 5.0}});
  else if (wanted.method != reduce::Method::craig_bampton)
    add({constraint, {"free-interface modes", 25.0}, {"residual flexibility", 5.0}});
  else if (wanted.tolerance)
    add({constraint, {"fixed-interface modes", 40.0, Times::unknown}});
  else
    add({{"fixed-interface modes", 20.0}, constraint});
  add({{"projection", 6.0},
       {"error estimates", 8.0},
       {"condition", 1.0},
       {"count of eigenvalues", 15.0},
       {"residuals", 2.0},
       {"mass integrals", 25.0},
       {"pictures", 1.0}});
  return stages;
}

std::vector<report::Stage> stages_of_sectors()
{
  return {{"mesh", 2.0},       {"assembly", 4.0},   {"modes of harmonics", 14.0},
          {"harmonics", 60.0}, {"whole body", 2.0}, {"mass integrals", 16.0},
          {"pictures", 2.0}};
}

}  // namespace chladni::cases
