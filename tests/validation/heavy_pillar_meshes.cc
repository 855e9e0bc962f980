// The pillars of pillar_meshes.cc loaded until several loops have left, on more meshes, with and without images of the lines: stress-strain
// curves against those of the finest mesh; what a distorted mesh changes is less than the error of the regular one, and that falls with
// the element size. Prints the curves for docs/figures/pillar_meshes.py. With the argument square or round that shape only.
#include "pillar_meshes.h"

#include <map>

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
  bool images = true;
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

/// Histories on meshes by the names of these.
using Histories = std::map<std::string, Columns>;

Histories run_all(Report &report, const std::string &kind, const Section section,
                  const std::vector<MeshOfPillar> &meshes)
{
  Histories histories;
  for (const MeshOfPillar &m : meshes)
  {
    const Columns h =
        run_pillar(section, m.cells, m.degree, m.distorted, "strain rate -2e6 until plastic strain -3e-4", m.images);
    check_balances(report, kind + ", " + m.name, h);
    print_curve(report, kind + ", " + m.name, h);
    histories.emplace(m.name, h);
  }
  return histories;
}

/// The error of a mesh is its difference from the finest one, which has images.
void check_square(Report &report)
{
  const Histories h = run_all(report, "square", Section::square,
                              {{"4 x 4 x 8", {4, 8}, 2, false},
                               {"4 x 4 x 8, distorted", {4, 8}, 2, true},
                               {"8 x 8 x 16, distorted", {8, 16}, 2, true},
                               {"4 x 4 x 8, no images", {4, 8}, 2, false, false},
                               {"8 x 8 x 16, no images", {8, 16}, 2, false, false},
                               {"4 x 4 x 8, distorted, no images", {4, 8}, 2, true, false},
                               {"8 x 8 x 16, distorted, no images", {8, 16}, 2, true, false},
                               {"8 x 8 x 16, linear", {8, 16}, 1, false},
                               {"8 x 8 x 16", {8, 16}, 2, false}});
  const auto difference = [&](const std::string &a, const std::string &b)
  { return difference_of_curves(h.at(a), h.at(b)); };
  const auto error = [&](const std::string &name) { return difference(name, "8 x 8 x 16"); };
  const auto below = [&](const std::string &what, const double value, const double limit)
  { report.below("square, " + what, value, limit); };

  // With images the fields are smooth over an element: the elements are of second order at least, and what is left is near 1e-4.
  for (const std::string name : {"4 x 4 x 8", "4 x 4 x 8, distorted", "8 x 8 x 16, distorted", "8 x 8 x 16, linear"})
    below(name + ": stress against the finest mesh", error(name), 1e-3);
  below("4 x 4 x 8, distorted against regular / error of the regular mesh",
        difference("4 x 4 x 8, distorted", "4 x 4 x 8") / error("4 x 4 x 8"), 1);

  // Without them the lines within an element of the surface feel the wrong force. The layer is as thin as the elements are small: first
  // order. Moving the vertices adds little to it.
  for (const std::string distorted : {"", ", distorted"})
  {
    const std::string coarse = "4 x 4 x 8" + distorted + ", no images", fine = "8 x 8 x 16" + distorted + ", no images";
    below(coarse + ": stress against the finest mesh", error(coarse), 0.01);
    below("no images" + distorted + ": error of half the element size / error", error(fine) / error(coarse), 0.75);
  }
  for (const std::string cells : {"4 x 4 x 8", "8 x 8 x 16"})
    below(cells + ", no images, distorted against regular / error of the regular mesh",
          difference(cells + ", distorted, no images", cells + ", no images") / error(cells + ", no images"), 0.2);
}

/// No images at a round side, and no run on linear elements: they do not reach the surface to which lines slide.
void check_round(Report &report)
{
  const std::string finest = "8 across, 12 along";
  const Histories h = run_all(report, "round", Section::circle,
                              {{"6 across, 8 along", {6, 8}, 2, false},
                               {"6 across, 8 along, distorted", {6, 8}, 2, true},
                               {finest, {8, 12}, 2, false}});
  for (const auto &[name, history] : h)
    if (name != finest)
      report.below("round, " + name + ": stress against the finest mesh", difference_of_curves(history, h.at(finest)),
                   0.01);
}
} // namespace

int main(int argc, char **argv)
{
  const std::string only = argc > 1 ? argv[1] : "";
  return run(argc, argv,
             [&](Report &report)
             {
               if (only != "round")
                 check_square(report);
               if (only != "square")
                 check_round(report);
             });
}
