// The main job: an aluminium pillar with a Frank-Read source, compressed until a slip step has crossed it. What history.csv and
// the deformed surface say is compared with elasticity, with the critical stress of the source in an unbounded body, and with the
// Burgers vector.
#include "coupling/simulation.h"
#include "support.h"
#include "tests/support/history.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

using namespace ddfem;
using namespace ddfem::validation;
using namespace ddfem::coupling;

namespace
{
using test::Columns;
using test::read_history;

/// The pillar of examples/pillar_compression on a coarser mesh, loaded until just after the first complete slip event.
InputDeck pillar()
{
  InputDeck deck;
  deck.read(DDFEM_SOURCE_DIR "/examples/pillar_compression/input.prm");
  for (const char *s : {"Domain/Subdivisions=4 4 8", "Time stepping/Final strain=1.27e-3", "Output/Frame interval=0"})
    deck.set_from_command_line(s);
  return deck;
}

/// Whether the source operates in an unbounded body under the uniaxial stress @p sigma (MPa) along z.
bool operates(const InputDeck &pillar_deck, const double sigma)
{
  InputDeck deck = pillar_deck;
  for (const std::string &s :
       {std::string("Mode=infinite"), std::string("Loading/Type=stress"),
        "Loading/Stress=0 0 " + std::to_string(sigma * 1e6) + " 0 0 0", std::string("Time stepping/Final time=5e-8"),
        std::string("Time stepping/Final strain=0"), std::string("Time stepping/Equilibrium speed=0.5"),
        std::string("Time stepping/Final plastic strain=1e-4")})
    deck.set_from_command_line(s);
  Simulation simulation(interpret(deck), MPI_COMM_SELF);
  RunOutput silent("", false);
  simulation.run(silent);
  return to_matrix(simulation.plastic_strain()).norm() >= 1e-4;
}

/// Least-squares fit of u = c + g.x to the nodes on the side faces on one side of the plane, and its value at @p at.
double extrapolate(const FiniteGrain &grain, const std::vector<Vec3> &nodes, const std::vector<Vec3> &u, const Vec3 &n,
                   const Vec3 &at, const double side, const Vec3 &direction)
{
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  Eigen::Vector4d f = Eigen::Vector4d::Zero();
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    const double distance = side * n.dot(nodes[k] - at);
    const bool on_side = std::abs(grain.shape().outward_normal(nodes[k])[2]) < 0.5;
    if (distance < 0.1 * grain.height() || !on_side)
      continue;
    const Vec3 r = nodes[k] - at;
    const Eigen::Vector4d row(1, r[0], r[1], r[2]);
    a += row * row.transpose();
    f += row * u[k].dot(direction);
  }
  return a.ldlt().solve(f)[0];
}

void check_history(Report &report, const Columns &h, const FiniteGrain &grain)
{
  const auto &strain = h.at("strain [-]"), &stress = h.at("stress [Pa]"), &plastic = h.at("axial plastic strain [-]");
  report.below("stress before the first step / largest stress", stress[0] / stress.back(), 1e-9);
  std::size_t k = 0;
  while (std::abs(strain[k]) < 2e-5)
    ++k;
  report.below("initial slope / modulus of the mesh - 1", stress[k] / strain[k] / (grain.unit_load_modulus() * 1e6) - 1,
               0.01);
  const double elastic = stress.back() / (grain.unit_load_modulus() * 1e6);
  report.below("plastic strain / (total - elastic strain) - 1", plastic.back() / (strain.back() - elastic) - 1, 0.02);
  double force = 0, moment = 0, platens = 0;
  for (std::size_t i = 0; i < strain.size(); ++i)
  {
    force = std::max(force, h.at("force imbalance [-]")[i]);
    moment = std::max(moment, h.at("moment imbalance [-]")[i]);
    platens = std::max(platens, std::abs(h.at("reaction platen [N]")[i] - h.at("reaction fixed face [N]")[i]));
  }
  report.below("largest net force of the infinite tractions / sum of magnitudes", force, 1e-6);
  report.below("largest net moment", moment, 1e-6);
  report.below("largest difference of the two reactions / last reaction", platens / h.at("reaction platen [N]").back(),
               1e-4);
}

void check_slip_step(Report &report, const Simulation &simulation, const FrankReadSource &source, const Vec3 &n)
{
  const FiniteGrain &grain = *simulation.grain();
  const auto nodes = grain.boundary_nodes(), u = grain.boundary_displacement();
  const Vec3 e = source.burgers.normalized();
  const double jump =
      extrapolate(grain, nodes, u, n, source.centre, 1, e) - extrapolate(grain, nodes, u, n, source.centre, -1, e);
  // One line that sweeps the whole section of the plane: strain_zz V = b_z n_z (section / |n_z|).
  const double one_slip = std::abs(source.burgers[2] * n[2]) / std::abs(n[2]) * grain.section() / grain.volume();
  const double slips = std::round(std::abs(simulation.plastic_strain()[2]) / one_slip);
  char text[120];
  std::snprintf(text, sizeof text, "slip step on the surface: %.5f nm after %.0f slip(s) of b = %.5f nm", jump, slips,
                source.burgers.norm());
  report.note(text);
  report.below("slip step / (number of slips x b) - 1", std::abs(jump) / (slips * source.burgers.norm()) - 1, 0.05);
}
} // namespace

int main(int argc, char **argv)
{
  return run(argc, argv,
             [](Report &report)
             {
               const std::string directory =
                   (std::filesystem::temp_directory_path() / ("ddfem_pillar_" + std::to_string(getpid()))).string();
               const InputDeck deck = pillar();
               const Parameters p = interpret(deck);
               Simulation simulation(p, MPI_COMM_WORLD);
               {
                 RunOutput output(directory, true);
                 simulation.run(output);
               }
               const Columns h = read_history(directory + "/history.csv");
               std::filesystem::remove_all(directory);
               check_history(report, h, *simulation.grain());
               check_slip_step(report, simulation, p.sources[0], p.orientation.unit_vector(p.sources[0].plane));

               double yield = 0; // the first maximum of the stress is the largest: the source has not moved before
               for (const double s : h.at("stress [Pa]"))
                 yield = std::min(yield, s * 1e-6);
               report.note("yield stress " + std::to_string(yield) + " MPa");
               report.below("source operates in an unbounded body at 0.85 of the yield stress (0 no, 1 yes)",
                            operates(deck, 0.85 * yield), 0.5);
               report.below("source does not operate at 1.15 of the yield stress (0 no, 1 yes)",
                            !operates(deck, 1.15 * yield), 0.5);
             });
}
