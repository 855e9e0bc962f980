#pragma once

#include "fem/elastic_system.h"
#include "fem/lagrange.h"
#include "fem/nodal_grid.h"
#include "fem/traction_field.h"

#include <array>
#include <map>
#include <vector>

namespace ddfem::fem
{
/// Integrals over the boundary faces of the locally owned cells.
///
/// The traction of a source varies on the scale of its distance to the source, whatever the size of a face. On each face
/// the sources for which a Gauss rule of moderate order is enough are integrated with the order that each of them needs;
/// the rest goes down to the halves of the face (in each direction on its own), and so on. Every source is thus seen by
/// as few points as its distance allows: far lines by a few points of each face, near ones by many points close to them.
///
/// For a function that is analytic up to a distance s from an interval of length h the rule with n points errs by about
/// rho^(-2n), rho = 2s/h + sqrt((2s/h)^2 + 1) (Bernstein ellipse; Trefethen, SIAM Review 50 (2008) 67, theorem 4.5). One
/// point more covers the growth of the shape functions on the ellipse. The error of a source on a piece of face is then
/// at most about `tolerance` times its largest traction there times the area.
///
/// A field of many sources is summed at the points of one rule for all faces (TractionField::n_summed); the sources for which that rule
/// is not enough are taken out of the sum and integrated as above.
class BoundaryLoad
{
public:
  /// `centre`: about which moments are taken, nm. `tolerance`: relative error aimed at.
  BoundaryLoad(const NodalGrid &grid, const dealii::Point<3> &centre, double tolerance);

  /// load += -int N . (sigma~ n) dS over the whole boundary. Collective; threaded over faces, with a result that does not
  /// depend on the number of threads.
  TractionSummary add_field(const TractionField &field, NodalVector &load) const;

  /// load += int N . traction dS over the faces with the given id. Collective.
  void add_uniform(dealii::types::boundary_id boundary, const dealii::Tensor<1, 3> &traction, NodalVector &load) const;

  /// Local nodes of a face of the grid, as face_nodes() orders them.
  const std::vector<unsigned> &nodes(unsigned face) const { return nodes_of_face[face]; }
  /// Products of a face's shape functions, int N_a N_b dS, row by row (nm^2).
  std::vector<double> mass(unsigned face) const;

private:
  /// A piece is halved when it would need more Gauss points than this in a direction. Fewer points on smaller pieces
  /// cost more near a line, more points on larger ones cost more where only a corner of the piece is near it.
  static constexpr unsigned most_points = 12;

  /// Part of a face: a rectangle in the face's unit coordinates.
  struct Piece
  {
    unsigned face;
    std::array<double, 2> low, size;
    std::array<unsigned, 2> depth;
    /// Geometry: ball around the piece, longest edge in each direction, nm.
    dealii::Point<3> centre;
    double radius;
    std::array<double, 2> length;
  };
  using Orders = std::array<unsigned, 2>; // Gauss points in each direction
  struct Sample
  {
    dealii::Point<3> position;
    dealii::Tensor<1, 3> area;      // outward normal times dA, nm^2
    std::array<double, 9> values{}; // shape functions of the face's nodes
  };
  /// What a face contributes.
  struct FaceIntegral
  {
    std::array<dealii::Tensor<1, 3>, 9> nodal; // int N t dA
    dealii::Tensor<1, 3> force, moment;
    std::uint64_t n_points = 0, n_evaluations = 0, n_unresolved = 0;
  };
  /// Buffers of a thread.
  struct Workspace
  {
    std::array<std::vector<unsigned>, (most_points + 1) * (most_points + 1)> groups; // sources by the orders they need
    std::vector<double> lengths;
    std::vector<Sample> samples;
    std::vector<dealii::Point<3>> points;
    std::vector<dealii::SymmetricTensor<2, 3>> stresses;
  };
  static constexpr std::size_t no_points = static_cast<std::size_t>(-1);
  /// Stresses of all sources at the points of the common rule, and who belongs to them, by boundary.
  struct Sum
  {
    unsigned order = 0;                   // Gauss points in each direction; 0: there is none
    double near_ratio = 0.;               // 2s/h below which a source needs another rule
    std::vector<std::size_t> first_point; // of each face; no_points: zero there
    std::vector<dealii::SymmetricTensor<2, 3>> stress;
  };

  Sum sum(const TractionField &field) const;
  /// Points of the common rule.
  std::vector<dealii::Point<3>> common_points(const Sum &sum) const;
  /// The boundaries of this rank, each with its sources and the points of faces that are not empty, which sum.first_point gets.
  std::vector<BoundaryPoints> sort_sources(const TractionField &field, unsigned n_summed, Sum &sum) const;
  /// Adds a face's part of the sum without the sources that need another rule, which are appended to `rest`.
  void integrate_sum(const TractionField &field, unsigned face, const Sum &sum, std::vector<unsigned> &rest,
                     FaceIntegral &result, Workspace &work) const;
  void add_samples(unsigned face, FaceIntegral &result, const Workspace &work) const;
  /// Smallest 2s/h for which `n` points are enough for a relative error.
  static double ratio_for(double error, unsigned n);
  static Piece whole(unsigned face) { return {face, {0., 0.}, {1., 1.}, {0, 0}, {}, 0., {}}; }

  void measure(Piece &piece) const;
  Sample sample(unsigned face, double s, double t) const;
  unsigned required_order(double length, double distance) const;
  FaceIntegral integrate_face(const TractionField &field, unsigned face, const Sum &sum, Workspace &work) const;
  /// Integrates the sources over a piece, or over its parts.
  void descend(const TractionField &field, Piece piece, const std::vector<unsigned> &sources, FaceIntegral &result,
               Workspace &work) const;
  /// Into how many parts each direction of a piece is divided for a source at a distance; 1, 1 at the limit.
  std::array<unsigned, 2> divisions(const Piece &piece, double distance) const;
  void integrate(const TractionField &field, const Piece &piece, const Orders &orders,
                 const std::vector<unsigned> &sources, FaceIntegral &result, Workspace &work) const;
  void append_points(const Piece &piece, const Orders &orders, std::vector<Sample> &samples) const;
  void add_face(unsigned face, const FaceIntegral &integral, TractionSummary &summary, NodalVector &load) const;
  void reduce(TractionSummary &summary) const;

  const NodalGrid &grid;
  dealii::Point<3> centre;
  double tolerance;
  std::array<double, most_points + 1> least_ratio;  // smallest 2s/h for which a number of points is enough
  std::vector<std::vector<unsigned>> nodes_of_face; // local nodes of each boundary face
};
} // namespace ddfem::fem
