// Coefficients of the second-order Runge-Kutta-Chebyshev method.
#pragma once

#include <vector>

namespace ddfem
{
/// The method of s stages of Sommeijer, Shampine & Verwer, J. Comput. Appl. Math. 88 (1998) 315, eqs. 2.2-2.9, for a
/// time-dependent right-hand side f(t, y), in displacements d_j from the start of a step of size h:
///   d_1 = mu~_1 h f_0,   d_j = mu_j d_{j-1} + nu_j d_{j-2} + mu~_j h f_{j-1} + gamma~_j h f_0,   j = 2..s, d_0 = 0,
/// with f_j = f(t + c_j h, y + d_j).
class ChebyshevSteps
{
public:
  struct Coefficients
  {
    double mu, nu, mu_tilde, gamma_tilde;
  };

  /// @p s >= 2.
  explicit ChebyshevSteps(unsigned s);

  unsigned n_stages() const { return static_cast<unsigned>(coefficients.size()) - 1; }
  /// For stage 1..s; of the first only mu_tilde is used.
  const Coefficients &operator[](const unsigned j) const { return coefficients[j]; }
  /// c_j, part of the step at stage 1..s.
  double time(const unsigned j) const { return times[j]; }

  /// Largest |lambda| h for which s stages are stable (eq. 2.8 with the damping of eq. 2.7).
  static double stability_bound(unsigned s);
  /// Fewest stages that are stable for @p product = |lambda| h.
  static unsigned stages_for(double product);
  /// The error estimate of eq. 3.1: 0.8 (y_0 - y_1) + 0.4 h (f_0 + f_1).
  template <class Vector>
  static Vector error(const Vector &displacement, const double h, const Vector &f0, const Vector &f1)
  {
    return -0.8 * displacement + 0.4 * h * (f0 + f1);
  }

private:
  std::vector<Coefficients> coefficients;
  std::vector<double> times;
};
} // namespace ddfem
