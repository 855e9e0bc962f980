#include "dd/mobility/mobility_law.h"

namespace ddfem
{
LineState line_state(const Network &network, const SegmentIndex s)
{
  return {network.direction(s).normalized(), network.burgers(s), network.normal(s)};
}
} // namespace ddfem
