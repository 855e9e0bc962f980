// Triangular loops under a free plane z = 0 with their image stress from Mindlin's half-space tensor
// (tests/data/halfspace_loops.json).
#pragma once

#include "dd/elasticity/isotropic.h"
#include "dd/microstructure/sources.h"

#include <nlohmann/json.hpp>

#include <array>
#include <fstream>
#include <vector>

namespace ddfem::validation
{
struct ReferenceLoop
{
  double mu, nu;
  Network network;
  std::vector<Vec3> points;
  std::vector<std::array<double, 6>> image_stress; ///< at the points
};

inline Vec3 vector_of(const nlohmann::json &j)
{
  return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

inline std::vector<ReferenceLoop> reference_loops()
{
  std::ifstream in(DDFEM_TEST_DATA "/halfspace_loops.json");
  const auto file = nlohmann::json::parse(in); // outlives the loop: a range over parse(in)["cases"] would dangle
  std::vector<ReferenceLoop> loops;
  for (const auto &test : file["cases"])
  {
    ReferenceLoop loop{test["mu"].get<double>(), test["nu"].get<double>(), {}, {}, {}};
    std::vector<Vec3> corners;
    for (const auto &v : test["vertices"])
      corners.push_back(vector_of(v));
    add_line(loop.network, corners, vector_of(test["b"]), {}, true, NodeConstraint::free);
    for (const auto &x : test["points"])
      loop.points.push_back(vector_of(x));
    for (const auto &s : test["image_stress"])
      loop.image_stress.push_back(s.get<std::array<double, 6>>());
    loops.push_back(std::move(loop));
  }
  return loops;
}

/// Largest error of a component, relative to the largest component expected.
inline double largest_error(const std::vector<SymTensor> &stress, const std::vector<std::array<double, 6>> &expected)
{
  double error = 0, scale = 0;
  for (std::size_t k = 0; k < stress.size(); ++k)
    for (std::size_t c = 0; c < 6; ++c)
    {
      error = std::max(error, std::abs(stress[k][static_cast<Eigen::Index>(c)] - expected[k][c]));
      scale = std::max(scale, std::abs(expected[k][c]));
    }
  return error / scale;
}
} // namespace ddfem::validation
