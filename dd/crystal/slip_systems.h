// Slip systems of a crystal, rotated into the sample frame.
#pragma once

#include "dd/crystal/burgers_vectors.h"
#include "dd/crystal/lattice.h"
#include "dd/crystal/orientation.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace ddfem
{
/// Slip systems that the symmetry of the crystal maps onto each other: the same resistance, the same mobility.
enum class SlipFamily
{
  fcc_111,       ///< {111}<110>
  bcc_110,       ///< {110}<111>
  bcc_112,       ///< {112}<111>
  bcc_123,       ///< {123}<111>
  bcc_110_100,   ///< {110}<100>, products only
  prismatic,     ///< {10-10}<11-20>
  basal,         ///< {0001}<11-20>
  pyramidal_a,   ///< {10-11}<11-20>, first order
  pyramidal_ca,  ///< {10-11}<11-23>, first order
  pyramidal2_ca, ///< {11-22}<11-23>, second order
};
/// Such as "{111}<110>" or "basal <a>".
const char *name_of(SlipFamily family);

/// A set of parallel glide planes.
struct SlipPlane
{
  Miller miller{};            ///< three indices, on the axes of UnitCell
  char schmid_boas = 0;       ///< A, B, C or D for fcc {111}; 0 where there is no such letter
  Vec3 normal = Vec3::Zero(); ///< unit, sample frame
};

/// A glide plane and a Burgers vector in it.
struct SlipSystem
{
  SlipFamily family = SlipFamily::fcc_111;
  std::size_t plane = 0;       ///< index into SlipSystems::planes()
  Miller plane_miller{};       ///< three indices, on the axes of UnitCell
  Miller direction{};          ///< lattice direction of the Burgers vector, three indices, on the axes of UnitCell
  std::string name;            ///< such as "(1-11)[110]" or "(01-10)[2-1-10]"
  std::string schmid_boas;     ///< such as "D6" (fcc); empty for other lattices
  Vec3 normal = Vec3::Zero();  ///< unit, sample frame
  Vec3 burgers = Vec3::Zero(); ///< nm, sample frame

  /// Symmetric Schmid tensor sym(b x n)/|b|; its double contraction with a stress is the resolved shear stress.
  SymTensor schmid_tensor() const;
  /// Shear stress on the plane along b, in the unit of @p stress (sample frame). Positive: moves the line so that the
  /// material on the side the normal points to slips along +b.
  double resolved_shear_stress(const SymTensor &stress) const;
  /// Signed Schmid factor (n.t)(b.t)/|b| for uniaxial load along @p axis (sample frame, any length).
  double schmid_factor(const Vec3 &axis) const;
};

/// A slip system that holds a given Burgers vector.
struct SlipSystemMatch
{
  std::size_t system = 0;
  int burgers_sign = 1; ///< +1 if b is that of the system, -1 if opposite
};

struct SlipSystemOptions
{
  bool bcc_123_planes = false; ///< add the 24 systems {123}<111> of a bcc crystal
};

/// The slip systems of a lattice in a given orientation.
///
/// fcc: 12 x {111}<110>, ordered A2 A3 A6 B2 B4 B5 C1 C3 C5 D1 D4 D6 in the notation of Schmid & Boas
/// (Kristallplastizitaet, 1935; as in Franciosi, Berveiller & Zaoui, Acta Metall. 28 (1980) 273): planes A = (-111),
/// B = (111), C = (-1-11), D = (1-11); directions 1 = [011], 2 = [0-11], 3 = [101], 4 = [-101], 5 = [-110], 6 = [110].
/// bcc: 12 x {110}<111>, 12 x {112}<111>, on request 24 x {123}<111>.
/// hcp: 3 prismatic <a>, 3 basal <a>, 6 first-order pyramidal <a>, 12 first-order pyramidal <c+a>, 6 second-order
/// pyramidal <c+a> (list of Partridge, Metall. Rev. 12 (1967) 169; Yoo, Metall. Trans. A 12 (1981) 409). The
/// first-order pyramidal planes are common to <a> and <c+a>.
///
/// Products of reactions that glide though they are no slip systems: bcc a<100> on {011}. In molecular dynamics of
/// iron, <100> edge lines on {011} move by nucleating kinks, while on {001} kinks neither form nor migrate easily
/// (Chen, Wang & Yu; core structures in Acta Phys. Sin. 55 (2006) 5980): {001} is not among the glide planes. Sessile:
/// fcc a<100>, bcc a<110>, hcp <c>, and everything longer.
class SlipSystems
{
public:
  /// @p lattice_parameter a in nm; the cell of @p orientation must be that of the lattice (it gives c/a).
  /// Throws std::invalid_argument if a is not positive, the cell is of the other kind, or {123} planes are asked for in
  /// another lattice than bcc.
  SlipSystems(Lattice lattice, double lattice_parameter, const Orientation &orientation = {},
              const SlipSystemOptions &options = {});

  std::size_t size() const { return systems_.size(); }
  const SlipSystem &operator[](std::size_t s) const { return systems_[s]; }
  std::vector<SlipSystem>::const_iterator begin() const { return systems_.begin(); }
  std::vector<SlipSystem>::const_iterator end() const { return systems_.end(); }
  /// Systems on which products of reactions glide; not counted among the slip systems above.
  const std::vector<SlipSystem> &product_systems() const { return product_systems_; }
  /// In the order of the families above; product_plane() prefers the first.
  const std::vector<SlipPlane> &planes() const { return planes_; }
  Lattice lattice() const { return lattice_; }
  double lattice_parameter() const { return lattice_parameter_; }
  /// Length of the Burgers vector of the principal slip, nm (hcp: <a>).
  double burgers_magnitude() const { return burgers_magnitude_; }
  const Orientation &orientation() const { return orientation_; }

  /// The system with this Burgers vector (nm, sample frame, either sense; to 1e-4 of the principal one) and plane.
  std::optional<SlipSystemMatch> find(const Vec3 &burgers, const Miller &plane) const;
  /// As above; the plane by its unit normal (sample frame, either sense, to 1e-4 rad).
  std::optional<SlipSystemMatch> find(const Vec3 &burgers, const Vec3 &normal) const;
  /// Index of the system with this name or Schmid-Boas label.
  std::optional<std::size_t> find(const std::string &name) const;
  /// Indices into planes() of those on which a line with this Burgers vector can glide, ascending: two for an fcc
  /// a/2<110>, four for an hcp <a>, two for a bcc a<100>. Empty for a Burgers vector that is none of this lattice, or
  /// sessile.
  std::vector<std::size_t> glissile_planes(const Vec3 &burgers) const;
  /// The family of a line with this Burgers vector on this plane (index into planes()), products included; empty if it
  /// does not glide there.
  std::optional<SlipFamily> family(const Vec3 &burgers, std::size_t plane) const;
  /// Type of a Burgers vector (nm, sample frame); see ddfem::burgers_type.
  std::optional<BurgersType> burgers_type(const Vec3 &burgers) const;
  /// The types of Burgers vectors that glide, in words: "a/2<111>, a<100>".
  std::string glissile_types() const;
  /// Largest |Schmid factor| over all systems for uniaxial load along @p axis (sample frame).
  double largest_schmid_factor(const Vec3 &axis) const;

private:
  std::size_t add_plane(const Miller &plane, char schmid_boas = 0);
  SlipSystem make(SlipFamily family, std::size_t plane, const Miller &direction, const std::string &schmid_boas) const;
  void add_fcc();
  void add_bcc(const SlipSystemOptions &options);
  void add_hcp();
  template <class IsPlane>
  std::optional<SlipSystemMatch> find_if(const std::vector<SlipSystem> &systems, const Vec3 &burgers,
                                         IsPlane &&is_plane) const;

  Lattice lattice_;
  double lattice_parameter_;
  Orientation orientation_;
  double burgers_magnitude_;
  std::vector<SlipPlane> planes_;
  std::vector<SlipSystem> systems_;
  std::vector<SlipSystem> product_systems_;
};
} // namespace ddfem
