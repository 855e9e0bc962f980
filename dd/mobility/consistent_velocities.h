// Velocities of all nodes at once.
#pragma once

#include "dd/geometry/grain_shape.h"
#include "dd/mobility/mobility_law.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ddfem
{
/// What the last solution took.
struct VelocityIterations
{
  unsigned newton = 0;    ///< linear systems; one for a linear law
  unsigned gradients = 0; ///< conjugate-gradient iterations in all of them
};

/// The balance of forces on the whole network, in the weak form: the velocity varies linearly along every segment, and
///
///   sum over segments int N_i(s) ( f(v(s)) + beta B xi (xi . v(s)) ) ds = F_i
///
/// for every node i and every direction in which it may move, f the resistance per length of the law, N_i the shape functions of
/// the nodal forces F_i (Durocher, thesis, Bordeaux 2018, eqs. I.12 to I.16). For a linear law this is the sparse system A v = F with
/// the blocks B L [1/3 1/6; 1/6 1/3]. Nonlinear laws take Newton's method with three Gauss points per segment.
///
/// A node moves in the directions that the constraints of its arms leave (and the face, for surface nodes); a discretisation
/// node across the chord of its neighbours only (see directions_of_motion()). The small drag beta B along the lines acts on the other nodes; it makes
/// the system regular where all arms of a node lie along the only line on which it can move.
///
/// Conjugate gradients, preconditioned by the 3x3 blocks of the nodes: a mass matrix of linear elements has then a condition number
/// of a few, whatever the length of the network (Wathen, IMA J. Numer. Anal. 7 (1987) 449). The same bits on any number of threads.
class ConsistentVelocities
{
public:
  /// Residual, relative to the force, both in the norm of the preconditioner.
  static constexpr double tolerance = 1e-9;

  /// The system of the present positions. @p sliding_drag: beta above, positive.
  ConsistentVelocities(const Network &network, const MobilityLaw &mobility_law, const GrainShape *shape,
                       double sliding_drag);

  /// Velocities, nm/ns, by NodeIndex::value. @p force: nodal forces, MPa nm^2. @p start: velocities from which the iteration starts, by
  /// NodeIndex::value; missing ones are zero. Throws std::runtime_error if it does not converge.
  std::vector<Vec3> solve(const std::vector<Vec3> &force, const std::vector<Vec3> &start);

  const VelocityIterations &iterations() const { return count; }

private:
  using Field = std::vector<Vec3>; // by row

  /// Blocks of A: int N_i N_j (df/dv + beta B xi xi) ds for the ends of one segment.
  struct Blocks
  {
    Mat3 start_start, start_end, end_end;
  };
  /// An arm of a node.
  struct Arm
  {
    std::uint32_t segment, neighbour; ///< rows
    bool is_start;                    ///< the node is the start of the segment
  };
  struct Piece
  {
    LineState line;
    double length, along; ///< nm; beta B, MPa ns
    std::uint32_t start, end;
  };

  void number_rows(const GrainShape *shape);
  void set_linear_blocks();
  /// Sets the blocks for the velocities @p v if @p with_blocks, and returns F minus the forces that @p v takes.
  Field residual(const Field &force, const Field &v, bool with_blocks);
  void set_preconditioner();
  Field times_matrix(const Field &x) const;
  Field preconditioned(const Field &x) const;
  /// Solves A x = y until the residual has fallen to @p target in the norm of the preconditioner, squared.
  Field conjugate_gradients(const Field &y, double target);
  Field newton(const Field &force, Field v, double target);

  const Network &network;
  const MobilityLaw &law;
  double sliding;
  std::span<const NodeIndex> nodes;
  std::vector<Mat3> directions, inverse; ///< by row
  std::vector<Piece> pieces;
  std::vector<Blocks> blocks;
  std::vector<std::uint32_t> first_arm; ///< by row
  std::vector<Arm> arms;
  VelocityIterations count;
};
} // namespace ddfem
