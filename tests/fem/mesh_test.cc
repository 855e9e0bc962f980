#include "support.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace ddfem::fem::test
{
namespace
{
constexpr double pi = std::numbers::pi;

/// The message of the exception, or nothing.
template <typename Exception, typename Function> std::string message_of(Function &&function)
{
  try
  {
    function();
  }
  catch (const Exception &error)
  {
    return error.what();
  }
  return "";
}

std::string scratch_file(const std::string &content)
{
  static int counter = 0;
  const auto path = std::filesystem::temp_directory_path() /
                    ("ddfem_mesh_" + std::to_string(getpid()) + "_" + std::to_string(counter++) + ".msh");
  std::ofstream(path) << content;
  return path.string();
}

std::string text_of(const std::string &path)
{
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string error_of_file(const std::string &content)
{
  MeshParameters parameters;
  parameters.shape = MeshParameters::Shape::gmsh;
  parameters.file = scratch_file(content);
  const std::string message = message_of<std::runtime_error>([&] { make_mesh(MPI_COMM_SELF, parameters); });
  EXPECT_NE(message.find(parameters.file), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  std::filesystem::remove(parameters.file);
  return message;
}

/// Area vectors of a closed surface cancel; a third of the flux of x through it is the volume.
std::pair<Vector, double> closure(const std::vector<BoundaryFacet> &facets)
{
  Vector area;
  double volume = 0.;
  for (const auto &facet : facets)
  {
    const auto &v = facet.vertices;
    for (const auto &[a, b, c] : {std::array<Point, 3>{v[0], v[1], v[2]}, std::array<Point, 3>{v[0], v[2], v[3]}})
    {
      const Vector normal = 0.5 * cross_product_3d(b - a, c - a);
      area += normal;
      volume += normal * Vector(a + (b - a) / 3. + (c - a) / 3.) / 3.;
    }
  }
  return {area, volume};
}
MeshParameters pillar()
{
  MeshParameters p;
  p.shape = MeshParameters::Shape::pillar;
  p.pillar = {100., 300., 0.06, 40., 400., 120.};
  p.subdivisions = {6, 3, 6};
  p.origin = {10., -20., 30.};
  return p;
}

} // namespace

TEST(Mesh, BoxHasItsPlaceSizeAndBoundaryIds)
{
  const auto mesh = make_mesh(MPI_COMM_WORLD, box({200., 300., 500.}, {2, 3, 5}, {-100., 50., 1000.}));
  const auto [low, high] = bounding_box(*mesh);
  EXPECT_LT(low.distance(Point(-100., 50., 1000.)), 1e-9);
  EXPECT_LT(high.distance(Point(100., 350., 1500.)), 1e-9);
  EXPECT_NEAR(volume(*mesh), 3e7, 1e-4);
  const auto areas = boundary_areas(*mesh);
  ASSERT_EQ(areas.size(), 6u);
  EXPECT_NEAR(areas.at(0), 1.5e5, 1e-6);
  EXPECT_NEAR(areas.at(3), 1e5, 1e-6);
  EXPECT_NEAR(areas.at(5), 6e4, 1e-6);
  for (const auto &facet : boundary_facets(*mesh))
  {
    const std::array<double, 6> planes = {-100., 100., 50., 350., 1000., 1500.};
    for (const auto &vertex : facet.vertices)
    {
      EXPECT_NEAR(vertex[facet.boundary / 2], planes[facet.boundary], 1e-9);
    }
  }
}

TEST(Mesh, BoundaryFacetsFormAClosedSurfaceSeenFromOutside)
{
  for (const auto &parameters :
       {box({200., 300., 500.}, {2, 3, 5}), cylinder(100., 300., 6, 4), mesh_file("pillar.msh"), pillar()})
  {
    const auto mesh = make_mesh(MPI_COMM_WORLD, parameters);
    const auto facets = boundary_facets(*mesh);
    const auto [area, enclosed] = closure(facets);
    const double exact = volume(*mesh, 1);
    EXPECT_LT(area.norm(), 1e-10 * std::cbrt(exact * exact));
    EXPECT_NEAR(enclosed / exact, 1., 1e-10);
    const auto serial = make_mesh(MPI_COMM_SELF, parameters);
    const auto expected = boundary_facets(*serial);
    ASSERT_EQ(facets.size(), expected.size());
    for (std::size_t i = 0; i < facets.size(); ++i)
    {
      EXPECT_LT(facets[i].vertices[0].distance(expected[i].vertices[0]), 1e-9);
      EXPECT_EQ(facets[i].boundary, expected[i].boundary);
    }
  }
}

TEST(Mesh, QuadraticCylinderConvergesToTheRoundOne)
{
  double previous = 0.;
  for (const unsigned across : {4u, 8u, 16u})
  {
    const auto mesh = make_mesh(MPI_COMM_WORLD, cylinder(100., 300., across, 3));
    const double error = std::abs(volume(*mesh, 2) / (pi * 1e4 * 300.) - 1.);
    EXPECT_LT(error, across == 4 ? 2e-3 : previous / 12.);
    previous = error;
    const auto areas = boundary_areas(*mesh, 2);
    EXPECT_NEAR(areas.at(0) / (2. * pi * 100. * 300.), 1., 2. * error);
    EXPECT_NEAR(areas.at(1) / (pi * 1e4), 1., 2. * error);
    EXPECT_NEAR(areas.at(2) / (pi * 1e4), 1., 2. * error);
  }
}

TEST(Mesh, RefinedCylinderStaysRoundWhereverItStands)
{
  auto parameters = cylinder(100., 300., 4, 3);
  parameters.origin = {1000., -500., 70.};
  parameters.refinements = 1;
  const auto mesh = make_mesh(MPI_COMM_WORLD, parameters);
  for (const auto &facet : boundary_facets(*mesh))
  {
    for (const auto &x : facet.vertices)
    {
      if (facet.boundary == 0)
      {
        EXPECT_NEAR(std::hypot(x[0] - 1000., x[1] + 500.), 100., 1e-9);
      }
      else
      {
        EXPECT_NEAR(x[2], facet.boundary == 1 ? 70. : 370., 1e-9);
      }
    }
  }
}

TEST(Mesh, PillarConvergesToConeFilletAndBase)
{
  // Solid of revolution by Simpson's rule on the profile, the fillet in its angle.
  auto parameters = pillar();
  const PillarGeometry &g = parameters.pillar;
  const double rc = g.foot_radius(), rho = g.fillet_radius;
  double pillar_volume = 0.;
  const int n = 2000;
  const auto add = [&](const double z0, const double z1, const double r0, const double rm, const double r1)
  { pillar_volume += pi * (z1 - z0) / 6. * (r0 * r0 + 4. * rm * rm + r1 * r1); };
  const auto height = [&](const double angle) { return rho * (1. - std::sin(angle)); };
  for (int k = 0; k < n; ++k)
  {
    const double a = pi / 2. + (g.taper - pi / 2.) * k / n, b = pi / 2. + (g.taper - pi / 2.) * (k + 1) / n;
    const double middle = 0.5 * (height(a) + height(b));
    add(height(a), height(b), rc - rho * std::cos(a), g.radius_at(middle), rc - rho * std::cos(b));
  }
  const double zt = g.fillet_top();
  add(zt, g.height, g.radius_at(zt), g.radius_at(0.5 * (zt + g.height)), g.top_radius);
  const double exact = pillar_volume + g.base_width * g.base_width * g.base_height;
  double previous = 0.;
  for (unsigned refinements = 0; refinements < 3; ++refinements)
  {
    parameters.refinements = refinements;
    const auto mesh = make_mesh(MPI_COMM_WORLD, parameters);
    const double error = std::abs(volume(*mesh, 2) / exact - 1.);
    EXPECT_LT(error, refinements == 0 ? 1e-3 : previous / 8.); // fourth order in the cell size
    previous = error;
    const auto areas = boundary_areas(*mesh, 2);
    ASSERT_EQ(areas.size(), 5u);
    EXPECT_NEAR(areas.at(1), 400. * 400., 1e-6);
    EXPECT_NEAR(areas.at(2) / (pi * 1e4), 1., 1e-3);
    EXPECT_NEAR(areas.at(3) / (400. * 400. - pi * rc * rc), 1., 2e-3);
    EXPECT_NEAR(areas.at(4), 4. * 400. * 120., 1e-6);
  }
}

TEST(Mesh, RefinedPillarKeepsItsProfile)
{
  for (const double rho : {0., 40.})
  {
    auto parameters = pillar();
    parameters.pillar.fillet_radius = rho;
    parameters.refinements = 2;
    const auto mesh = make_mesh(MPI_COMM_WORLD, parameters);
    const PillarGeometry &g = parameters.pillar;
    for (const auto &facet : boundary_facets(*mesh))
    {
      for (const auto &x : facet.vertices)
      {
        const double r = std::hypot(x[0] - 10., x[1] + 20.), z = x[2] - 150.;
        if (facet.boundary == 0 && z > 1e-9)
        {
          EXPECT_NEAR(r, g.radius_at(z), 1e-6);
        }
        else if (facet.boundary == 3 || facet.boundary == 0)
        {
          EXPECT_NEAR(z, 0., 1e-9);
          EXPECT_GT(r, g.foot_radius() - 1e-6);
        }
      }
    }
  }
}

TEST(Mesh, CantileverIsABeamOnABlockWithNamedFaces)
{
  MeshParameters p;
  p.shape = MeshParameters::Shape::cantilever;
  p.size = {400., 80., 60.};
  p.block = {150., 200., 180.};
  p.subdivisions = {8, 2, 2};
  const auto mesh = make_mesh(MPI_COMM_WORLD, p);
  EXPECT_NEAR(volume(*mesh), 400. * 80. * 60. + 150. * 200. * 180., 1e-4);
  const auto areas = boundary_areas(*mesh);
  EXPECT_NEAR(areas.at(0), 80. * 60., 1e-6);
  EXPECT_NEAR(areas.at(1), 200. * 180., 1e-6);
  EXPECT_NEAR(areas.at(2), 400. * 60., 1e-6);
  EXPECT_NEAR(areas.at(5), 400. * 80., 1e-6);
  EXPECT_NEAR(areas.at(6), 2. * 150. * (200. + 180.) + 200. * 180. - 80. * 60., 1e-6);
  EXPECT_EQ(boundary_id_of(boundary_names(p), "beam-z+"), 5u);
}

TEST(Mesh, GmshFilesOfBothFormatsKeepTheirGroupsAndUnit)
{
  const auto bar = make_mesh(MPI_COMM_WORLD, mesh_file("bar.msh"));
  const auto areas = boundary_areas(*bar);
  ASSERT_EQ(areas.size(), 3u);
  EXPECT_NEAR(areas.at(1), 1.6e5, 1e-6);
  EXPECT_NEAR(areas.at(2), 1.6e5, 1e-6);
  EXPECT_NEAR(areas.at(3), 4. * 400. * 1200., 1e-5);
  const auto pillar = make_mesh(MPI_COMM_WORLD, mesh_file("pillar.msh"));
  EXPECT_NEAR(volume(*pillar) / (pi * 500. * 500. * 2000.), 1., 0.03);
  const auto names = boundary_names(mesh_file("pillar.msh"));
  EXPECT_EQ(names.at(1), "bottom");
  EXPECT_EQ(boundary_id_of(names, "side"), 3u);
}

TEST(Mesh, BoundaryNamesAreKnownAndMistakesAreAnswered)
{
  const auto names = boundary_names(box({1., 1., 1.}, {1, 1, 1}));
  EXPECT_EQ(boundary_id_of(names, "z+"), 5u);
  EXPECT_EQ(boundary_id_of(names, "4"), 4u);
  const auto message = message_of<std::invalid_argument>([&] { boundary_id_of(names, "top"); });
  EXPECT_NE(message.find("'top'"), std::string::npos) << message;
  EXPECT_NE(message.find("y-"), std::string::npos) << message;
}

TEST(Mesh, SenselessParametersAreRefused)
{
  const auto error = [](const MeshParameters &p)
  { return message_of<std::invalid_argument>([&] { make_mesh(MPI_COMM_SELF, p); }); };
  EXPECT_NE(error(box({1., -2., 1.}, {1, 1, 1})).find("-2 nm"), std::string::npos);
  EXPECT_NE(error(box({1., 1., 1.}, {1, 0, 1})).find("at least one cell"), std::string::npos);
  EXPECT_NE(error(cylinder(-1., 1., 4, 1)).find("radius"), std::string::npos);
  EXPECT_NE(error(cylinder(1., 1., 2, 1)).find("3 cells"), std::string::npos);
  auto wide = pillar();
  wide.pillar.base_width = 250.;
  EXPECT_NE(error(wide).find("250 nm wide"), std::string::npos);
  auto tall = pillar();
  tall.pillar.fillet_radius = 400.;
  EXPECT_NE(error(tall).find("fillet of radius 400"), std::string::npos);
  EXPECT_NE(error(mesh_file("bar.msh", 0.)).find("bar.msh"), std::string::npos);
}

TEST(Mesh, UnusableFilesAreNamedWithTheReason)
{
  const auto missing = message_of<std::runtime_error>([] { make_mesh(MPI_COMM_SELF, mesh_file("nowhere.msh")); });
  EXPECT_NE(missing.find("nowhere.msh"), std::string::npos) << missing;
  const std::string bar = text_of(mesh_file("bar.msh").file), pillar = text_of(mesh_file("pillar.msh").file);
  EXPECT_NE(error_of_file("hello\n").find("MeshFormat"), std::string::npos);
  EXPECT_NE(error_of_file("$MeshFormat\n4 0 8\n$EndMeshFormat\n").find("2.2 or 4.1"), std::string::npos);
  EXPECT_NE(error_of_file("$MeshFormat\n4.1 1 8\n$EndMeshFormat\n").find("binary"), std::string::npos);
  EXPECT_NE(error_of_file(bar.substr(0, bar.size() / 2)).find("mesh file"), std::string::npos);

  const std::string tetrahedron =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
      "$EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";
  EXPECT_NE(error_of_file(tetrahedron).find("tetrahedra"), std::string::npos);

  // The same pillar without the group of its top.
  std::string bare;
  std::istringstream lines(pillar);
  for (std::string line; std::getline(lines, line);)
  {
    std::istringstream words(line);
    int number = 0, type = 0, n_tags = 0, group = 0;
    const bool top = (words >> number >> type >> n_tags >> group) && type == 3 && n_tags == 2 && group == 2;
    bare += top ? line.replace(line.find(" 3 2 2 "), 7, " 3 2 0 ") + "\n" : line + "\n";
  }
  EXPECT_NE(error_of_file(bare).find("no physical surface"), std::string::npos);
}
} // namespace ddfem::fem::test
