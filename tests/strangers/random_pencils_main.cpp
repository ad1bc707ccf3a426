// Thousands of small random pencils by all methods against dense matrices, on one rank.
//   random_pencils --count 10000 --seed 1 [--known "refused"]
// A property in --known may fail: round-off decides which pencils are refused.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <sstream>

#include "random_pencils.hpp"

namespace chladni::strangers {
namespace {

struct Options {
  std::uint64_t first = 1, count = 1000;
  std::string known;
  int shown = 3;  ///< examples of each property
  bool prints_spectra = false;
};

/// How often each property fails, and the first examples.
class Tally {
 public:
  explicit Tally(int shown) : shown_(shown) {}
  void add(const Draw& draw, const Failures& failures)
  {
    for (const Failure& failure : failures) {
      if (failed_[failure.property]++ >= shown_) continue;
      fmt::print("{} {}: {}\n    {}\n", draw.pencil.name, failure.property, failure.figures,
                 draw.words);
    }
  }
  /// 0 where none but the known properties fail.
  int verdict(const std::string& known) const
  {
    std::istringstream words(known);
    std::map<std::string, bool> listed;
    for (std::string word; words >> word;) listed[word] = true;
    int errors = 0;
    for (const auto& [property, n] : failed_) {
      fmt::print("{}: {} pencils{}\n", property, n, listed.contains(property) ? ", known" : "");
      errors += !listed.contains(property);
    }
    return errors == 0 ? 0 : 1;
  }

 private:
  int shown_;
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
  fmt::print("  modes {:.12g}\n  reduced {:.12g}\n  eta2 {:.3g}\n  bounds {:.3g}\n",
             fmt::join(modes, " "), fmt::join(answer.lambda, " "), fmt::join(answer.eta2, " "),
             fmt::join(answer.bounds, " "));
}

int run(const Options& options)
{
  Tally tally(options.shown);
  for (std::uint64_t seed = options.first; seed < options.first + options.count; ++seed) {
    const Draw drawn = draw(seed);
    const Answer answer = reduce(drawn.pencil, drawn.how, PETSC_COMM_SELF);
    if (options.prints_spectra) print_spectra(drawn, answer);
    tally.add(drawn, check(drawn.exact, drawn.how, answer));
  }
  fmt::print("{} pencils from seed {} on\n", options.count, options.first);
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
