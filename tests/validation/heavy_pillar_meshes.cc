// The pillars of pillar_meshes.cc loaded until several loops have left, on more meshes: stress-strain curves against those of the finest
// mesh. Prints the curves for docs/figures/pillar_meshes.py. With the argument square or round that shape only.
#include "pillar_meshes.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
struct MeshOfPillar
{
  std::string name;
  Cells cells;
  unsigned degree;
  bool distorted;
};

void print_curve(const Report &report, const std::string &name, const Columns &h)
{
  constexpr int n = 300;
  const double end = h.at("strain [-]").back();
  for (int k = 0; k <= n; ++k)
  {
    char row[200];
    std::snprintf(row, sizeof row, "curve %s | %.6e %.6e %.6e", name.c_str(), end * k / n,
                  at_strain(h, "stress [Pa]", end * k / n), at_strain(h, "axial plastic strain [-]", end * k / n));
    report.note(row);
  }
}

void compare(Report &report, const Section section, const std::vector<MeshOfPillar> &meshes)
{
  const std::string kind = section == Section::square ? "square" : "round";
  std::vector<Columns> histories;
  for (const MeshOfPillar &m : meshes)
  {
    histories.push_back(
        run_pillar(section, m.cells, m.degree, m.distorted, "strain rate -2e6 until plastic strain -3e-4"));
    check_balances(report, kind + ", " + m.name, histories.back());
    print_curve(report, kind + ", " + m.name, histories.back());
  }
  // The last is the finest: the error of a mesh is its difference from it. The first is the production mesh.
  const double mesh_error = difference_of_curves(histories[0], histories.back());
  report.below(kind + ", " + meshes[0].name + ": stress against the finest mesh", mesh_error, 0.01);
  for (std::size_t k = 1; k + 1 < meshes.size(); ++k)
    report.below(kind + ", " + meshes[k].name + ": stress against the finest mesh",
                 difference_of_curves(histories[k], histories.back()), 0.01);
}
} // namespace

int main(int argc, char **argv)
{
  const std::string only = argc > 1 ? argv[1] : "";
  return run(argc, argv,
             [&](Report &report)
             {
               if (only != "round")
                 compare(report, Section::square,
                         {{"4 x 4 x 8", {4, 8}, 2, false},
                          {"4 x 4 x 8, distorted", {4, 8}, 2, true},
                          {"8 x 8 x 16, linear", {8, 16}, 1, false},
                          {"8 x 8 x 16", {8, 16}, 2, false}});
               // Linear elements do not reach the round surface to which lines slide: no run on them.
               if (only != "square")
                 compare(report, Section::circle,
                         {{"6 across, 8 along", {6, 8}, 2, false},
                          {"6 across, 8 along, distorted", {6, 8}, 2, true},
                          {"8 across, 12 along", {8, 12}, 2, false}});
             });
}
