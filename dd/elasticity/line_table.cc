#include "dd/elasticity/line_table.h"

namespace ddfem
{
void LineTable::add_segment(const Vec3 &x1, const Vec3 &x2, const Vec3 &b)
{
  const double norm = (x2 - x1).norm();
  add(x1, x2, norm > 0.0 ? Vec3((x2 - x1) / norm) : Vec3(Vec3::Zero()), b, norm);
}

void LineTable::add_ray(const Vec3 &origin, const Vec3 &t, const Vec3 &b)
{
  add(origin, Vec3::Zero(), t, b, 0.0);
}

void LineTable::add_moved(const LineTable &table, const std::size_t i, const Vec3 &shift)
{
  const std::size_t lane = n_lines % block_size;
  if (lane == 0)
    blocks.emplace_back();
  const double *const from = table.line(i);
  double *const to = &blocks.back().value[0][lane];
  for (std::size_t row = 0; row < n_rows; ++row)
    to[row * block_size] = from[row * block_size] + (row < direction ? shift[static_cast<Eigen::Index>(row % 3)] : 0.0);
  ++n_lines;
}

void LineTable::add(const Vec3 &x1, const Vec3 &x2, const Vec3 &t, const Vec3 &b, const double norm)
{
  const std::size_t lane = n_lines % block_size;
  if (lane == 0)
    blocks.emplace_back();
  auto &value = blocks.back().value;
  const auto set = [&](const Row row, const Vec3 &v)
  {
    for (std::size_t c = 0; c < 3; ++c)
      value[row + c][lane] = v[static_cast<Eigen::Index>(c)];
  };
  set(first_end, x1);
  set(second_end, x2);
  set(direction, t);
  set(burgers, b);
  set(edge, b.cross(t));
  value[length][lane] = norm;
  ++n_lines;
}
} // namespace ddfem
