// Random edits, compared with a plain model after every few steps.
#include "dd/network/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace
{
using namespace ddfem;

struct ModelSegment
{
  ObjectId start, end;
  Vec3 burgers;
};

class Fuzz
{
public:
  explicit Fuzz(unsigned seed) : random_(seed) {}

  void step()
  {
    switch (pick(10))
    {
      case 0:
      case 1:
      case 2: insert_node(); break;
      case 3:
      case 4:
      case 5: insert_segment(); break;
      case 6: erase_node(); break;
      case 7: erase_segment(); break;
      case 8: move_node(); break;
      default:
        if (pick(20) == 0)
        {
          network_.clean();
          held_.clear();
        }
    }
  }

  void compare() const
  {
    ASSERT_EQ(network_.n_nodes(), nodes_.size());
    ASSERT_EQ(network_.n_segments(), segments_.size());
    ASSERT_EQ(network_.nodes().size(), nodes_.size());
    ASSERT_EQ(network_.segments().size(), segments_.size());
    std::map<ObjectId, std::size_t> degree;
    for (const auto &[id, s] : segments_)
    {
      const auto index = network_.find_segment(id);
      ASSERT_TRUE(index && network_.contains(*index));
      ASSERT_EQ(network_.id(network_.start(*index)), s.start);
      ASSERT_EQ(network_.id(network_.end(*index)), s.end);
      ASSERT_EQ(network_.burgers(*index), s.burgers);
      ++degree[s.start];
      ++degree[s.end];
    }
    for (const auto &[id, x] : nodes_)
    {
      const auto index = network_.find_node(id);
      ASSERT_TRUE(index && network_.contains(*index));
      ASSERT_EQ(network_.position(*index), x);
      ASSERT_EQ(network_.degree(*index), degree[id]);
      for (const SegmentIndex s : network_.connected_segments(*index))
        ASSERT_TRUE(network_.start(s) == *index || network_.end(s) == *index);
    }
    // An index means the same object as when it was handed out, or says that the object is gone.
    for (const auto &[index, id] : held_)
      ASSERT_TRUE(network_.contains(index) ? network_.id(index) == id : !nodes_.contains(id));
    ASSERT_TRUE(std::ranges::is_sorted(network_.nodes()));
  }

private:
  std::size_t pick(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  Vec3 point()
  {
    std::uniform_real_distribution<double> c(-1, 1);
    return {c(random_), c(random_), c(random_)};
  }
  template <class Map> ObjectId any_of(const Map &map)
  {
    return std::next(map.begin(), static_cast<std::ptrdiff_t>(pick(map.size())))->first;
  }

  void insert_node()
  {
    const Vec3 x = point();
    const NodeIndex i = network_.insert(Node{x});
    ASSERT_FALSE(nodes_.contains(network_.id(i)));
    nodes_[network_.id(i)] = x;
    held_[i] = network_.id(i);
  }
  void insert_segment()
  {
    if (nodes_.size() < 2)
      return;
    const ObjectId a = any_of(nodes_), b = any_of(nodes_);
    const NodeIndex i = *network_.find_node(a), j = *network_.find_node(b);
    const bool joined = std::ranges::any_of(segments_,
                                            [&](const auto &entry) {
                                              return (entry.second.start == a && entry.second.end == b) ||
                                                     (entry.second.start == b && entry.second.end == a);
                                            });
    const Vec3 burgers = point();
    if (a == b || joined)
    {
      ASSERT_THROW(network_.insert(Segment{i, j, burgers, {}}), std::invalid_argument);
      return;
    }
    segments_[network_.id(network_.insert(Segment{i, j, burgers, {}}))] = {a, b, burgers};
  }
  void erase_node()
  {
    if (nodes_.empty())
      return;
    const ObjectId id = any_of(nodes_);
    const NodeIndex i = *network_.find_node(id);
    while (network_.degree(i) > 0)
    {
      const SegmentIndex s = network_.connected_segments(i).front();
      segments_.erase(network_.id(s));
      network_.erase(s);
    }
    network_.erase(i);
    nodes_.erase(id);
  }
  void erase_segment()
  {
    if (segments_.empty())
      return;
    const ObjectId id = any_of(segments_);
    network_.erase(*network_.find_segment(id));
    segments_.erase(id);
  }
  void move_node()
  {
    if (nodes_.empty())
      return;
    const ObjectId id = any_of(nodes_);
    nodes_[id] = point();
    network_.set_position(*network_.find_node(id), nodes_[id]);
  }

  std::mt19937 random_;
  Network network_;
  std::map<ObjectId, Vec3> nodes_;
  std::map<ObjectId, ModelSegment> segments_;
  std::map<NodeIndex, ObjectId> held_;
};

TEST(NetworkFuzz, RandomEditsAgreeWithAPlainModel)
{
  for (unsigned seed = 0; seed < 8; ++seed)
  {
    Fuzz fuzz(seed);
    for (int step = 0; step < 1500; ++step)
    {
      fuzz.step();
      if (HasFatalFailure())
        FAIL() << "seed " << seed << ", step " << step;
      if (step % 10 == 0)
        fuzz.compare();
      if (HasFatalFailure())
        FAIL() << "seed " << seed << ", step " << step;
    }
  }
}
} // namespace
