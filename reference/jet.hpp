#pragma once

#include <Eigen/Core>
#include <cmath>

namespace pliant::reference {

/// Forward automatic differentiation of second order: a value with its gradient and Hessian by N variables. Energies
/// are written once; with Jets they give residual and tangent. Comparisons use values, so the active branch is
/// differentiated.
template <int N>
struct Jet {
  using Gradient = Eigen::Matrix<double, N, 1>;
  using Hessian = Eigen::Matrix<double, N, N>;

  double value = 0;
  Gradient gradient = Gradient::Zero();
  Hessian hessian = Hessian::Zero();

  Jet() = default;
  Jet(double constant) : value(constant) {}  // NOLINT(google-explicit-constructor): constants mix with Jets in formulas
  /// The variable of this number.
  Jet(double at, int variable) : value(at) { gradient[variable] = 1; }

  /// f(x) of this x, from f and its first two derivatives there.
  Jet chained(double f, double df, double ddf) const {
    Jet result(f);
    result.gradient = df * gradient;
    result.hessian = df * hessian + ddf * gradient * gradient.transpose();
    return result;
  }

  Jet operator-() const { return chained(-value, -1, 0); }
  Jet& operator+=(const Jet& other) { return *this = *this + other; }
  Jet& operator-=(const Jet& other) { return *this = *this - other; }
  Jet& operator*=(const Jet& other) { return *this = *this * other; }

  friend Jet operator+(const Jet& a, const Jet& b) {
    Jet result(a.value + b.value);
    result.gradient = a.gradient + b.gradient;
    result.hessian = a.hessian + b.hessian;
    return result;
  }
  friend Jet operator-(const Jet& a, const Jet& b) { return a + -b; }
  friend Jet operator*(const Jet& a, const Jet& b) {
    Jet result(a.value * b.value);
    result.gradient = a.value * b.gradient + b.value * a.gradient;
    const Hessian mixed = a.gradient * b.gradient.transpose();
    result.hessian = a.value * b.hessian + b.value * a.hessian + mixed + mixed.transpose();
    return result;
  }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const double r = 1 / b.value;
    return a * b.chained(r, -r * r, 2 * r * r * r);
  }
  friend bool operator<(const Jet& a, const Jet& b) { return a.value < b.value; }
  friend bool operator>(const Jet& a, const Jet& b) { return a.value > b.value; }
};

template <int N>
Jet<N> sqrt(const Jet<N>& x) {
  const double root = std::sqrt(x.value);
  return x.chained(root, 0.5 / root, -0.25 / (root * x.value));
}

template <int N>
Jet<N> log(const Jet<N>& x) {
  return x.chained(std::log(x.value), 1 / x.value, -1 / (x.value * x.value));
}

template <int N>
Jet<N> pow(const Jet<N>& x, double p) {
  const double f = std::pow(x.value, p);
  return x.chained(f, p * f / x.value, p * (p - 1) * f / (x.value * x.value));
}

template <int N>
Jet<N> sin(const Jet<N>& x) {
  return x.chained(std::sin(x.value), std::cos(x.value), -std::sin(x.value));
}

template <int N>
Jet<N> cos(const Jet<N>& x) {
  return x.chained(std::cos(x.value), -std::sin(x.value), -std::cos(x.value));
}

/// atan of a tangent: the angle of directions less than a right angle apart.
template <int N>
Jet<N> atan(const Jet<N>& x) {
  const double r = 1 / (1 + x.value * x.value);
  return x.chained(std::atan(x.value), r, -2 * x.value * r * r);
}

}  // namespace pliant::reference
