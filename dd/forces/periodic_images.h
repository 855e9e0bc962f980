// Stress of the far periodic images of a dislocation network in an orthorhombic cell.
#pragma once

#include "dd/common/types.h"
#include "dd/elasticity/isotropic.h"
#include "dd/forces/periodic_kernel.h"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace ddfem
{
/// A straight directed piece of dislocation line (sense start -> end, FS/RH), positions and Burgers vector in nm.
/// In a periodic cell both ends are shifted together so that the mid-point lies in the primary cell.
struct LineElement
{
  Vec3 start, end, burgers;
};

/**
 * Periodic stress of a network at x = sum over the 27 near_shifts() of the closed-form stress of every element
 * (the caller's part) + far_stress(x), in the convention that the stress of the cell has zero mean: k = 0 is dropped
 * (Cai, Bulatov, Chang, Li, Yip, Phil. Mag. 83 (2003) 539); an applied stress is added separately. If the cell is not
 * neutral, sum_segments b (x) (end - start) != 0, dropping k = 0 amounts to a uniform density of dislocations that
 * compensates the excess; the result is then periodic and has zero mean, but is not in equilibrium with the lines alone.
 *
 * Method: the far field of an element b dx' is the third derivatives of PeriodicKernel contracted with
 * A_mk = b_m dx'_k (Cai, Arsenlis, Weinberger, Bulatov, JMPS 54 (2006) 561, with core radius 0: the images are at
 * least about a cell away, the error is of relative order (a/L)^2). The kernel is smooth, hence interpolated in
 * Chebyshev nodes on both sides (Fong & Darve, J. Comput. Phys. 228 (2009) 8712): sources -> Chebyshev moments -> nodes
 * -> stress at the nodes -> Chebyshev coefficients -> points. The number of nodes on the longer axes is raised so that
 * an elongated cell is as accurate as a cube. All sums run in an order that does not depend on the number of threads.
 */
class PeriodicImages
{
public:
  /// @param origin  corner of the primary cell with the smallest coordinates, nm.
  /// @param lengths edge lengths, nm.
  /// @param order   number of Chebyshev nodes on the shortest axis, 2 to 32. Rms error (largest error) relative to the
  ///                rms of the far stress in a cube with the default margin: 4e-3 (2e-2) at order 5, 3e-4 (2e-3) at
  ///                7, 2e-5 (1e-4) at 9.
  /// @param margin  fraction of an edge by which line ends and points may lie outside the cell at full accuracy, 0 to
  ///                0.4; further out the accuracy fades. Order 7 has 9e-5 with margin 0 and 9e-4 with margin 0.2.
  /// @throws std::invalid_argument if an argument is outside its range.
  PeriodicImages(const Vec3 &origin, const Vec3 &lengths, unsigned order = 7, double margin = 0.1);

  /// Translations (nm) of the elements that the caller sums in closed form; the zero shift first.
  const std::vector<Vec3> &near_shifts() const { return shifts; }

  /// Replaces the sources by @p elements, whose mid-points must have been wrapped into the primary cell. Besides the
  /// elements this costs the square of the number of nodes, which grows with the aspect ratio of the cell: a
  /// millisecond for a cube at order 7, a tenth of a second for edges 1 : 2 : 4.
  void set_sources(const IsotropicMedium &medium, std::span<const LineElement> elements);

  /// Chebyshev coefficients of the far stress, MPa; linear in A_mk. They stand for the sources until the next set_sources().
  using Coefficients = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  const Coefficients &far_field() const { return coefficients; }
  void set_far_field(Coefficients of_sources) { coefficients = std::move(of_sources); }

  /// Stress (MPa) of all images of the sources except the 27 near ones at a point of the primary cell, nm. Zero before
  /// the first set_sources(). May be called from several threads.
  SymTensor far_stress(const Vec3 &x_wrapped) const;

  /// Largest distance of a line end of the current sources outside the cell, as a fraction of the edge along the same
  /// axis (0: all inside). Above the margin of the constructor, lines are too long for the stated accuracy.
  double source_overhang() const { return overhang; }

private:
  /// Chebyshev nodes and polynomials on one axis of the (extended) cell.
  struct Axis
  {
    double centre, half_width; ///< nm
    unsigned order;
    Eigen::MatrixXd moments_to_nodes; ///< (node p, degree k): weight of node p = sum_k M_pk T_k

    // Nodes i and j differ by sign(i, j) * distances[index(i, j)]; few of the differences are distinct.
    std::vector<double> distances; ///< nm
    std::vector<unsigned> index;
    std::vector<double> sign;

    double node(unsigned p) const;
    void polynomials(double x, double *values) const;
    void tabulate_weights();
    void tabulate_differences();
  };

  /// A_mk (column 3 m + k, nm^2) gathered in the nodes.
  using NodeValues = std::vector<std::array<double, 9>>;

  void tabulate_kernel(const PeriodicKernel &images);
  unsigned n_nodes() const { return axes[0].order * axes[1].order * axes[2].order; }
  void add_point(const Vec3 &x, const Mat3 &strength, Eigen::VectorXd &weights, Eigen::MatrixXd &moments) const;
  void add_element(const LineElement &element, Eigen::VectorXd &weights, Eigen::MatrixXd &moments) const;
  Eigen::MatrixXd source_moments(std::span<const LineElement> elements) const;
  SymTensor node_stress(const IsotropicMedium &medium, const NodeValues &sources, unsigned target) const;
  double overhang_of(std::span<const LineElement> elements) const;

  Vec3 edges; ///< nm
  std::vector<Vec3> shifts;
  std::array<Axis, 3> axes;
  std::vector<ThirdDerivatives> kernel; ///< at the distinct node distances, axis z fastest, 1/nm^2
  Coefficients coefficients;
  double overhang = 0.0;
};
} // namespace ddfem
