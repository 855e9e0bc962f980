// A line that threads a foil from face to face, b at the angle phi from the normal in the glide plane, which holds the normal. Left to
// the code's own forces and mobility it comes to rest at the tilt alpha that makes its energy E(alpha) / cos(alpha) least,
// E ~ 1 - nu cos^2(alpha - phi). The same tilt takes the image force off a straight line near each face (Lothe's theorem; Hirth &
// Lothe, section 5-6), so that the line is straight to leading order in the logarithm of thickness over core radius.
#include "dd/forces/nodal_forces.h"
#include "dd/geometry/grain_shape.h"
#include "dd/mobility/linear_glide.h"
#include "dd/mobility/local_velocities.h"
#include "image_field.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
constexpr double thickness = 400, burgers = 0.25;
// The elements resolve the stresses of a core of 25; what is missing to a core of b is core energy.
const IsotropicMedium wide_core{50e3, 0.3, 25};
const ForceSettings settings{wide_core, burgers, 1e-4, RayDirection::normal};
constexpr double drag = 1e-4; // MPa ns; sets the time scale only

/// Tilt (degrees) of least energy: golden-section search.
double expected_tilt(const double phi)
{
  const auto energy = [&](const double alpha)
  { return (1 - wide_core.nu * std::pow(std::cos(alpha - phi), 2)) / std::cos(alpha); };
  double low = 0, high = M_PI / 4;
  const double ratio = 0.5 * (std::sqrt(5.0) - 1);
  while (high - low > 1e-7)
  {
    const double left = high - ratio * (high - low), right = low + ratio * (high - low);
    (energy(left) < energy(right) ? high : low) = energy(left) < energy(right) ? right : left;
  }
  return 0.5 * (low + high) * 180 / M_PI;
}

class Foil
{
public:
  explicit Foil(const unsigned elements) : mesh(make(elements)), image(*mesh, 2, {}) {}

  /// Tilt (degrees) of the chord at which a line that starts along the normal comes to rest; @p last_change is what the last
  /// solution of the image field has changed.
  double relaxed_tilt(const double phi, double &last_change)
  {
    Network network;
    const auto nodes = add_upright_line(network, phi);
    const LinearGlide law({drag, drag});
    // Stable: less than 2 / (largest rate) of a line of this tension and element length.
    const double tension = wide_core.mu * burgers * burgers, step = thickness / pieces,
                 dt = 0.25 * drag * step * step / tension;
    double tilt = 0;
    for (int round = 0; round < rounds; ++round)
    {
      image.solve(LineSystem(wide_core, network, &shape, RayDirection::normal, nullptr, nullptr));
      SegmentField correction{SegmentPoints(network), {}, {}};
      correction.stress = image.stress(correction.points.positions());
      ForceEnvironment environment;
      environment.shape = &shape;
      environment.correction = &correction;
      for (int k = 0; k < steps_per_round; ++k)
      {
        const auto forces = compute_nodal_forces(network, settings, environment, MPI_COMM_WORLD);
        const auto v = glide_velocities(network, forces.total, law, &shape);
        for (const NodeIndex i : nodes)
          network.set_position(i, network.position(i) + dt * v[i.value]);
      }
      const double now = tilt_of(network, nodes);
      last_change = now - tilt;
      tilt = now;
    }
    return tilt;
  }

private:
  static constexpr int pieces = 16, rounds = 16, steps_per_round = 120;

  static std::unique_ptr<Mesh> make(const unsigned elements)
  {
    const double h = thickness / elements;
    const auto across = mirrored(graded(h, thickness / 2, 1.5 * thickness));
    const double half = 0.5 * std::accumulate(across.begin(), across.end(), 0.0);
    return box_mesh({across, across, std::vector<double>(elements, h)}, Vec3(-half, -half, 0));
  }
  static std::vector<NodeIndex> add_upright_line(Network &network, const double phi)
  {
    const PlaneIndex plane = network.planes().find_or_insert({0, 0, 0}, Vec3::UnitY(), Vec3::Zero());
    std::vector<Vec3> points;
    for (int k = 0; k <= pieces; ++k)
      points.emplace_back(0, 0, k * thickness / pieces);
    return add_line(network, points, burgers * Vec3(std::sin(phi), 0, std::cos(phi)), plane, false,
                    NodeConstraint::surface);
  }
  static double tilt_of(const Network &network, const std::vector<NodeIndex> &nodes)
  {
    const Vec3 chord = network.position(nodes.back()) - network.position(nodes.front());
    return std::atan2(chord[0], chord[2]) * 180 / M_PI;
  }
  std::unique_ptr<Mesh> mesh;
  BoxShape shape{Vec3(-1e4, -1e4, 0), Vec3(1e4, 1e4, thickness)}; // only the faces z matter to rays and surface nodes
  ImageField image;
};
} // namespace

int main(int argc, char **argv)
{
  return run(argc, argv,
             [](Report &report)
             {
               Foil foil(6);
               for (const double phi : {15.0, 30.0, 45.0, 60.0, 75.0})
               {
                 double change = 0;
                 const double tilt = foil.relaxed_tilt(phi * M_PI / 180, change);
                 const double expected = expected_tilt(phi * M_PI / 180);
                 char row[120];
                 std::snprintf(row, sizeof row, "b %2.0f degrees from the normal: tilt %5.2f, least energy at %5.2f",
                               phi, tilt, expected);
                 report.note(row);
                 report.below("the difference, degrees", tilt - expected, 2.0);
                 report.below("change in the last round, degrees", change, 0.1);
               }
             });
}
