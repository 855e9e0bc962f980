// Screw dislocation along z that meets the free surface z = 0 of a half-space z > 0 at a right angle: total stress
// sigma_theta_z = (mu b / 2 pi r) z / rho, sigma_r_theta = -(mu b / 2 pi) (rho - z)^2 / (rho r^2), rho = sqrt(r^2 + z^2). They follow
// from the image displacement u_theta = (b / 2 pi) (rho - z) / r, which is harmonic in the sense of the torsion of a round body,
// falls off in depth and takes sigma_theta_z off the surface (Eshelby & Stroh, Phil. Mag. 42 (1951) 1401).
#include "image_field.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
constexpr double width = 480, depth = 240, burgers = 0.25;
const Vec3 foot(13, -7, 0); // of the line: nowhere special in the mesh

Vec3 image_displacement(const Vec3 &x)
{
  const Vec3 r = (x - foot).cwiseProduct(Vec3(1, 1, 0));
  const double rho = (x - foot).norm();
  // (rho - z) / r = r / (rho + z), without loss of digits and finite at r = 0.
  return burgers / (2 * M_PI) / (rho + x[2]) * Vec3::UnitZ().cross(r);
}

/// Cylindrical components of a stress about the line.
struct Components
{
  double theta_z, r_theta;
};

Components components(const SymTensor &stress, const double angle)
{
  const Mat3 s = to_matrix(stress);
  const Vec3 radial(std::cos(angle), std::sin(angle), 0), around(-std::sin(angle), std::cos(angle), 0);
  return {around.dot(s * Vec3::UnitZ()), radial.dot(s * around)};
}

/// Errors over mu b / (2 pi r), the stress of the line at the same distance.
struct Errors
{
  double theta_z = 0, r_theta = 0;
  double largest() const { return std::max(theta_z, r_theta); }
};

class Block
{
public:
  /// A block under the surface, its other faces held as the half-space would hold them; @p across elements per side.
  Block(const unsigned across, const unsigned degree)
      : mesh(box_mesh({std::vector<double>(across, width / across), std::vector<double>(across, width / across),
                       std::vector<double>(across / 2, 2 * depth / across)},
                      Vec3(-width / 2, -width / 2, 0))),
        image(*mesh, degree, held_faces())
  {
    Network network;
    add_endless_line(network, foot, Vec3::UnitZ(), Vec3(0, 0, burgers));
    image.solve(LineSystem(medium(), network, nullptr, RayDirection::normal, nullptr, nullptr), image_displacement);
  }
  /// Largest errors at points with these distances from the line and from the surface.
  Errors errors(const std::vector<double> &distances, const std::vector<double> &depths) const
  {
    Errors worst;
    for (const double r : distances)
      for (const double z : depths)
        for (int k = 0; k < 8; ++k)
        {
          const double angle = 0.2 + 2 * M_PI * k / 8, rho = std::hypot(r, z);
          const Vec3 x = foot + Vec3(r * std::cos(angle), r * std::sin(angle), z);
          const Components image_stress = components(image.stress({x})[0], angle);
          const double scale = medium().mu * burgers / (2 * M_PI * r);
          worst.theta_z = std::max(worst.theta_z, std::abs(1 + image_stress.theta_z / scale - z / rho));
          worst.r_theta =
              std::max(worst.r_theta, std::abs(image_stress.r_theta / scale + (rho - z) * (rho - z) / (rho * r)));
        }
    return worst;
  }

private:
  static std::vector<fem::DisplacementCondition> held_faces()
  {
    std::vector<fem::DisplacementCondition> all;
    for (const unsigned face : {0U, 1U, 2U, 3U, 5U}) // not z-
      all.push_back({face, {true, true, true}});
    return all;
  }
  std::unique_ptr<Mesh> mesh;
  ImageField image;
};

const std::vector<double> distances{120, 140, 160}, inside{60, 90, 120}, near{15, 30}, surface{0};
} // namespace

int main(int argc, char **argv)
{
  const bool studies = study_requested(argc, argv);
  return run(argc, argv,
             [&](Report &report)
             {
               const ConvergenceStudy deep(report, "screw_through_surface");
               const ConvergenceStudy at_surface(report, "screw_through_surface_at_surface");
               // Over the smallest distance of the points from the line.
               const auto size = [](const unsigned across) { return width / across / distances.front(); };
               if (studies)
               {
                 for (const unsigned degree : {1U, 2U})
                   for (const unsigned across : {8U, 10U, 12U, 16U, 20U, 24U, 32U, 40U})
                   {
                     if (degree == 2 && across > 24)
                       continue;
                     const Block block(across, degree);
                     deep.add(degree, size(across), block.errors(distances, inside).largest());
                     at_surface.add(degree, size(across), block.errors(distances, surface).largest());
                   }
                 return;
               }
               const Block coarse(10, 2), production(20, 2);
               const Errors all = production.errors(distances, inside), close = production.errors(distances, near),
                            zero = production.errors(distances, surface);
               report.note("errors over mu b / (2 pi r); elements of 24, points at least 120 from the line");
               report.below("sigma_theta_z, 60 and more deep", all.theta_z, 0.02);
               report.below("sigma_r_theta, 60 and more deep", all.r_theta, 0.02);
               report.below("sigma_theta_z, 15 and 30 deep", close.theta_z, 0.02);
               report.below("sigma_r_theta, 15 and 30 deep", close.r_theta, 0.02);
               report.below("sigma_theta_z on the surface", zero.theta_z, 0.02);
               report.below("sigma_r_theta on the surface", zero.r_theta, 0.02);
               const double ratio = all.largest() / coarse.errors(distances, inside).largest();
               report.below("deep points: error over that with elements of 48 (third order: 0.125)", ratio, 0.25);
             });
}
