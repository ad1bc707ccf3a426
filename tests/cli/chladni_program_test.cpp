// The program `chladni`, run as its user does: usage, and what it makes of a reduced system.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "mbs_export/files/body_files.hpp"
#include "tests/cli/programs.hpp"

namespace chladni::cli::testing {
namespace {

constexpr int n_ring = 12;
constexpr int n_nodes = n_ring + 1;
const std::string chladni_program = "'" CHLADNI_PROGRAM "'";

Eigen::Vector3d position(int node)
{
  if (node == n_ring) return Eigen::Vector3d::Zero();
  const double angle = 2.0 * std::numbers::pi * node / n_ring;
  return 0.13 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
}

/// Motions of all nodes as one rigid body: 3 translations, 3 rotations about the origin.
Eigen::MatrixXd rigid_motions()
{
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(6 * n_nodes, 6);
  for (int node = 0; node < n_nodes; ++node) {
    R.block(6 * node, 0, 6, 6).setIdentity();
    for (int axis = 0; axis < 3; ++axis)
      R.block(6 * node, 3 + axis, 3, 1) = Eigen::Vector3d::Unit(axis).cross(position(node));
  }
  return R;
}

/// Thirteen bodies whose springs resist every motion but the rigid ones: K = P^T D P with the
/// projector P = I - R (R^T M R)^-1 R^T M.
mbs_export::ReducedSystem ring_of_bodies()
{
  const Eigen::Index n = 6 * n_nodes;
  mbs_export::ReducedSystem reduced{};
  reduced.title = "ring of bodies";
  Eigen::VectorXd masses(n), springs(n);
  std::vector<int> ring;
  for (int node = 0; node < n_nodes; ++node) {
    reduced.attachment_nodes.push_back({.number = node + 1, .position = position(node)});
    if (node < n_ring) ring.push_back(node);
    for (int component = 0; component < 6; ++component) {
      reduced.masters.push_back({.node = node, .component = component});
      masses[6 * node + component] = component < 3 ? 0.5 : 1e-4;
      springs[6 * node + component] = (component < 3 ? 1e8 : 1e4) * (1.0 + 0.01 * component);
    }
  }
  reduced.sets = {{.name = "track", .nodes = ring}, {.name = "hub", .nodes = {n_ring}}};
  reduced.M = masses.asDiagonal();
  const Eigen::MatrixXd R = rigid_motions();
  const Eigen::MatrixXd M_R = R.transpose() * reduced.M * R;
  const Eigen::MatrixXd P =
      Eigen::MatrixXd::Identity(n, n) - R * M_R.ldlt().solve(R.transpose() * reduced.M);
  const Eigen::MatrixXd K = P.transpose() * springs.asDiagonal() * P;
  reduced.K = 0.5 * (K + K.transpose());
  return reduced;
}

/// The example with a coarse ring, and with `fixed` as the list of what is held.
std::string scene_with(const std::string& fixed)
{
  std::string text = read_text(CHLADNI_SOURCE_DIR "/examples/thesis_disc/scene.toml");
  text = replaced(text, "nodes = 60", "nodes = 12");
  return replaced(text, "fixed = [\"hub\"]", "fixed = " + fixed);
}

TEST(ChladniProgram, MakesTheBodyOfAReducedSystem)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml", scene_with("[\"hub\"]"));
  mbs_export::write_reduced(folder.path() / "disc.reduced.h5", ring_of_bodies());
  const Ending ending = run(folder, chladni_program + " body scene.toml --json summary.json");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  const std::string json = read_text(folder.path() / "summary.json");
  EXPECT_EQ(number_at(json, "n_rigid"), 6);
  EXPECT_EQ(number_at(json, "n_masters"), 6 * n_nodes);
  EXPECT_NE(json.find("\"frequencies_Hz\": ["), std::string::npos);
  const mbs_export::ModalBody body = mbs_export::read_body(folder.path() / "disc.body.h5");
  EXPECT_EQ(body.n_free_rigid, 0);
  EXPECT_NEAR(body.mass, 0.5 * n_nodes, 1e-9);  // round-off of a sum of 13
  const Ending info = run(folder, chladni_program + " info disc.reduced.h5");
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("ring of bodies"), std::string::npos);
}

