#pragma once

#include <gmsh.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "file_test.hpp"
#include "mesh/generators.hpp"
#include "surface.hpp"

namespace chladni::mesh::testing {

class MeshFile : public FileTest {
 protected:
  /// What `build` makes in a session of Gmsh, saved in the format of the name.
  std::string save(const std::string& name, const std::function<void()>& build) const
  {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    build();
    gmsh::write(path(name));
    gmsh::finalize();
    return path(name);
  }
};

inline std::string error_of(const MeshOptions& options)
{
  try {
    generate(options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

inline void expect_words(const std::string& text, const std::vector<std::string>& words)
{
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << text;
}

/// A text of a deck that is refused, and what the error must say.
struct Refusal {
  std::string text;
  std::vector<std::string> words;
};

inline void expect_refused(const Refusal& refusal, const std::string& error)
{
  expect_words(error, refusal.words);
  EXPECT_NE(error.find("line "), std::string::npos) << error;
}

inline double area(const Mesh& mesh)
{
  double sum = 0.0;
  for (const ElementBlock& block : mesh.blocks)
    for (int e = 0; e < block.n_elements(); ++e) sum += corner_area_3d(mesh, block, e);
  return sum;
}

/// A rectangle of quadrilaterals n x 1 from x = start to x = start + 1, with its physical group.
inline void add_rectangle(double start, int n, const std::string& name)
{
  namespace geo = gmsh::model::geo;
  const std::array<int, 4> p{geo::addPoint(start, 0, 0), geo::addPoint(start + 1, 0, 0),
                             geo::addPoint(start + 1, 1, 0), geo::addPoint(start, 1, 0)};
  std::vector<int> lines;
  for (std::size_t i = 0; i < 4; ++i) {
    lines.push_back(geo::addLine(p[i], p[(i + 1) % 4]));
    geo::mesh::setTransfiniteCurve(lines.back(), i % 2 == 0 ? n + 1 : 2);
  }
  const int surface = geo::addPlaneSurface({geo::addCurveLoop(lines)});
  geo::mesh::setTransfiniteSurface(surface);
  geo::mesh::setRecombine(2, surface);
  geo::synchronize();
  if (name.empty()) return;
  const int tag = gmsh::model::addPhysicalGroup(2, {surface});
  gmsh::model::setPhysicalName(2, tag, name);
}

}  // namespace chladni::mesh::testing
