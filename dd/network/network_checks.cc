// Invariants and checksum of the network.
#include "dd/network/network.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <stdexcept>

namespace ddfem
{
namespace
{
std::string text_of(const Vec3 &v)
{
  char text[96];
  std::snprintf(text, sizeof(text), "(%.9g, %.9g, %.9g) nm", v[0], v[1], v[2]);
  return text;
}

std::string text_of(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g nm", value);
  return text;
}

/// Accumulates 64-bit words; the finaliser is that of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014).
class Hash
{
public:
  Hash &add(std::uint64_t word)
  {
    state_ += word + 0x9e3779b97f4a7c15U;
    state_ = (state_ ^ (state_ >> 30)) * 0xbf58476d1ce4e5b9U;
    state_ = (state_ ^ (state_ >> 27)) * 0x94d049bb133111ebU;
    state_ ^= state_ >> 31;
    return *this;
  }
  Hash &add(double value) { return add(std::bit_cast<std::uint64_t>(value)); }
  Hash &add(const Vec3 &v) { return add(v[0]).add(v[1]).add(v[2]); }
  std::uint64_t value() const { return state_; }

private:
  std::uint64_t state_ = 0;
};
/// Distance of @p x from a plane or, in a periodic cell, from the nearest of its images: lines that have merged across the
/// boundary keep the plane of the image that each came from.
double distance_from_images(const GlidePlane &plane, const Vec3 &x, const Vec3 &period)
{
  const double plain = plane.normal.dot(x) - plane.offset;
  constexpr double hardly_off = 1e-3; // nm: no image is nearer
  if (std::abs(plain) < hardly_off)
    return plain;
  double nearest = plain;
  constexpr int images = 3;
  const auto range = [&](const int axis) { return period[axis] > 0 ? images : 0; };
  for (int i = -range(0); i <= range(0); ++i)
    for (int j = -range(1); j <= range(1); ++j)
      for (int k = -range(2); k <= range(2); ++k)
      {
        const double d = plain + plane.normal.dot(Vec3(i, j, k).cwiseProduct(period));
        if (std::abs(d) < std::abs(nearest))
          nearest = d;
      }
  return nearest;
}
} // namespace

std::string Network::describe(NodeIndex i) const
{
  return std::string(name_of(constraint(i))) + " node " + std::to_string(id(i)) + " at " + text_of(position(i));
}

std::string Network::describe(SegmentIndex s) const
{
  return "segment " + std::to_string(id(s)) + " from " + describe(start(s)) + " to " + describe(end(s));
}

void Network::check_node(NodeIndex i, double tolerance, std::vector<InvariantViolation> &found) const
{
  const auto report = [&](const std::string &what) { found.push_back({describe(i) + ": " + what}); };
  if (!position(i).allFinite())
    report("its position is not finite.");
  const auto arms = connected_segments(i);
  for (const SegmentIndex s : arms)
    if (!contains(s) || (start(s) != i && end(s) != i))
    {
      report("its list of arms names segment index " + std::to_string(s.value) + ", which does not end here.");
      return; // the arms cannot be followed further
    }
  for (std::size_t k = 0; k < arms.size(); ++k)
    for (std::size_t l = k + 1; l < arms.size(); ++l)
      if (other_end(arms[k], i) == other_end(arms[l], i))
        report("segments " + std::to_string(id(arms[k])) + " and " + std::to_string(id(arms[l])) +
               " both join it to node " + std::to_string(id(other_end(arms[k], i))) + ".");
  if (constraint(i) == NodeConstraint::surface && arms.size() != 1)
    report("a surface node must have one arm, this one has " + std::to_string(arms.size()) + ".");
  if (constraint(i) != NodeConstraint::free)
    return;
  if (arms.size() < 2)
    report("a free node must have at least two arms, this one has " + std::to_string(arms.size()) + ".");
  Vec3 sum = Vec3::Zero();
  for (const SegmentIndex s : arms)
    sum += burgers_from(s, i);
  if (!(sum.norm() <= tolerance))
    report("the Burgers vectors that leave it add up to " + text_of(sum) + " instead of zero.");
}

void Network::check_plane(SegmentIndex s, double tolerance, std::vector<InvariantViolation> &found) const
{
  const auto report = [&](const std::string &what) { found.push_back({describe(s) + ": " + what}); };
  const Vec3 n = normal(s);
  if (!(std::abs(burgers(s).dot(n)) <= tolerance))
    report("its Burgers vector " + text_of(burgers(s)) + " leaves the glide plane by " + text_of(burgers(s).dot(n)) +
           ".");
  if (!(std::abs(direction(s).dot(n)) <= 2 * tolerance))
    report("the line leaves the glide plane by " + text_of(direction(s).dot(n)) + " between its ends.");
  const double at_start = distance_from_images(planes_[plane(s)], position(start(s)), period_);
  const double at_end = distance_from_images(planes_[plane(s)], position(start(s)) + direction(s), period_);
  if (!(std::abs(at_start) <= tolerance))
    report("its start is " + text_of(at_start) + " off the glide plane.");
  if (!(std::abs(at_end) <= tolerance))
    report("its end is " + text_of(at_end) + " off the glide plane.");
}

void Network::check_segment(SegmentIndex s, double tolerance, std::vector<InvariantViolation> &found) const
{
  if (!contains(start(s)) || !contains(end(s)))
  {
    found.push_back({"segment " + std::to_string(id(s)) + ": an end node does not exist."});
    return;
  }
  const auto report = [&](const std::string &what) { found.push_back({describe(s) + ": " + what}); };
  for (const NodeIndex i : {start(s), end(s)})
    if (std::ranges::count(connected_segments(i), s) != 1)
      report("it is not listed once among the arms of node " + std::to_string(id(i)) + ".");
  if (!burgers(s).allFinite() || burgers(s).isZero(0))
    report("its Burgers vector is " + text_of(burgers(s)) + ".");
  if (!(length(s) > tolerance))
    report("its length is " + text_of(length(s)) + ".");
  if (plane(s).is_valid())
    check_plane(s, tolerance, found);
}

std::vector<InvariantViolation> Network::violations(double tolerance) const
{
  std::vector<InvariantViolation> found;
  for (const NodeIndex i : nodes())
    check_node(i, tolerance, found);
  for (const SegmentIndex s : segments())
    check_segment(s, tolerance, found);
  return found;
}

void Network::check_invariants(double tolerance) const
{
  const auto found = violations(tolerance);
  if (found.empty())
    return;
  constexpr std::size_t shown = 5;
  std::string message = "The dislocation network is inconsistent (" + std::to_string(found.size()) + " violations):";
  for (std::size_t k = 0; k < std::min(shown, found.size()); ++k)
    message += "\n  " + found[k].message;
  if (found.size() > shown)
    message += "\n  ...";
  throw std::runtime_error(message);
}

std::uint64_t Network::checksum() const
{
  // A sum over objects does not depend on their order.
  std::uint64_t sum = Hash().add(period_).value();
  for (const NodeIndex i : nodes())
    sum += Hash().add(id(i)).add(position(i)).add(static_cast<std::uint64_t>(constraint(i))).value();
  for (const SegmentIndex s : segments())
  {
    Hash hash;
    hash.add(id(s)).add(id(start(s))).add(id(end(s))).add(burgers(s)).add(normal(s));
    hash.add(plane(s).is_valid() ? planes_[plane(s)].offset : 0.0);
    sum += hash.value();
  }
  return sum;
}
} // namespace ddfem
