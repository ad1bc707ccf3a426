#include "mbs_export/responses/frequency_responses.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "common/files/output_file.hpp"
#include "mbs_export/make_body.hpp"
#include "mbs_export/measured/measured_functions.hpp"
#include "mbs_export/responses/response_files.hpp"
#include "mbs_export/responses/response_options.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/mbs_export/bending_beam.hpp"

namespace chladni::mbs_export {
namespace {

using Complex = std::complex<double>;
using files::test::error_of;

/// Two measured functions at 1 and 2 rad/s: at node 101 for a load at node 102, both in z, in
/// receptance and in accelerance.
MeasuredFunctions two_functions()
{
  MeasuredFunctions measured{
      .file = "hammer.uff",
      .f_Hz = Eigen::Vector2d(1.0, 2.0) / (2.0 * std::numbers::pi),
      .functions = {},
      .nodes = {{101, {{0.5, 0.0, 0.001}, true}}, {102, {{1.0, 0.0, 0.0}, true}}},
      .notes = {}};
  for (const auto quantity : {ResponseQuantity::receptance, ResponseQuantity::accelerance}) {
    measured.functions.push_back({.line = 3,
                                  .name = "H",
                                  .output = {101, 2},
                                  .load = {102, 2},
                                  .quantity = quantity,
                                  .H = Eigen::Vector2cd(Complex(1, 1), Complex(0, 8))});
  }
  return measured;
}

/// Computed receptances at three outputs, the first and the last 4 mm from each other, and two
/// loads.
FrequencyResponses computed_at_three()
{
  FrequencyResponses computed{.title = {},
                              .model = ResponseModel::body,
                              .quantity = ResponseQuantity::receptance,
                              .Omega = Eigen::Vector2d(1.0, 2.0),
                              .damping = "none",
                              .loads = {},
                              .outputs = {},
                              .H = {}};
  computed.outputs = {{"a.z", 2, 1, {0.5, 0.0, 0.0}},
                      {"a.x", 0, 1, {0.5, 0.0, 0.0}},
                      {"b.z", 2, 2, {0.504, 0.0, 0.0}}};
  computed.loads = {{"all.z", 2, 0, {1.0, 0.0, 0.0}}, {"c.z", 2, 3, {1.0, 0.001, 0.0}}};
  return computed;
}

MeasuredResponses beside(const MeasuredFunctions& measured, const FrequencyResponses& computed,
                         std::optional<double> distance)
{
  return measured_beside({std::make_shared<const MeasuredFunctions>(measured), distance}, computed);
}

TEST(MeasuredBeside, FindsTheNearestPlaceOfOneNodeInTheSameDirection)
{
  const MeasuredResponses found = beside(two_functions(), computed_at_three(), 0.01);
  ASSERT_EQ(found.functions.size(), 2U);
  EXPECT_EQ(found.functions[0].output, 0);
  EXPECT_EQ(found.functions[0].load, 1U);  // the other one is shared by several nodes
  // a = -Omega^2 u
  EXPECT_NEAR(std::abs(found.functions[0].H[1] - Complex(0, 8)), 0.0, 1e-15);
  EXPECT_NEAR(std::abs(found.functions[1].H[1] - Complex(0, -2)), 0.0, 1e-15);
  EXPECT_NEAR(std::abs(found.functions[1].H[0] - Complex(-1, -1)), 0.0, 1e-15);
}

TEST(MeasuredBeside, PrefersThePlaceThatNamesTheNode)
{
  FrequencyResponses computed = computed_at_three();
  computed.outputs[2].measured_node = 101;
  computed.loads[0].measured_node = 102;
  MeasuredFunctions measured = two_functions();
  for (const auto& distance : {std::optional(0.01), std::optional<double>()}) {
    const MeasuredResponses found = beside(measured, computed, distance);
    EXPECT_EQ(found.functions.at(0).output, 2);
    EXPECT_EQ(found.functions[0].load, 0U);
    measured.nodes.clear();  // a file without nodes
  }
}

TEST(MeasuredBeside, RefusesWhatCannotBeCompared)
{
  const MeasuredFunctions measured = two_functions();
  const FrequencyResponses computed = computed_at_three();
  const auto refused = [&](const MeasuredFunctions& one, const FrequencyResponses& other,
                           std::optional<double> distance) {
    return error_of([&] { beside(one, other, distance); });
  };
  const std::string far = refused(measured, computed, 0.0005);
  for (const char* const words :
       {"hammer.uff", "none of its 2", "node 101 z at (0.5", "a.z", "larger"})
    EXPECT_NE(far.find(words), std::string::npos) << far;
  EXPECT_NE(refused(measured, computed, {}).find("or give --distance"), std::string::npos);
  MeasuredFunctions turned = measured;
  turned.nodes.at(101).is_in_global_axes = false;
  EXPECT_NE(refused(turned, computed, 0.01).find("node 101 has a coordinate system"),
            std::string::npos);
  MeasuredFunctions twice = measured;
  twice.functions[1].output.node = 103;
  twice.nodes.insert({103, {{0.499, 0.0, 0.0}, true}});
  EXPECT_NE(refused(twice, computed, 0.01).find("101 and 103 both belong to a.z"),
            std::string::npos);
  FrequencyResponses at_rest = computed;
  at_rest.Omega[0] = 0.0;
  EXPECT_THROW(beside(measured, at_rest, 0.01), ResponseOptionError);
}

TEST(ResponseAssurance, IsOneOfProportionalFunctionsAndBelowOfOthers)
{
  const Eigen::Vector3cd x(Complex(1, 2), Complex(0, -3), Complex(2, 0)),
      y(Complex(1, 0), Complex(1, 1), Complex(0, 0));
  EXPECT_NEAR(response_assurance(x, Complex(-2, 5) * x), 1.0, 1e-15);
  // x^H y = (1 - 2i) + 3i (1 + i) = -2 + i, of norm 5; x^H x = 18, y^H y = 3
  EXPECT_NEAR(response_assurance(x, y), 5.0 / (18.0 * 3.0), 1e-15);
  EXPECT_NEAR(response_assurance(1e200 * x, 1e-200 * y), 5.0 / (18.0 * 3.0), 1e-15);
  EXPECT_EQ(response_assurance(x, Eigen::Vector3cd::Zero()), 0.0);
  EXPECT_NEAR(amplitude_ratio(x, y), std::sqrt(3.0 / 18.0), 1e-15);
}

TEST(MeasuredFunctions, AreWhatTheWriterWrote)
{
  const files::test::ScratchFolder folder;
  BodyOptions held;
  held.fixed = {"A"};
  const ModalBody body = make_body(test::regression_beam(), held);
  for (const Spacing spacing : {Spacing::linear, Spacing::logarithmic}) {
    const FrequencyResponses written = frequency_responses(
        body, {.quantity = ResponseQuantity::mobility,
               .loads = {{.at = "C", .components = {2, 4}}},
               .outputs = {{.at = "B", .components = {2, 4}}},
               .range = {.from_Hz = 1.0, .to_Hz = 3.0, .count = 7, .spacing = spacing},
               .loss_factor = 0.1});
    files::write_text(folder.file("beam.unv"), universal_file_of(written));
    const MeasuredFunctions measured = read_measured_functions(folder.file("beam.unv"), {});
    ASSERT_EQ(measured.functions.size(), 4U);
    EXPECT_LT((measured.f_Hz * 2.0 * std::numbers::pi - written.Omega).cwiseAbs().maxCoeff(),
              1e-5 * written.Omega[6]);  // six digits
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::VectorXcd H = written.H[i / 2].col(Eigen::Index(i % 2));
      EXPECT_LT((measured.functions[i].H - H).norm(), 1e-11 * H.norm());  // twelve digits
      EXPECT_EQ(measured.functions[i].quantity, ResponseQuantity::mobility);
      EXPECT_EQ(measured.functions[i].output.component, i % 2 == 0 ? 2 : 4);
    }
    EXPECT_TRUE(measured.notes.empty());
  }
}

class ComparedBeam : public ::testing::Test {
 protected:
  /// The cantilever with a measurement that is its own response, 3 % softer at another damping.
  FrequencyResponses compared()
  {
    BodyOptions held;
    held.fixed = {"A"};
    const ModalBody body = make_body(test::regression_beam(), held);
    ResponseOptions options{.loads = {{.at = "C", .components = {2}}},
                            .outputs = {{.at = "B", .components = {2}, .measured_node = 7}},
                            .range = {.from_Hz = 0.5, .to_Hz = 3.0, .count = 11},
                            .loss_factor = 0.1};
    options.loads[0].measured_node = 7;
    const FrequencyResponses alone = frequency_responses(body, options);
    const MeasuredFunctions measured{.file = "hammer.uff",
                                     .f_Hz = alone.Omega.head(5) / (2.0 * std::numbers::pi),
                                     .functions = {{.line = 12,
                                                    .name = "H1",
                                                    .output = {7, 2},
                                                    .load = {7, 2},
                                                    .quantity = {},
                                                    .H = 2.0 * alone.H[0].col(0).head(5)}},
                                     .nodes = {},
                                     .notes = {}};
    options.measurement =
        Measurement{std::make_shared<const MeasuredFunctions>(measured), std::nullopt};
    return frequency_responses(body, options);
  }
};

TEST_F(ComparedBeam, RespondsAtTheMeasuredFrequencies)
{
  const FrequencyResponses found = compared();
  EXPECT_EQ(found.Omega.size(), 5);
  ASSERT_EQ(found.measured.functions.size(), 1U);
  const MeasuredResponse& one = found.measured.functions[0];
  // The frequencies go through Hz and back.
  EXPECT_NEAR(response_assurance(one.H, found.H[0].col(0)), 1.0, 1e-12);
  EXPECT_NEAR(amplitude_ratio(one.H, found.H[0].col(0)), 0.5, 1e-12);
}

TEST_F(ComparedBeam, IsTheSameAfterItsFileAndStandsInItsTable)
{
  const files::test::ScratchFolder folder;
  const FrequencyResponses written = compared();
  write_responses(folder.file("beam.response.h5"), written);
  const FrequencyResponses read = read_responses(folder.file("beam.response.h5"));
  ASSERT_EQ(read.measured.functions.size(), 1U);
  EXPECT_EQ(read.measured.file, "hammer.uff");
  EXPECT_EQ(read.measured.functions[0].name, "H1");
  EXPECT_EQ(read.measured.functions[0].line, 12);
  EXPECT_EQ(read.measured.functions[0].H, written.measured.functions[0].H);
  const std::string table = csv_of(read);
  EXPECT_TRUE(table.starts_with(
      R"("frequency, Hz","B.z / C.z re, m/N","B.z / C.z im, m/N","B.z / C.z measured (line 12) re, m/N",)"
      R"("B.z / C.z measured (line 12) im, m/N")"))
      << table.substr(0, 200);
  // An output that nothing was measured at has no such columns.
  FrequencyResponses two = read;
  two.outputs.push_back(two.outputs[0]);
  two.outputs[1].name = "D.z";
  two.H[0].conservativeResize(Eigen::NoChange, 2);
  two.H[0].col(1).setZero();
  const std::string of_two = csv_of(two), heading = of_two.substr(0, of_two.find('\n'));
  EXPECT_NE(heading.find("D.z / C.z im"), std::string::npos) << heading;
  EXPECT_EQ(heading.find("D.z / C.z measured"), std::string::npos) << heading;
}

}  // namespace
}  // namespace chladni::mbs_export
