// Every pencil by every way of solving, on all ranks, against dense matrices.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <sstream>

#include "checks.hpp"
#include "known.hpp"

namespace chladni::strangers {
namespace {

const std::vector<std::string> ways = {"Guyan",     "Number", "AllModes", "Cutoff",
                                       "Tolerance", "Rubin",  "Eps"};

const Pencil& pencil_named(const std::string& name)
{
  static const std::vector<Pencil> all = all_pencils();
  return *std::ranges::find(all, name, &Pencil::name);
}

/// The spectra of a pencil, computed once.
const Reference& reference_of(const std::string& name)
{
  static std::map<std::string, Reference> all;
  const auto at = all.find(name);
  if (at != all.end()) return at->second;
  return all.emplace(name, reference(pencil_named(name))).first->second;
}

/// A frequency in the widest gap between eigenvalues first to last.
double frequency_in_gap(const std::vector<double>& lambda, std::size_t first, std::size_t last)
{
  double widest = 1.0 + 1e-3, sigma = 1.01 * lambda.back();
  for (std::size_t i = first; i < last && i + 1 < lambda.size(); ++i) {
    if (!(lambda[i] > 0.0) || lambda[i + 1] / lambda[i] <= widest) continue;
    widest = lambda[i + 1] / lambda[i];
    sigma = std::sqrt(lambda[i] * lambda[i + 1]);
  }
  return std::sqrt(sigma) / (2.0 * std::numbers::pi);
}

/// Beyond, shift and invert at 0 has no more than nine digits.
std::size_t n_within_reach(const std::vector<double>& lambda)
{
  return std::ranges::upper_bound(lambda, 1e6 * lambda.front()) - lambda.begin();
}

Reduction reduction_of(const Reference& exact, const std::string& way)
{
  if (way == "Guyan") return {.type = CMSGUYAN};
  if (!exact.pencil.refusal.empty()) {
    if (way == "Tolerance") return {.tolerance = 1e-3, .up_to_Hz = 0.2};
    if (way == "Cutoff") return {.cutoff_Hz = 0.3};
    if (way == "Rubin") return {.type = CMSRUBIN, .modes = 3};
    return {.modes = 5};
  }
  const std::size_t n_held = exact.held.lambda.size(), n = exact.whole.lambda.size();
  const std::size_t n_reach = n_within_reach(exact.held.lambda);
  if (way == "Number") return {.modes = std::clamp(static_cast<int>(n_held / 3), 1, 30)};
  if (way == "AllModes") return {.modes = static_cast<int>(std::min<std::size_t>(n_reach, 150))};
  if (way == "Cutoff") {
    const std::vector<double> lambda(exact.held.lambda.begin(),
                                     exact.held.lambda.begin() + n_reach);
    return {.cutoff_Hz = frequency_in_gap(lambda, n_reach / 5, n_reach / 2)};
  }
  const auto n_rigid = static_cast<std::size_t>(exact.pencil.n_rigid);
  if (way == "Tolerance") {
    return {.tolerance = 1e-3,
            .up_to_Hz = frequency_in_gap(exact.whole.lambda, n_rigid, n_rigid + (n - n_rigid) / 4)};
  }
  const int few = static_cast<int>((n - n_rigid) / 4);
  return {.type = CMSRUBIN, .modes = std::clamp(few, 1, 10)};
}

/// What the first rank says, on all of them.
std::string told(std::string text)
{
  int size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  text.resize(size);
  MPI_Bcast(text.data(), size, MPI_CHAR, 0, PETSC_COMM_WORLD);
  return text;
}

Reduction told(Reduction how)
{
  std::array<char, 32> type{};
  std::string_view(how.type).copy(type.data(), type.size() - 1);
  MPI_Bcast(type.data(), static_cast<int>(type.size()), MPI_CHAR, 0, PETSC_COMM_WORLD);
  for (const char* known : {CMSGUYAN, CMSCRAIGBAMPTON, CMSRUBIN})
    if (std::string_view(type.data()) == known) how.type = known;
  MPI_Bcast(&how.modes, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  for (double* value : {&how.cutoff_Hz, &how.tolerance, &how.up_to_Hz})
    MPI_Bcast(value, 1, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  return how;
}

/// All ranks fail or none.
Failures agreement(PetscErrorCode code)
{
  int failed = code != 0, any = failed, every = failed;
  MPI_Allreduce(&failed, &any, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  MPI_Allreduce(&failed, &every, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  if (any == every) return {};
  return {{"disagreement", "an error on some ranks only"}};
}

Failures reduce_and_check(const std::string& name, const std::string& way)
{
  const Pencil& pencil = pencil_named(name);
  const bool first = petsc::rank(PETSC_COMM_WORLD) == 0;
  const Reduction how = told(first ? reduction_of(reference_of(name), way) : Reduction{});
  const Answer answer = reduce(pencil, how, PETSC_COMM_WORLD);
  Failures failures = agreement(answer.code);
  if (!first) return {};
  const Failures wrong = pencil.refusal.empty() ? check(reference_of(name), how, answer)
                                                : check_refusal(pencil, answer);
  failures.insert(failures.end(), wrong.begin(), wrong.end());
  if (petsc::size(PETSC_COMM_WORLD) == 1) return failures;
  const Failures other = compare(reference_of(name), answer, reduce(pencil, how, PETSC_COMM_SELF));
  failures.insert(failures.end(), other.begin(), other.end());
  return failures;
}

/// The target lies below all eigenvalues, at some distance.
Failures solve_and_check(const std::string& name)
{
  const Pencil& pencil = pencil_named(name);
  const bool first = petsc::rank(PETSC_COMM_WORLD) == 0;
  int n = 5;
  double target = 0.0;
  if (first && pencil.refusal.empty()) {
    const Spectrum& whole = reference_of(name).whole;
    n = std::clamp(static_cast<int>(whole.lambda.size()) / 2, 1, 20);
    if (pencil.n_rigid > 0) target = -0.5 * whole.lambda[pencil.n_rigid];
  }
  MPI_Bcast(&n, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  MPI_Bcast(&target, 1, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  const Eigenpairs pairs = eigenpairs(pencil, n, target, PETSC_COMM_WORLD);
  Failures failures = agreement(pairs.code);
  if (!first || !pencil.refusal.empty()) return failures;
  const Failures wrong = check(reference_of(name), n, target, pairs);
  failures.insert(failures.end(), wrong.begin(), wrong.end());
  return failures;
}

/// The properties that fail, each once, and all figures as text.
std::pair<std::vector<std::string>, std::string> summary(const Failures& failures)
{
  std::vector<std::string> properties;
  std::string text;
  for (const Failure& failure : failures) {
    properties.push_back(failure.property);
    text += fmt::format("{}: {}\n", failure.property, failure.figures);
  }
  std::ranges::sort(properties);
  properties.erase(std::unique(properties.begin(), properties.end()), properties.end());
  return {properties, text};
}

/// Those words of the first text that are not in the second.
std::string unlisted(const std::string& words, const std::string& listed)
{
  std::istringstream all(words);
  std::string others;
  for (std::string word; all >> word;)
    if ((" " + listed + " ").find(" " + word + " ") == std::string::npos) others += word + " ";
  return others;
}

class Stranger : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(Stranger, HoldsAgainstDenseMatrices)
{
  const auto& [name, way] = GetParam();
  const int ranks = petsc::size(PETSC_COMM_WORLD);
  constexpr unsigned patience = 100;  // seconds; nothing here takes as long
  alarm(patience);
  const auto [properties, figures] =
      summary(way == "Eps" ? solve_and_check(name) : reduce_and_check(name, way));
  const std::string text = told(figures);
  const std::string wrong = told(fmt::format("{}", fmt::join(properties, " ")));
  alarm(0);
  EXPECT_EQ(unlisted(wrong, known_wrong(name, way, ranks)), "")
      << name << " " << way << " on " << ranks << " ranks\n"
      << text;
  if (std::getenv("STRANGERS_LIST") != nullptr && petsc::rank(PETSC_COMM_WORLD) == 0) {
    for (const std::string& property : properties)
      std::printf("KNOWN %s %s %s %d\n", name.c_str(), way.c_str(), property.c_str(), ranks);
    if (!text.empty())
      std::printf("FIGURES %s %s %d\n%s", name.c_str(), way.c_str(), ranks, text.c_str());
  }
}

std::vector<std::string> names()
{
  std::vector<std::string> all;
  for (const Pencil& pencil : all_pencils()) all.push_back(pencil.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(
    All, Stranger, ::testing::Combine(::testing::ValuesIn(names()), ::testing::ValuesIn(ways)),
    [](const auto& parameters) {
      return std::get<0>(parameters.param) + "_" + std::get<1>(parameters.param);
    });

}  // namespace
}  // namespace chladni::strangers

int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  SlepcInitialize(&argc, &argv, nullptr, nullptr);
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  CMSInitializePackage();
  CMSRegisterEPS();
  int failed = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  SlepcFinalize();
  return failed;
}
