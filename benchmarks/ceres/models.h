// Models as brdffit defines them, each as basis functions of one channel.
//
// f_r = rows[0] + sum over j of linear[j] rows[1 + j]. `shared` holds the nonlinear
// parameters in brdffit's solver coordinates (log alpha). `slopes[k]` is the derivative
// of all rows along shared[k], written out by hand.

#ifndef BENCHMARKS_CERES_MODELS_H_
#define BENCHMARKS_CERES_MODELS_H_

#include <algorithm>
#include <cmath>

constexpr double kPi = 3.14159265358979323846;

struct Directions {
  double xi, yi, zi, xo, yo, zo;
};

inline double Fifth(double x) {
  const double square = x * x;
  return square * square * x;
}

// 1 - F_0 is multiplied with this in Schlick's approximation.
inline double SchlickWeight(double length) {
  return Fifth(std::max(1.0 - 0.5 * length, 0.0));
}

struct Ggx {
  static constexpr int kLinear = 2;
  static constexpr int kShared = 1;

  template <class T>
  static void Rows(const T* shared, const Directions& d, T* rows) {
    using std::exp;
    using std::sqrt;
    const T square = exp(2.0 * shared[0]);
    const double x = d.xi + d.xo, y = d.yi + d.yo, z = d.zi + d.zo;
    const double length2 = x * x + y * y + z * z;
    const double sine2 = (x * x + y * y) / length2;
    const T q = square / (square * (1.0 - sine2) + sine2);
    const T ndf = q * q / (kPi * square);
    const T area_i = 0.5 * (d.zi + sqrt(square * (d.xi * d.xi + d.yi * d.yi) + d.zi * d.zi));
    const T area_o = 0.5 * (d.zo + sqrt(square * (d.xo * d.xo + d.yo * d.yo) + d.zo * d.zo));
    const T lobe = ndf * 0.25 / (area_i * d.zo + area_o * d.zi - d.zi * d.zo);
    const double s = SchlickWeight(std::sqrt(length2));
    rows[0] = lobe * s;
    rows[1] = T(1.0 / kPi);
    rows[2] = lobe * (1.0 - s);
  }

  static void RowsAndSlopes(const double* shared, const Directions& d,
                            double* rows, double slopes[][kLinear + 1]) {
    const double square = std::exp(2.0 * shared[0]);
    const double x = d.xi + d.xo, y = d.yi + d.yo, z = d.zi + d.zo;
    const double length2 = x * x + y * y + z * z;
    const double sine2 = (x * x + y * y) / length2;
    const double scale = 1.0 / (square * (1.0 - sine2) + sine2);
    const double ndf = scale * scale * square / kPi;
    const double t2_i = square * (d.xi * d.xi + d.yi * d.yi);
    const double t2_o = square * (d.xo * d.xo + d.yo * d.yo);
    const double root_i = std::sqrt(t2_i + d.zi * d.zi);
    const double root_o = std::sqrt(t2_o + d.zo * d.zo);
    const double g = 0.5 / (root_i * d.zo + root_o * d.zi);
    const double lobe = ndf * g;
    const double s = SchlickWeight(std::sqrt(length2));
    const double by_alpha =
        lobe * (4.0 * scale * sine2 - 2.0 -
                2.0 * g * (t2_i / root_i * d.zo + t2_o / root_o * d.zi));
    rows[0] = lobe * s;
    rows[1] = 1.0 / kPi;
    rows[2] = lobe * (1.0 - s);
    slopes[0][0] = by_alpha * s;
    slopes[0][1] = 0.0;
    slopes[0][2] = by_alpha * (1.0 - s);
  }
};

struct WardDuer {
  static constexpr int kLinear = 2;
  static constexpr int kShared = 2;

  template <class T>
  static void Rows(const T* shared, const Directions& d, T* rows) {
    using std::exp;
    const double z = d.zi + d.zo;
    const T u = (d.xi + d.xo) / z * exp(-shared[0]);
    const T v = (d.yi + d.yo) / z * exp(-shared[1]);
    rows[0] = T(0.0);
    rows[1] = T(1.0 / kPi);
    rows[2] = exp(-u * u - v * v - shared[0] - shared[1]) / (4.0 * kPi * d.zi * d.zo);
  }

