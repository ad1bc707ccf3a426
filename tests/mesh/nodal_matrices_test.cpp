#include "mesh/nodal_matrices.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

#include "common/error.hpp"
#include "file_test.hpp"

namespace chladni::mesh {
namespace {

/// Number of a node and component, 1 to 6.
using FileDof = std::pair<std::int64_t, int>;
using FileEntries = std::map<std::pair<FileDof, FileDof>, double>;

/// Nodes of the mesh, m; the last one is in no matrix.
const std::map<std::int64_t, Vector> places{{5, {0.1, 0.0, 0.02}},
                                            {2, {0.4, 0.1, 0.0}},
                                            {9, {0.2, 0.5, 0.1}},
                                            {3, {0.3, 0.2, 0.6}},
                                            {7, {9.0, 9.0, 9.0}}};

constexpr double mm = 1e-3;

/// For each pair of nodes `visit(a, b, number of the pair)`.
void for_pairs(const std::function<void(std::int64_t, std::int64_t, int)>& visit)
{
  int n = 0;
  for (const auto& [a, at_a] : places)
    for (const auto& [b, at_b] : places)
      if (a < b && a != 7 && b != 7) visit(a, b, ++n);
}

void add_dyad(FileEntries& A, const std::map<FileDof, double>& v, double factor)
{
  for (const auto& [i, v_i] : v)
    for (const auto& [j, v_j] : v)
      if (v_i * v_j != 0.0) A[{i, j}] += factor * v_i * v_j;
}

/// Bars between all nodes, whose stiffness is 1 N/mm for the first.
/// @param unit  of length, m
FileEntries bars(double unit)
{
  FileEntries K;
  for_pairs([&](std::int64_t a, std::int64_t b, int n) {
    const Vector d = minus(places.at(b), places.at(a));
    std::map<FileDof, double> stretch;
    for (int c = 0; c < 3; ++c) {
      stretch[{a, c + 1}] = -d[std::size_t(c)] / norm(d);
      stretch[{b, c + 1}] = d[std::size_t(c)] / norm(d);
    }
    add_dyad(K, stretch, n * unit / mm);
  });
  return K;
}

/// Springs in the middle between nodes with rotations: 1 N/mm and 1 N mm, 1 N m for the unit m.
FileEntries springs(double unit)
{
  FileEntries K;
  for_pairs([&](std::int64_t a, std::int64_t b, int n) {
    for (int q = 0; q < 3; ++q) {
      std::map<FileDof, double> move, turn;
      for (const auto& [node, sign] : {std::pair{a, -1.0}, {b, 1.0}}) {
        // (theta x r)_q to the middle r = -sign d / 2 from the node, in units of the file
        const Vector d = minus(places.at(b), places.at(a));
        const double half = -0.5 * sign / unit;
        move[{node, q + 1}] = sign;
        move[{node, (q + 1) % 3 + 4}] = sign * half * d[std::size_t((q + 2) % 3)];
        move[{node, (q + 2) % 3 + 4}] = -sign * half * d[std::size_t((q + 1) % 3)];
        turn[{node, q + 4}] = sign;
      }
      add_dyad(K, move, n * unit / mm);
      add_dyad(K, turn, n * mm / unit);
    }
  });
  return K;
}

/// Rods of n kg with the consistent mass of their translations. A tonne is 1 N s^2/mm.
FileEntries rods(double unit)
{
  FileEntries M;
  for_pairs([&](std::int64_t a, std::int64_t b, int n) {
    for (int c = 1; c <= 3; ++c) {
      for (const std::int64_t node : {a, b}) M[{{node, c}, {node, c}}] += n * unit / 3.0;
      M[{{a, c}, {b, c}}] += n * unit / 6.0;
      M[{{b, c}, {a, c}}] += n * unit / 6.0;
    }
  });
  return M;
}

std::vector<FileDof> rows_of(const FileEntries& K)
{
  std::vector<FileDof> rows;
  for (const auto& [at, value] : K)
    if (at.first == at.second) rows.push_back(at.first);
  return rows;
}

/// What CalculiX writes: one triangle by the numbers of rows.
std::string of_calculix(const FileEntries& A, const std::vector<FileDof>& rows)
{
  std::string text;
  for (std::size_t j = 0; j < rows.size(); ++j)
    for (std::size_t i = 0; i <= j; ++i)
      if (const auto at = A.find({rows[i], rows[j]}); at != A.end())
        text += fmt::format("{} {} {:.16e}\n", i + 1, j + 1, at->second);
  return text;
}

std::string of_abaqus(const FileEntries& A)
{
  std::string text = "** of a test\n*MATRIX\n";
  for (const auto& [at, value] : A)
    if (at.first >= at.second) {
      text += fmt::format("{},{}, {},{}, {:+.16e}\n", at.first.first, at.first.second,
                          at.second.first, at.second.second, value);
    }
  return text;
}

/// Both triangles.
std::string of_market(const FileEntries& A, const std::vector<FileDof>& rows)
{
  std::string text;
  int n = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < rows.size(); ++j)
      if (const auto at = A.find({rows[i], rows[j]}); at != A.end()) {
        text += fmt::format("{} {} {:.16e}\n", i + 1, j + 1, at->second);
        ++n;
      }
  return fmt::format("%%MatrixMarket matrix coordinate real general\n% of a test\n{} {} {}\n{}",
                     rows.size(), rows.size(), n, text);
}

std::string table_of(const std::vector<FileDof>& rows)
{
  std::string text = "node.component\n# of a test\n";
  for (const auto& [node, component] : rows) text += fmt::format("{}.{}\n", node, component);
  return text;
}

class NodalMatricesOfFiles : public testing::FileTest {
 protected:
  struct Text {
    std::string K, M, table;
  };
  static Text calculix(const FileEntries& K, const FileEntries& M)
  {
    const std::vector<FileDof> rows = rows_of(K);
    return {of_calculix(K, rows), of_calculix(M, rows), table_of(rows)};
  }

