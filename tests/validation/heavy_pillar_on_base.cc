// Force and stress in a pillar on its base do not depend on how lines that end at its surface are continued outside: within 0.1 % and
// 1 % on a mesh that resolves the distance of the continuations from the surface. --study: on coarser meshes too.
#include "pillar_on_base.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
constexpr PillarMesh production{12, 8, 15};

void check(Report &report, const Move &m)
{
  const Outcome normal = solve(m, Closure::normal, production, 2);
  check_balance(report, m.name, normal);
  for (const auto &[closure, name] : {std::pair(Closure::radial, "radially"), std::pair(Closure::tilted, "tilted")})
  {
    const Outcome other = solve(m, closure, production, 2);
    check_balance(report, m.name + ", continued " + name, other);
    const Difference d = difference(other, normal);
    report.below(m.name + ", continued " + name + " instead of along the normal: force", d.force, 1e-3);
    report.below(m.name + ", continued " + name + ": total stress", d.stress, 0.01);
  }
}

void print_table(const Report &report)
{
  for (const unsigned degree : {1U, 2U})
    for (const PillarMesh &cells : {PillarMesh{4, 2, 5}, PillarMesh{8, 4, 10}, PillarMesh{12, 6, 15}, production})
      for (const Move &m : moves())
      {
        const Outcome normal = solve(m, Closure::normal, cells, degree);
        const Difference radial = difference(solve(m, Closure::radial, cells, degree), normal),
                         tilted = difference(solve(m, Closure::tilted, cells, degree), normal);
        char row[240];
        std::snprintf(row, sizeof row,
                      "degree %u, %2u x %u x %2u cells, %-34s force %12.5e; radial: force %8.4f %%, stress %8.4f %%; "
                      "tilted: force %8.4f %%, stress %8.4f %%",
                      degree, cells[0], cells[1], cells[2], (m.name + ":").c_str(), normal.solution.platen_reaction,
                      100 * radial.force, 100 * radial.stress, 100 * tilted.force, 100 * tilted.stress);
        report.note(row);
      }
}
} // namespace

int main(int argc, char **argv)
{
  const bool study = study_requested(argc, argv);
  return run(argc, argv,
             [&](Report &report)
             {
               if (study)
                 return print_table(report);
               for (const Move &m : moves())
                 check(report, m);
             });
}