  static void RowsAndSlopes(const double* shared, const Directions& d,
                            double* rows, double slopes[][kLinear + 1]) {
    const double z = d.zi + d.zo;
    const double u = (d.xi + d.xo) / z * std::exp(-shared[0]);
    const double v = (d.yi + d.yo) / z * std::exp(-shared[1]);
    const double lobe = std::exp(-u * u - v * v - shared[0] - shared[1]) /
                        (4.0 * kPi * d.zi * d.zo);
    rows[0] = 0.0;
    rows[1] = 1.0 / kPi;
    rows[2] = lobe;
    slopes[0][0] = slopes[0][1] = slopes[1][0] = slopes[1][1] = 0.0;
    slopes[0][2] = lobe * (2.0 * u * u - 1.0);
    slopes[1][2] = lobe * (2.0 * v * v - 1.0);
  }
};

struct OrenNayar {
  static constexpr int kLinear = 1;
  static constexpr int kShared = 1;

  template <class T>
  static void Rows(const T* shared, const Directions& d, T* rows) {
    const T variance = shared[0] * shared[0];
    const double azimuthal =
        std::max(d.xi * d.xo + d.yi * d.yo, 0.0) / std::max(d.zi, d.zo);
    rows[0] = T(0.0);
    rows[1] = (1.0 - 0.5 * variance / (variance + 0.33) +
               0.45 * variance / (variance + 0.09) * azimuthal) / kPi;
  }

  static void RowsAndSlopes(const double* shared, const Directions& d,
                            double* rows, double slopes[][kLinear + 1]) {
    Rows(shared, d, rows);
    const double variance = shared[0] * shared[0];
    const double azimuthal =
        std::max(d.xi * d.xo + d.yi * d.yo, 0.0) / std::max(d.zi, d.zo);
    const double a = variance + 0.33, b = variance + 0.09;
    slopes[0][0] = 0.0;
    slopes[0][1] = 2.0 * shared[0] / kPi *
                   (-0.5 * 0.33 / (a * a) + 0.45 * 0.09 / (b * b) * azimuthal);
  }
};

struct CookTorrance {
  static constexpr int kLinear = 2;
  static constexpr int kShared = 2;  // f0, log alpha

  template <class T>
  static void Rows(const T* shared, const Directions& d, T* rows) {
    using std::exp;
    const T inverse = exp(-2.0 * shared[1]);
    const double x = d.xi + d.xo, y = d.yi + d.yo, z = d.zi + d.zo;
    const double length2 = x * x + y * y + z * z;
    const double tan2 = (x * x + y * y) / (z * z);
    const double g = std::min(0.25 / (d.zi * d.zo), z / (length2 * std::max(d.zi, d.zo)));
    const double s = SchlickWeight(std::sqrt(length2));
    const T ndf = exp(-tan2 * inverse) * inverse * ((1.0 + tan2) * (1.0 + tan2) / kPi);
    rows[0] = T(0.0);
    rows[1] = T(1.0 / kPi);
    rows[2] = ndf * (shared[0] * (1.0 - s) + s) * g;
  }

  static void RowsAndSlopes(const double* shared, const Directions& d,
                            double* rows, double slopes[][kLinear + 1]) {
    const double inverse = std::exp(-2.0 * shared[1]);
    const double x = d.xi + d.xo, y = d.yi + d.yo, z = d.zi + d.zo;
    const double length2 = x * x + y * y + z * z;
    const double tan2 = (x * x + y * y) / (z * z);
    const double g = std::min(0.25 / (d.zi * d.zo), z / (length2 * std::max(d.zi, d.zo)));
    const double s = SchlickWeight(std::sqrt(length2));
    const double facets =
        std::exp(-tan2 * inverse) * inverse * ((1.0 + tan2) * (1.0 + tan2) / kPi) * g;
    rows[0] = 0.0;
    rows[1] = 1.0 / kPi;
    rows[2] = facets * (shared[0] * (1.0 - s) + s);
    slopes[0][0] = slopes[0][1] = slopes[1][0] = slopes[1][1] = 0.0;
    slopes[0][2] = facets * (1.0 - s);
    slopes[1][2] = rows[2] * 2.0 * (tan2 * inverse - 1.0);
  }
};

#endif  // BENCHMARKS_CERES_MODELS_H_