  /// Of files in N and mm.
  MeshOptions options(const Text& text) const
  {
    MeshOptions options;
    options.length_unit = mm;
    options.matrices =
        MatrixFiles{.stiffness = write("disc.sti", text.K), .mass = write("disc.mas", text.M)};
    if (!text.table.empty()) options.matrices->dofs = write("disc.dof", text.table);
    return options;
  }

  static Mesh nodes()
  {
    Mesh mesh;
    for (const std::int64_t number : {5, 7, 2, 9, 3}) {
      mesh.node_numbers.push_back(number);
      mesh.positions.push_back(places.at(number));
    }
    mesh.groups = {{.name = "far", .dimension = 0, .nodes = {1}}};
    return mesh;
  }

  Mesh read(const Text& text) const
  {
    Mesh mesh = nodes();
    add_matrices(mesh, options(text));
    return mesh;
  }

  std::string refusal(const Text& text) const
  {
    try {
      read(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }
};

/// Of both triangles, by numbers and components.
FileEntries whole(const Mesh& mesh, const std::vector<MatrixEntry>& matrix)
{
  const auto dof = [&](int i) { return FileDof{mesh.node_numbers[std::size_t(i / 6)], i % 6 + 1}; };
  FileEntries A;
  for (const auto& [row, column, value] : matrix) {
    A[{dof(row), dof(column)}] = value;
    A[{dof(column), dof(row)}] = value;
  }
  return A;
}

void expect_equal(const FileEntries& found, const FileEntries& expected)
{
  EXPECT_NEAR(double(found.size()), double(expected.size()), 4.0);  // some are zero
  for (const auto& [at, value] : expected) {
    const double scale =
        std::sqrt(expected.at({at.first, at.first}) * expected.at({at.second, at.second}));
    const auto same = found.find(at);
    EXPECT_NEAR(same == found.end() ? 0.0 : same->second, value, 1e-14 * scale)  // of 17 digits
        << at.first.first << "." << at.first.second << ", " << at.second.first << "."
        << at.second.second;
  }
}

TEST_F(NodalMatricesOfFiles, AreTheSameOfEachProgramInSI)
{
  const FileEntries K = bars(mm), M = rods(mm);
  const std::vector<FileDof> rows = rows_of(K);
  for (const Text& text : {calculix(K, M), Text{of_abaqus(K), of_abaqus(M), ""},
                           Text{of_market(K, rows), of_market(M, rows), table_of(rows)}}) {
    const Mesh mesh = read(text);
    EXPECT_EQ(mesh.node_numbers, (std::vector<std::int64_t>{5, 2, 9, 3})) << "but the unused one";
    EXPECT_EQ(mesh.matrices->n_components, (std::vector<std::int8_t>{3, 3, 3, 3}));
    EXPECT_TRUE(mesh.matrices->C.empty());
    EXPECT_TRUE(mesh.matrices->H.empty());
    expect_equal(whole(mesh, mesh.matrices->K), bars(1.0));
    expect_equal(whole(mesh, mesh.matrices->M), rods(1.0));
    EXPECT_TRUE(is_mass_of_points(*mesh.matrices));
  }
}

TEST_F(NodalMatricesOfFiles, HaveRotationsInSI)
{
  const Mesh mesh = read(calculix(springs(mm), rods(mm)));
  EXPECT_EQ(mesh.matrices->n_components, (std::vector<std::int8_t>{6, 6, 6, 6}));
  expect_equal(whole(mesh, mesh.matrices->K), springs(1.0));
}

TEST_F(NodalMatricesOfFiles, HaveABlockForEachPairOfNodesInAscendingOrder)
{
  const Mesh mesh = read(calculix(bars(mm), rods(mm)));
  std::vector<std::vector<int>> blocks;
  for_connected_nodes(mesh, [&](std::span<const int> nodes) {
    if (nodes.size() == 2) {
      EXPECT_LT(nodes[0], nodes[1]);
    }
    blocks.emplace_back(nodes.begin(), nodes.end());
  });
  EXPECT_EQ(blocks.size(), 2u * 10) << "of K and of M";
  std::ranges::sort(blocks);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  EXPECT_EQ(blocks.size(), 10u);
}

TEST_F(NodalMatricesOfFiles, TellTheMassAndItsCentre)
{
  Vector moment{};
  double m = 0.0;
  for_pairs([&](std::int64_t a, std::int64_t b, int n) {
    m += n;
    for (std::size_t c = 0; c < 3; ++c) moment[c] += 0.5 * n * (places.at(a)[c] + places.at(b)[c]);
  });
  const std::string expected =
      fmt::format("the mass {:.6g} kg with its centre at ({:.4g}, {:.4g}, {:.4g}) m", m,
                  moment[0] / m, moment[1] / m, moment[2] / m);
  for (const FileEntries& K : {bars(mm), springs(mm)}) {
    const Mesh mesh = read(calculix(K, rods(mm)));
    ASSERT_EQ(mesh.notes.size(), 1u);
    EXPECT_NE(mesh.notes[0].find(expected), std::string::npos) << mesh.notes[0];
  }
}

TEST_F(NodalMatricesOfFiles, HaveDampersAndAForceUnit)
{
  const FileEntries K = bars(mm);
  MeshOptions wanted = options(calculix(K, rods(mm)));
  wanted.matrices->damping = write("disc.dam", of_calculix(K, rows_of(K)));
  wanted.matrices->structural_damping = write("disc.str", of_calculix(K, rows_of(K)));
  wanted.matrices->force_unit = 1000.0;
  Mesh mesh = nodes();
  add_matrices(mesh, wanted);
  FileEntries expected = bars(1.0);
  for (auto& [at, value] : expected) value *= 1000.0;
  for (const auto* matrix : {&mesh.matrices->K, &mesh.matrices->C, &mesh.matrices->H})
    expect_equal(whole(mesh, *matrix), expected);
}

TEST_F(NodalMatricesOfFiles, LeaveTheNodesThatACouplingNeeds)
{
  MeshOptions wanted = options(calculix(bars(mm), rods(mm)));
  wanted.coupled_groups = {"far"};
  Mesh mesh = nodes();
  add_matrices(mesh, wanted);
  EXPECT_EQ(mesh.node_numbers, (std::vector<std::int64_t>{5, 7, 2, 9, 3}));
  EXPECT_EQ(mesh.matrices->n_components, (std::vector<std::int8_t>{3, 0, 3, 3, 3}));
  EXPECT_EQ(mesh.groups.size(), 1u);
  expect_equal(whole(mesh, mesh.matrices->K), bars(1.0));
}

TEST_F(NodalMatricesOfFiles, NeedARowForEachNodeOfAnElement)
{
  Mesh mesh = nodes();
  mesh.blocks = {{.shape = Shape::triangle,
                  .order = 1,
                  .nodes_per_element = 3,
                  .numbers = {17},
                  .nodes = {0, 1, 2},
                  .group = {-1}}};
  try {
    add_matrices(mesh, options(calculix(bars(mm), rods(mm))));
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("disc.sti has no row of node 7, which element 17 has"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(NodalMatricesOfFiles, MayHaveTheRoundOffOfTenDigits)
{
  const FileDof x{5, 1}, y{2, 2};
  const FileEntries M = rods(mm);
  FileEntries K = bars(mm);
  const std::vector<FileDof> rows = rows_of(K);
  const double scale = std::sqrt(K.at({x, x}) * K.at({y, y}));
  K.at({x, y}) += 0.9e-9 * scale;
  EXPECT_NO_THROW(read({of_market(K, rows), of_market(M, rows), table_of(rows)}));
  K.at({x, y}) += 0.2e-9 * scale;
  EXPECT_NE(refusal({of_market(K, rows), of_market(M, rows), table_of(rows)})
                .find("on the other side of the diagonal"),
            std::string::npos);
  // Of the sum over the four nodes that a row of K has.
  for (const double share : {2e-8, 8e-8}) {
    K = bars(mm);
    K.at({x, x}) *= 1.0 + share;
    EXPECT_EQ(refusal(calculix(K, M)) == "accepted", share < 4e-8) << refusal(calculix(K, M));
  }
  FileEntries uneven = M;
  const double m = 21.0 * mm;
  for (const double share : {0.5e-6, 2e-6}) {
    uneven.at({x, x}) = M.at({x, x}) + 1.5 * share * m;  // a third of it is in the mean
    EXPECT_EQ(refusal(calculix(bars(mm), uneven)) == "accepted", share < 1e-6);
  }
}

TEST_F(NodalMatricesOfFiles, RefuseWhatIsNoFreeBody)
{
  const FileDof x{5, 1}, z{5, 3};
  const auto expect = [&](const FileEntries& K, const FileEntries& M,
                          const std::vector<std::string>& words) {
    const std::string said = refusal({of_abaqus(K), of_abaqus(M), ""});
    for (const std::string& word : words) EXPECT_NE(said.find(word), std::string::npos) << said;
  };
  const FileEntries K = bars(mm), M = rods(mm);
  FileEntries held = K;
  held.at({x, x}) *= 2.0;
  expect(held, M, {"disc.sti: node 5, DOF 1 resists a translation along x", "; 1 such rows"});
  held.at({x, x}) = 1e30;
  expect(held, M, {"1e+30 at node 5 holds it", "supports"});
  held.at({x, x}) = 0.9e30;
  expect(held, M, {"resists a translation along x"});
  // Springs that do not act through the nodes, at the end of a system of axes that is turned.
  FileEntries turned = K;
  for (auto& [at, value] : turned)
    if (at.first.second != at.second.second && at.first.second < 3 && at.second.second < 3)
      value = -value;
  expect(turned, M, {"resists a rotation about", "local axes"});
  FileEntries missing = K, light = M;
  const auto is_of_y = [](const auto& entry) {
    return entry.first.first == FileDof{5, 2} || entry.first.second == FileDof{5, 2};
  };
  std::erase_if(missing, is_of_y);
  std::erase_if(light, is_of_y);
  expect(missing, light, {"node 5 has the DOFs 1, 3 alone"});
  expect(missing, M, {"node 5, DOF 2 has the diagonal 0", "since disc.mas has the row"});
  FileEntries soft = K;
  soft.at({x, x}) = -1.0;
  expect(soft, M, {"node 5, DOF 1 has the diagonal -1000", "must be positive"});
  light = M;
  light.at({x, x}) = -1e-3;
  expect(K, light, {"disc.mas: node 5, DOF 1 has the negative mass -1 kg"});
  light = M;
  light.at({z, z}) += 0.021;
  expect(K, light,
         {"mass of no body: 21 kg along x, 21 along y, 42 along z", "most unlike at node 5"});
  FileEntries none = M;
  for (auto& [at, value] : none) value = 0.0;
  expect(K, none, {"mass of no body"});
  // The mass between directions moves the centre of translations along x against that along y.
  light = M;
  light[{{5, 1}, {9, 2}}] = light[{{9, 2}, {5, 1}}] = 1e-3;
  light[{{5, 1}, {3, 2}}] = light[{{3, 2}, {5, 1}}] = -1e-3;
  expect(K, light, {"mass of no body"});
}

TEST_F(NodalMatricesOfFiles, NameTheLineThatCannotBeRead)
{
  const FileEntries K = bars(mm), M = rods(mm);
  const std::vector<FileDof> rows = rows_of(K);
  const Text good = calculix(K, M);
  const std::string market = of_market(K, rows), abaqus = of_abaqus(K);
  const auto with = [](std::string text, const std::string& old, const std::string& now) {
    return text.replace(text.find(old), old.size(), now);
  };
  struct Case {
    Text text;
    std::string said;
  };
  const std::string first = good.K.substr(0, good.K.find('\n') + 1);
  for (const auto& [text, said] : {
           Case{{"1 1 2 3.0\n", good.M, good.table}, "disc.sti, line 1: must be \"row column val"},
           {{"1 1\n", good.M, good.table}, "disc.sti, line 1: must be \"row column value\""},
           {{abaqus + "2,1,2,1,1,1\n", of_abaqus(M), ""}, "must be \"row column value\""},
           {{"1 1 x3\n", good.M, good.table}, "disc.sti, line 1: \"x3\" is no number"},
           {{"1 1 3 x\n", good.M, good.table}, "must be"},
           {{"1 1 inf\n", good.M, good.table}, "inf is not finite"},
           {{"0 1 1.0\n", good.M, good.table}, "row 0 is none of the 12 rows of disc.dof"},
           {{"1 13 1.0\n", good.M, good.table}, "row 13 is none of the 12 rows of disc.dof"},
           {{good.K + first, good.M, good.table}, "disc.sti, lines 1 and "},
           {{good.K, good.M, ""}, "`dofs` in mesh.matrices must name the table"},
           {{good.K, good.M, "# nothing\n"}, "disc.dof has no rows"},
           {{good.K, good.M, good.table + "5.1.1\n"}, "must be the node and the component"},
           {{good.K, good.M, good.table + "2.1\n"}, "line 3 has the same node and component"},
           {{good.K, good.M, good.table + "99.1\n"}, "the mesh file has no node 99"},
           {{good.K, good.M, "5.1\nnode.component\n"}, "disc.dof, line 2: \"node\" is no number"},
           {{abaqus + "-3,1, -3,1, 1.0\n", of_abaqus(M), ""}, "node -3 is an internal one"},
           {{abaqus + "0,1, 0,1, 1.0\n", of_abaqus(M), ""}, "node 0 is an internal one"},
           {{abaqus + "2,7, 2,7, 1.0\n", of_abaqus(M), ""}, "DOF 7 of node 2"},
           {{abaqus + "2,0, 2,0, 1.0\n", of_abaqus(M), ""}, "DOF 0 of node 2"},
           {{"** nothing\n", of_abaqus(M), ""}, "disc.sti has no entries"},
           {{with(market, "12 12", "13 13"), good.M, good.table},
            "line 3: 13 rows, but disc.dof has 12"},
           {{with(market, "12 12 144", "12 12 143"), good.M, good.table},
            "disc.sti has 144 of its 143 entries"},
           {{with(market, "12 12 144", "12 12"), good.M, good.table},
            "must be the numbers of rows, columns and entries"},
           {{with(market, "real general", "complex general"), good.M, good.table}, "can be read"},
           {{with(market, "general", "skew-symmetric"), good.M, good.table}, "can be read"},
           {{with(market, "coordinate", "array"), good.M, good.table}, "can be read"},
           {{with(market, "\n1 2 ", "\n% 1 2 "), good.M, good.table}, "of its 144 entries"},
       })
    EXPECT_NE(refusal(text).find(said), std::string::npos) << refusal(text);
  // Numbers may be integers, with their sign and in other lines; a matrix may be said to be so.
  EXPECT_NO_THROW(read({with(market, "real", "integer"), good.M, good.table}));
  std::string half = market;
  half = with(half, fmt::format("\n1 2 {:.16e}", K.at({rows[0], rows[1]})), "");
  half = with(half, "12 12 144", "12 12 143");
  EXPECT_NE(refusal({half, good.M, good.table}).find("but nothing on the other side"),
            std::string::npos)
      << refusal({half, good.M, good.table});
}

TEST(MassOfPoints, HasNeitherDirectionsNorRotations)
{
  const auto is_of_points = [](const std::vector<MatrixEntry>& M) {
    return is_mass_of_points({.n_components = {3, 3}, .K = {}, .M = M, .C = {}, .H = {}});
  };
  const std::vector<MatrixEntry> good{{0, 0, 2.0}, {1, 1, 2.0}, {2, 2, 2.0},
                                      {0, 6, 1.0}, {1, 7, 1.0}, {2, 8, 1.0}};
  EXPECT_TRUE(is_of_points(good));
  std::vector<MatrixEntry> other = good;
  other[1].value *= 1.0 + 1.2e-11;  // of its own and of the mean of three
  EXPECT_TRUE(is_of_points(other));
  other[1].value = 2.0 * (1.0 + 3e-11);
  EXPECT_FALSE(is_of_points(other));
  other = good;
  other.insert(other.begin() + 4, {0, 7, 0.1});
  EXPECT_FALSE(is_of_points(other)) << "x moves y";
  other = good;
  other.pop_back();
  EXPECT_FALSE(is_of_points(other)) << "nothing along z";
  other = good;
  other.insert(other.begin() + 3, {{3, 3, 2.0}, {4, 4, 2.0}, {5, 5, 2.0}});
  EXPECT_FALSE(is_of_points(other)) << "rotary inertia";
}

}  // namespace
}  // namespace chladni::mesh
