// Fits of brdffit's models with Ceres, called through one C function.
//
// Every sample is a residual block of three channels. Its cost function evaluates the
// basis functions once for all three, with derivatives written out by hand, or lets
// Ceres differentiate the values (ceres::Jet).

#include <ceres/ceres.h>

#include <cmath>
#include <cstring>

#include "models.h"

namespace {

constexpr int kChannels = 3;

// What one sample sees: lights with their weights, and the observation.
struct Sample {
  int lights;
  const double* wi;      // light, 3
  const double* wo;      // 3
  const double* weight;  // light, channel
  double target[kChannels];

  Directions At(int light) const {
    const double* i = wi + 3 * light;
    return {i[0], i[1], i[2], wo[0], wo[1], wo[2]};
  }
};

bool Dark(const double* weight) {
  return weight[0] == 0.0 && weight[1] == 0.0 && weight[2] == 0.0;
}

// T(value) - target, with T the identity or the logarithm.
template <class Model, bool kLog>
class Analytic final
    : public ceres::SizedCostFunction<kChannels,
                                      kChannels * Model::kLinear + Model::kShared> {
 public:
  explicit Analytic(const Sample& sample) : sample_(sample) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const final {
    constexpr int kLinear = Model::kLinear, kShared = Model::kShared;
    constexpr int kSize = kChannels * kLinear + kShared;
    const double* linear = parameters[0];
    const double* shared = linear + kChannels * kLinear;
    const bool slopes_wanted = jacobians != nullptr && jacobians[0] != nullptr;

    double sums[kChannels][kLinear + 1] = {};
    double slope_sums[kChannels][kShared][kLinear + 1] = {};
    for (int light = 0; light < sample_.lights; ++light) {
      const double* weight = sample_.weight + kChannels * light;
      if (Dark(weight)) continue;  // below the horizon
      double rows[kLinear + 1], slopes[kShared][kLinear + 1];
      if (slopes_wanted) {
        Model::RowsAndSlopes(shared, sample_.At(light), rows, slopes);
      } else {
        Model::Rows(shared, sample_.At(light), rows);
      }
      for (int c = 0; c < kChannels; ++c) {
        for (int j = 0; j <= kLinear; ++j) {
          sums[c][j] += weight[c] * rows[j];
          if (!slopes_wanted) continue;
          for (int k = 0; k < kShared; ++k) {
            slope_sums[c][k][j] += weight[c] * slopes[k][j];
          }
        }
      }
    }

    for (int c = 0; c < kChannels; ++c) {
      double value = sums[c][0];
      for (int j = 0; j < kLinear; ++j) {
        value += linear[kChannels * j + c] * sums[c][j + 1];
      }
      if (kLog && !(value > 0.0)) return false;  // Ceres then takes a shorter step
      residuals[c] = (kLog ? std::log(value) : value) - sample_.target[c];
      if (!slopes_wanted) continue;
      const double outer = kLog ? 1.0 / value : 1.0;
      double* row = jacobians[0] + c * kSize;
      std::fill(row, row + kSize, 0.0);
      for (int j = 0; j < kLinear; ++j) {
        row[kChannels * j + c] = outer * sums[c][j + 1];
      }
      for (int k = 0; k < kShared; ++k) {
        double slope = slope_sums[c][k][0];
        for (int j = 0; j < kLinear; ++j) {
          slope += linear[kChannels * j + c] * slope_sums[c][k][j + 1];
        }
        row[kChannels * kLinear + k] = outer * slope;
      }
    }
    return true;
  }

 private:
  Sample sample_;
};

template <class Model, bool kLog>
struct Value {
  Sample sample;

  template <class T>
  bool operator()(const T* linear, T* residuals) const {
    using std::log;
    constexpr int kLinear = Model::kLinear;
    T value[kChannels] = {T(0.0), T(0.0), T(0.0)};
    for (int light = 0; light < sample.lights; ++light) {
      const double* weight = sample.weight + kChannels * light;
      if (Dark(weight)) continue;
      T rows[kLinear + 1];
      Model::Rows(linear + kChannels * kLinear, sample.At(light), rows);
      for (int c = 0; c < kChannels; ++c) {
        T reflectance = rows[0];
        for (int j = 0; j < kLinear; ++j) {
          reflectance += linear[kChannels * j + c] * rows[j + 1];
        }
        value[c] += weight[c] * reflectance;
      }
    }
    for (int c = 0; c < kChannels; ++c) {
      if (kLog && !(value[c] > T(0.0))) return false;
      residuals[c] = (kLog ? log(value[c]) : value[c]) - sample.target[c];
    }
    return true;
  }
};

template <class Model, bool kLog>
ceres::CostFunction* Cost(const Sample& sample, bool automatic) {
  constexpr int kSize = kChannels * Model::kLinear + Model::kShared;
  if (!automatic) return new Analytic<Model, kLog>(sample);
  using Function = Value<Model, kLog>;
  return new ceres::AutoDiffCostFunction<Function, kChannels, kSize>(new Function{sample});
}

template <bool kLog>
ceres::CostFunction* Cost(const char* model, const Sample& sample, bool automatic) {
  if (!std::strcmp(model, "ggx")) return Cost<Ggx, kLog>(sample, automatic);
  if (!std::strcmp(model, "ward_duer")) return Cost<WardDuer, kLog>(sample, automatic);
  if (!std::strcmp(model, "oren_nayar")) return Cost<OrenNayar, kLog>(sample, automatic);
  if (!std::strcmp(model, "cook_torrance")) return Cost<CookTorrance, kLog>(sample, automatic);
  return nullptr;
}

}  // namespace

// A problem that is built once and solved many times.
struct Fit {
  ceres::Problem problem;
  double x[16];
  int size;
};

extern "C" Fit* fit_make(const char* model, bool logarithmic, bool automatic, int samples,
                         int lights, int size, const double* wi, const double* wo,
                         const double* weight, const double* value) {
  Fit* fit = new Fit;
  fit->size = size;
  for (int n = 0; n < samples; ++n) {
    Sample sample{lights, wi + 3 * lights * n, wo + 3 * n, weight + kChannels * lights * n, {}};
    for (int c = 0; c < kChannels; ++c) {
      const double y = value[kChannels * n + c];
      sample.target[c] = logarithmic ? std::log(y) : y;
    }
    ceres::CostFunction* cost = logarithmic ? Cost<true>(model, sample, automatic)
                                            : Cost<false>(model, sample, automatic);
    if (cost == nullptr) {
      delete fit;
      return nullptr;
    }
    fit->problem.AddResidualBlock(cost, nullptr, fit->x);
  }
  return fit;
}

// Solves from x, which becomes the solution; returns the number of steps, or -1.
extern "C" int fit_solve(Fit* fit, double* x, int threads, double tolerance) {
  std::copy(x, x + fit->size, fit->x);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 200;
  options.num_threads = threads;
  options.function_tolerance = tolerance;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &fit->problem, &summary);
  std::copy(fit->x, fit->x + fit->size, x);
  return summary.IsSolutionUsable() ? static_cast<int>(summary.iterations.size()) - 1 : -1;
}

extern "C" void fit_free(Fit* fit) { delete fit; }
