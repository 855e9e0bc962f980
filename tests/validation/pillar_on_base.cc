// A tapered pillar on its base with a fillet, which is re-entrant. The tractions of the infinite field have no net force and no net
// moment, the reactions at both ends are the same, and what force and stress depend on how the lines are continued outside is the
// error of the mesh. (heavy_pillar_on_base.cc: on a mesh fine enough for 0.1 % and 1 %.)
#include "pillar_on_base.h"

using namespace ddfem;
using namespace ddfem::validation;

namespace
{
constexpr PillarMesh coarse_mesh{4, 2, 5}, fine_mesh{8, 4, 10};

void check(Report &report, const Move &m, const Closure closure, const std::string &continued)
{
  const Outcome normal = solve(m, Closure::normal, fine_mesh, 2), other = solve(m, closure, fine_mesh, 2);
  check_balance(report, m.name, normal);
  check_balance(report, m.name + continued, other);
  const Difference d = difference(other, normal),
                   before = difference(solve(m, closure, coarse_mesh, 2), solve(m, Closure::normal, coarse_mesh, 2));
  report.below(m.name + continued + " instead of along the normal: force", d.force, 0.01);
  // Half the element size: second order at least.
  report.below(m.name + continued + ": force, of that on a mesh twice as coarse", d.force / before.force, 0.35);
  report.below(m.name + continued + ": total stress, of that on a mesh twice as coarse", d.stress / before.stress,
               0.35);
}
} // namespace

int main(int argc, char **argv)
{
  return run(argc, argv,
             [](Report &report)
             {
               const auto all = moves();
               check(report, all[0], Closure::radial, ", continued radially");
               check(report, all[1], Closure::tilted, ", continued upwards");
               check_balance(report, all[2].name, solve(all[2], Closure::normal, coarse_mesh, 2));
             });
}
