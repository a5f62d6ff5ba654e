// Many small fits with Ceres' TinySolver, one texel after the other.
//
// A point holds the linear parameters of all channels and then the nonlinear ones, each
// as the logistic map of its interval, because TinySolver knows no bounds. Derivatives
// are written out by hand in models.h.

#include <ceres/tiny_solver.h>

#include <cmath>
#include <cstring>
#include <thread>
#include <vector>

#include "models.h"

namespace {

constexpr int kChannels = 3;

// Arrays of one texture, the texel first.
struct Texture {
  int texels, observations;
  const double *wi, *wo, *weight, *value, *lower, *upper;
};

template <class Model>
struct Texel {
  using Scalar = double;
  static constexpr int kLinear = Model::kLinear, kShared = Model::kShared;
  enum {
    NUM_RESIDUALS = Eigen::Dynamic,
    NUM_PARAMETERS = kChannels * Model::kLinear + Model::kShared
  };

  const Texture& all;
  int texel;

  int NumResiduals() const { return kChannels * all.observations; }

  bool operator()(const double* u, double* residuals, double* jacobian) const {
    double x[NUM_PARAMETERS], by_u[NUM_PARAMETERS];
    for (int i = 0; i < NUM_PARAMETERS; ++i) {
      const double share = 1.0 / (1.0 + std::exp(-u[i]));
      const double width = all.upper[i] - all.lower[i];
      x[i] = all.lower[i] + width * share;
      by_u[i] = width * share * (1.0 - share);
    }
    const double* shared = x + kChannels * kLinear;
    const int count = all.observations, rows_in_all = kChannels * count;
    if (jacobian) std::fill(jacobian, jacobian + rows_in_all * NUM_PARAMETERS, 0.0);
    for (int n = 0; n < count; ++n) {
      const size_t at = static_cast<size_t>(texel) * count + n;
      const double *i = all.wi + 3 * at, *o = all.wo + 3 * at, weight = all.weight[at];
      const Directions d{i[0], i[1], i[2], o[0], o[1], o[2]};
      double rows[kLinear + 1], slopes[kShared][kLinear + 1];
      if (jacobian) {
        Model::RowsAndSlopes(shared, d, rows, slopes);
      } else {
        Model::Rows(shared, d, rows);
      }
      for (int c = 0; c < kChannels; ++c) {
        const int row = kChannels * n + c;
        double value = rows[0];
        for (int j = 0; j < kLinear; ++j) value += x[kChannels * j + c] * rows[j + 1];
        residuals[row] = weight * value - all.value[kChannels * at + c];
        if (!jacobian) continue;
        for (int j = 0; j < kLinear; ++j) {
          const int p = kChannels * j + c;
          jacobian[p * rows_in_all + row] = weight * rows[j + 1] * by_u[p];
        }
        for (int k = 0; k < kShared; ++k) {
          double slope = slopes[k][0];
          for (int j = 0; j < kLinear; ++j) {
            slope += x[kChannels * j + c] * slopes[k][j + 1];
          }
          const int p = kChannels * kLinear + k;
          jacobian[p * rows_in_all + row] = weight * slope * by_u[p];
        }
      }
    }
    return true;
  }
};

template <class Model>
void Solve(const Texture& all, int first, int last, double tolerance, double* points) {
  using Function = Texel<Model>;
  ceres::TinySolver<Function> solver;
  solver.options.function_tolerance = tolerance;
  solver.options.max_num_iterations = 100;
  Eigen::Matrix<double, Function::NUM_PARAMETERS, 1> u;
  for (int texel = first; texel < last; ++texel) {
    double* x = points + static_cast<size_t>(texel) * Function::NUM_PARAMETERS;
    for (int i = 0; i < Function::NUM_PARAMETERS; ++i) {
      const double share = (x[i] - all.lower[i]) / (all.upper[i] - all.lower[i]);
      u[i] = std::log(share / (1.0 - share));
    }
    solver.Solve(Function{all, texel}, &u);
    for (int i = 0; i < Function::NUM_PARAMETERS; ++i) {
      x[i] = all.lower[i] + (all.upper[i] - all.lower[i]) / (1.0 + std::exp(-u[i]));
    }
  }
}

template <class Model>
void SolveOnThreads(const Texture& all, int threads, double tolerance, double* points) {
  std::vector<std::thread> pool;
  for (int t = 1; t < threads; ++t) {
    const int first = static_cast<long>(all.texels) * t / threads;
    const int last = static_cast<long>(all.texels) * (t + 1) / threads;
    pool.emplace_back([=, &all] { Solve<Model>(all, first, last, tolerance, points); });
  }
  Solve<Model>(all, 0, all.texels / threads, tolerance, points);
  for (std::thread& thread : pool) thread.join();
}

}  // namespace

// Solves each texel from its point, which becomes the solution; false without the model.
extern "C" bool texture_solve(const char* model, int texels, int observations,
                              const double* wi, const double* wo, const double* weight,
                              const double* value, const double* lower,
                              const double* upper, int threads, double tolerance,
                              double* points) {
  const Texture all{texels, observations, wi, wo, weight, value, lower, upper};
  if (!std::strcmp(model, "ggx")) {
    SolveOnThreads<Ggx>(all, threads, tolerance, points);
  } else if (!std::strcmp(model, "ward_duer")) {
    SolveOnThreads<WardDuer>(all, threads, tolerance, points);
  } else if (!std::strcmp(model, "cook_torrance")) {
    SolveOnThreads<CookTorrance>(all, threads, tolerance, points);
  } else {
    return false;
  }
  return true;
}
