// Thousands of small random pencils, and harmonics of rings about random axes, by all methods
// against dense matrices; on several ranks also against one.
//   random_pencils --count 10000 --sectors 1000 --seed 1 [--known digits-of-M]
// A property in --known may fail for one in a hundred: where M is singular, round-off decides which
// pairs have digits, and whether a pencil is refused for the lack of them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include "random_pencils.hpp"
#include "random_sectors.hpp"

namespace chladni::strangers {
namespace {

struct Options {
  std::uint64_t first = 1, count = 1000, sectors = 0;
  std::vector<std::uint64_t> also;
  std::string known;
  int shown = 3;  ///< examples of each property
  bool prints_spectra = false;
};

/// How often each property fails, and the first examples.
class Tally {
 public:
  explicit Tally(int shown) : shown_(shown) {}
  void add(const std::string& name, const std::string& words, const Failures& failures)
  {
    ++n_tried_;
    for (const Failure& failure : failures) {
      if (failed_[failure.property]++ >= shown_) continue;
      fmt::print("{} {}: {}\n    {}\n", name, failure.property, failure.figures, words);
    }
  }
  /// 0 where none but the known properties fail, and those seldom.
  int verdict(const std::string& known) const
  {
    std::istringstream words(known);
    std::map<std::string, bool> listed;
    for (std::string word; words >> word;) listed[word] = true;
    int errors = 0;
    for (const auto& [property, n] : failed_) {
      const bool is_known = listed.contains(property) && n <= 1 + n_tried_ / 100;
      fmt::print("{}: {} pencils{}\n", property, n, is_known ? ", known" : "");
      errors += !is_known;
    }
    return errors == 0 ? 0 : 1;
  }

 private:
  int shown_;
  int n_tried_ = 0;
  std::map<std::string, int> failed_;
};

/// Everything of one pencil that helps to find out why.
void print_spectra(const Draw& drawn, const Answer& answer)
{
  fmt::print("{}: {}\n  masters {}\n  eigenvalues {:.12g}\n  held {:.12g}\n", drawn.pencil.name,
             drawn.words, fmt::join(drawn.pencil.masters, " "),
             fmt::join(drawn.exact.whole.lambda, " "), fmt::join(drawn.exact.held.lambda, " "));
  std::vector<double> modes;
  for (int k = answer.n_masters; k < answer.K_r.rows(); ++k) modes.push_back(answer.K_r(k, k));
  fmt::print(
      "  modes {:.12g}\n  reduced {:.12g}\n  eta2 {:.3g}\n  bounds {:.3g}\n  rounding {:.3g}\n",
      fmt::join(modes, " "), fmt::join(answer.lambda, " "), fmt::join(answer.eta2, " "),
      fmt::join(answer.bounds, " "), fmt::join(answer.rounding, " "));
}

/// On the first rank.
Failures failures_of(const Draw& drawn, const Answer& answer)
{
  int failed = answer.code != 0, any = failed, every = failed;
  MPI_Allreduce(&failed, &any, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  MPI_Allreduce(&failed, &every, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  if (petsc::rank(PETSC_COMM_WORLD) > 0) return {};
  if (any != every) return {{"disagreement", "an error on some ranks only"}};
  if (!drawn.pencil.refusal.empty()) return check_refusal(drawn.pencil, answer);
  Failures failures = check(drawn.exact, drawn.how, answer);
  if (petsc::size(PETSC_COMM_WORLD) == 1) return failures;
  const Failures other =
      compare(drawn.exact, answer, reduce(drawn.pencil, drawn.how, PETSC_COMM_SELF));
  failures.insert(failures.end(), other.begin(), other.end());
  return failures;
}

int run(const Options& options)
{
  const bool is_first = petsc::rank(PETSC_COMM_WORLD) == 0;
  Tally tally(is_first ? options.shown : 0);
  std::vector<std::uint64_t> seeds = options.also;
  for (std::uint64_t k = 0; k < options.count; ++k) seeds.push_back(options.first + k);
  for (const std::uint64_t seed : seeds) {
    const Draw drawn = draw(seed);
    const Answer answer = reduce(drawn.pencil, drawn.how, PETSC_COMM_WORLD);
    if (options.prints_spectra && is_first) print_spectra(drawn, answer);
    tally.add(drawn.pencil.name, drawn.words, failures_of(drawn, answer));
  }
  for (std::uint64_t seed = options.first; seed < options.first + options.sectors; ++seed) {
    const SectorTrial trial = try_sector(seed, PETSC_COMM_WORLD);
    tally.add(fmt::format("sector {}", seed), trial.words, trial.failures);
  }
  if (!is_first) return 0;
  fmt::print("{} pencils and {} sectors from seed {} on, {} others, {} ranks\n", options.count,
             options.sectors, options.first, options.also.size(), petsc::size(PETSC_COMM_WORLD));
  return tally.verdict(options.known);
}

}  // namespace
}  // namespace chladni::strangers

int main(int argc, char** argv)
{
  chladni::strangers::Options options;
  CLI::App app{"Random pencils against dense matrices"};
  app.add_option("--seed", options.first, "of the first pencil; the others count on from it");
  app.add_option("--count", options.count, "of pencils");
  app.add_option("--sectors", options.sectors, "harmonics of rings about random axes");
  app.add_option("--also", options.also, "seeds of further pencils");
  app.add_option("--known", options.known, "properties that may fail, in one string");
  app.add_option("--shown", options.shown, "examples of each property that fails");
  app.add_flag("--spectra", options.prints_spectra, "print the eigenvalues of every pencil");
  CLI11_PARSE(app, argc, argv);
  SlepcInitialize(nullptr, nullptr, nullptr, nullptr);
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  const int code = chladni::strangers::run(options);
  SlepcFinalize();
  return code;
}
