// Crystal lattices.
#pragma once

namespace ddfem
{
enum class Lattice
{
  fcc,
  bcc,
  hcp,
};

inline const char *name_of(Lattice lattice)
{
  switch (lattice)
  {
    case Lattice::fcc: return "fcc";
    case Lattice::bcc: return "bcc";
    case Lattice::hcp: return "hcp";
  }
  return "unknown";
}
} // namespace ddfem
