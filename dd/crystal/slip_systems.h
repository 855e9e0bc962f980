// Slip systems of a crystal, rotated into the sample frame.
#pragma once

#include "dd/crystal/lattice.h"
#include "dd/crystal/orientation.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace ddfem
{
/// A set of parallel glide planes.
struct SlipPlane
{
  Miller miller{};            ///< crystal frame
  char schmid_boas = 0;       ///< A, B, C or D for fcc {111}; 0 where there is no such letter
  Vec3 normal = Vec3::Zero(); ///< unit, sample frame
};

/// A glide plane and a Burgers vector in it.
struct SlipSystem
{
  std::size_t plane = 0;       ///< index into SlipSystems::planes()
  Miller plane_miller{};       ///< crystal frame
  Miller direction{};          ///< Miller direction of the Burgers vector, crystal frame
  std::string name;            ///< such as "(1-11)[110]"
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

/// The slip systems of a lattice in a given orientation.
///
/// fcc: 12 x {111}<110>, ordered A2 A3 A6 B2 B4 B5 C1 C3 C5 D1 D4 D6 in the notation of Schmid & Boas
/// (Kristallplastizitaet, 1935; as in Franciosi, Berveiller & Zaoui, Acta Metall. 28 (1980) 273): planes A = (-111),
/// B = (111), C = (-1-11), D = (1-11); directions 1 = [011], 2 = [0-11], 3 = [101], 4 = [-101], 5 = [-110], 6 = [110].
/// |b| = a/sqrt(2).
/// bcc: 12 x {110}<111>, then 12 x {112}<111>. |b| = a sqrt(3)/2.
class SlipSystems
{
public:
  /// @p lattice_parameter in nm. Throws std::invalid_argument if it is not positive, or for hcp, whose systems are not
  /// tabulated yet.
  SlipSystems(Lattice lattice, double lattice_parameter, const Orientation &orientation = {});

  std::size_t size() const { return systems_.size(); }
  const SlipSystem &operator[](std::size_t s) const { return systems_[s]; }
  std::vector<SlipSystem>::const_iterator begin() const { return systems_.begin(); }
  std::vector<SlipSystem>::const_iterator end() const { return systems_.end(); }
  const std::vector<SlipPlane> &planes() const { return planes_; }
  /// Length of the Burgers vectors, nm.
  double burgers_magnitude() const { return burgers_magnitude_; }
  const Orientation &orientation() const { return orientation_; }

  /// The system with this Burgers vector (nm, sample frame, either sense; to 1e-4 of its length) and plane.
  std::optional<SlipSystemMatch> find(const Vec3 &burgers, const Miller &plane) const;
  /// As above; the plane by its unit normal (sample frame, either sense, to 1e-4 rad).
  std::optional<SlipSystemMatch> find(const Vec3 &burgers, const Vec3 &normal) const;
  /// Index of the system with this name or Schmid-Boas label.
  std::optional<std::size_t> find(const std::string &name) const;
  /// Indices into planes() of those on which a line with this Burgers vector can glide: two for an fcc <110>. Empty
  /// for a Burgers vector that is none of this lattice (sessile).
  std::vector<std::size_t> glissile_planes(const Vec3 &burgers) const;
  /// Largest |Schmid factor| over all systems for uniaxial load along @p axis (sample frame).
  double largest_schmid_factor(const Vec3 &axis) const;

private:
  void add(std::size_t plane, const Miller &direction, const std::string &schmid_boas);
  void add_fcc();
  void add_bcc();
  template <class IsPlane> std::optional<SlipSystemMatch> find_if(const Vec3 &burgers, IsPlane &&is_plane) const;

  Orientation orientation_;
  double burgers_magnitude_ = 0;
  std::vector<SlipPlane> planes_;
  std::vector<SlipSystem> systems_;
};
} // namespace ddfem