TEST(ChladniProgram, TellsWhatATolerancePicked)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml",
             replaced(scene_with("[\"hub\"]"), "keep = { modes = 40 }",
                      "keep = { tolerance = 1e-2, up_to_Hz = 1000.0 }"));
  mbs_export::write_reduced(folder.path() / "disc.reduced.h5", ring_of_bodies());
  const Ending ending = run(folder, chladni_program + " body scene.toml");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_NE(ending.out.find("loads at track.z up to 1000 Hz, tolerance 0.01"), std::string::npos);
  EXPECT_NE(ending.out.find("size  error, modes alone  error, with interface modes"),
            std::string::npos);
  EXPECT_NE(ending.out.find("\nchosen: "), std::string::npos) << ending.out;
  const Ending info = run(folder, chladni_program + " info disc.body.h5");
  EXPECT_NE(info.out.find("\nchosen: "), std::string::npos) << info.out;
}

TEST(ChladniProgram, RefusesAFreeDiscThatIsToSqueal)
{
  for (const std::string fixed : {"[]", "[\"hub.z\"]"}) {
    const Folder folder;
    write_text(folder.path() / "scene.toml", scene_with(fixed));
    mbs_export::write_reduced(folder.path() / "disc.reduced.h5", ring_of_bodies());
    const Ending ending = run(folder, chladni_program + " body scene.toml --json summary.json");
    EXPECT_EQ(ending.exit_code, 1);
    EXPECT_NE(ending.err.find("[squeal] needs a body that is held"), std::string::npos)
        << ending.err;
    EXPECT_EQ(std::ranges::count(ending.err, '\n'), 1);
    EXPECT_EQ(folder.n_files(), 2u);
  }
}

TEST(ChladniProgram, SaysHowToMakeTheReducedSystemThatIsMissing)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml", scene_with("[\"hub\"]"));
  const Ending ending = run(folder, chladni_program + " body scene.toml");
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_NE(ending.err.find("`chladni reduce scene.toml --output .`"), std::string::npos)
      << ending.err;
  EXPECT_EQ(folder.n_files(), 1u);
}

TEST(ChladniProgram, ReportsTheQualityOfAMeshFileAndTheElementsThatCannotWork)
{
  const Folder folder;
  const std::string good =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
      "5 3 0 0\n6 3 1 0\n$EndNodes\n$Elements\n2\n11 3 2 1 1 1 2 3 4\n12 3 2 1 1 2 5 6 3\n"
      "$EndElements\n";
  write_text(folder.path() / "good.msh", good);
  write_text(folder.path() / "folded.msh", replaced(good, "6 3 1 0", "6 1.2 0.2 0"));
  const Ending ending =
      run(folder, chladni_program + " mesh good.msh --quality --json quality.json");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_NE(ending.out.find("elements that cannot work: 0\n"), std::string::npos) << ending.out;
  const std::string json = read_text(folder.path() / "quality.json");
  const std::string aspect = json.substr(json.find("\"aspect_ratio\""));
  EXPECT_EQ(number_at(aspect, "max"), 2.0);
  EXPECT_EQ(number_at(aspect, "mean"), 1.5);
  EXPECT_NE(json.find("\"unusable_elements\": []"), std::string::npos) << json;
  const Ending folded = run(folder, chladni_program + " mesh folded.msh --quality");
  EXPECT_EQ(folded.exit_code, 1);
  EXPECT_NE(folded.out.find("elements that cannot work: 1: 12\n"), std::string::npos) << folded.out;
  EXPECT_NE(folded.err.find("folded.msh: 1 elements"), std::string::npos) << folded.err;
  EXPECT_EQ(run(folder, chladni_program + " mesh folded.msh").exit_code, 1);
}

TEST(ChladniProgram, TellsWrongUsageFromAFailedJob)
{
  const Folder folder;
  EXPECT_EQ(run(folder, chladni_program).exit_code, 2);
  EXPECT_EQ(run(folder, chladni_program + " run").exit_code, 2);
  EXPECT_EQ(run(folder, chladni_program + " polish scene.toml").exit_code, 2);
  EXPECT_EQ(run(folder, chladni_program + " run scene.toml --outptu out").exit_code, 2);
  EXPECT_EQ(run(folder, chladni_program + " run scene.toml").exit_code, 1);
}

TEST(ChladniProgram, HelpsWithExamples)
{
  const Folder folder;
  for (const std::string subcommand :
       {"", " mesh", " static", " modes", " reduce", " body", " run", " info"}) {
    const Ending ending = run(folder, chladni_program + subcommand + " --help");
    EXPECT_EQ(ending.exit_code, 0) << subcommand;
    EXPECT_NE(ending.out.find("Example"), std::string::npos) << subcommand;
  }
}

}  // namespace
}  // namespace chladni::cli::testing
