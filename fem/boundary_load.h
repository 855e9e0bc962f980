#pragma once

#include "fem/elastic_system.h"
#include "fem/nodal_grid.h"
#include "fem/traction_field.h"

#include <vector>

namespace ddfem::fem
{
/// Integrals over the boundary faces of the locally owned cells.
///
/// The traction of a field varies on the scale of its distance to the nearest singularity, whatever the size of a face.
/// Faces are halved, in each direction on its own, until a Gauss rule of moderate order is enough. For a function that
/// is analytic up to a distance s from an interval of length h the rule with n points errs by about rho^(-2n), rho =
/// 2s/h + sqrt((2s/h)^2 + 1) (Bernstein ellipse; Trefethen, SIAM Review 50 (2008) 67, theorem 4.5).
class BoundaryLoad
{
public:
  /// `centre`: about which moments are taken, nm. `tolerance`: relative error aimed at.
  BoundaryLoad(const NodalGrid &grid, const dealii::Point<3> &centre, double tolerance);

  /// load += -int N . (sigma~ n) dS over the whole boundary. Collective; calls the field's stress() once on each rank.
  TractionSummary add_field(const TractionField &field, NodalVector &load) const;

  /// load += int N . traction dS over the faces with the given id. Collective.
  void add_uniform(dealii::types::boundary_id boundary, const dealii::Tensor<1, 3> &traction, NodalVector &load) const;

private:
  /// Part of a face: a rectangle in the face's unit coordinates, its Gauss points per direction.
  struct Piece
  {
    unsigned face;
    std::array<double, 2> low, size;
    std::array<unsigned, 2> depth, order;
    /// Geometry: ball around the piece, longest edge in each direction, nm.
    dealii::Point<3> centre;
    double radius;
    std::array<double, 2> length;
  };
  struct Sample
  {
    dealii::Point<3> position;
    dealii::Tensor<1, 3> area;      // outward normal times dA, nm^2
    std::array<double, 9> values{}; // shape functions of the face's nodes
  };

  void measure(Piece &piece) const;
  Sample sample(unsigned face, double s, double t) const;
  unsigned required_order(double length, double distance) const;
  std::vector<Piece> divide(const TractionField &field, std::uint64_t &n_unresolved) const;
  /// Moves a piece to `done`, or its parts to `next`; false when it is done only because it may not be divided any
  /// further.
  bool halve(Piece piece, double distance, std::vector<Piece> &next, std::vector<Piece> &done) const;
  void append_points(const Piece &piece, std::vector<Sample> &samples) const;
  void reduce(TractionSummary &summary) const;

  const NodalGrid &grid;
  dealii::Point<3> centre;
  double tolerance;
  std::vector<std::vector<unsigned>> nodes_of_face; // local nodes of each boundary face
};
} // namespace ddfem::fem
