#include "dd/integrators/far_forces.h"

namespace ddfem
{
std::vector<SegmentForces> FarForces::per_line(const Network &network, const NearForces &near,
                                               const std::vector<SegmentForces> &all)
{
  std::vector<SegmentForces> g(all.size());
  const std::span<const SegmentIndex> segments = network.segments();
#pragma omp parallel
  {
    LineTable scratch;
#pragma omp for schedule(static)
    for (std::size_t k = 0; k < segments.size(); ++k)
    {
      const SegmentIndex s = segments[k];
      const SegmentForces f = near.on(network, s, scratch);
      const Vec3 t = network.direction(s);
      g[s.value] = {t.cross(all[s.value].start - f.start) / t.squaredNorm(),
                    t.cross(all[s.value].end - f.end) / t.squaredNorm()};
    }
  }
  return g;
}

void FarForces::set_start(const Network &network, const NearForces &near, const std::vector<SegmentForces> &all)
{
  start = per_line(network, near, all);
  end.clear();
}

void FarForces::set_end(const Network &network, const NearForces &near, const std::vector<SegmentForces> &all)
{
  end = per_line(network, near, all);
}

FarForces FarForces::without_end() const
{
  FarForces constant = *this;
  constant.end.clear();
  return constant;
}

SegmentForces FarForces::on(const Network &network, const SegmentIndex s, const double time) const
{
  SegmentForces g = start[s.value];
  if (!end.empty())
  {
    g.start += time * (end[s.value].start - g.start);
    g.end += time * (end[s.value].end - g.end);
  }
  const Vec3 t = network.direction(s);
  return {g.start.cross(t), g.end.cross(t)};
}
} // namespace ddfem
