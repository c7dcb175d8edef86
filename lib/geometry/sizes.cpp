#include "geometry/sizes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/random.hpp"
#include "geometry/polygon_rules.hpp"

namespace pliant {

namespace {

using Kind = SizeDistribution::Kind;

/// Density of a continuous distribution, of any norm.
double density(const SizeDistribution& distribution, double size) {
  const double c = distribution.centre, d = distribution.deviation;
  switch (distribution.kind) {
    case Kind::normal:
      return std::exp(-0.5 * (size - c) * (size - c) / (d * d));
    case Kind::lognormal:
      return std::exp(-0.5 * std::pow(std::log(size / c) / d, 2)) / size;
    default:
      return 1;
  }
}

/// A continuous distribution as a histogram of many equal bins, cut at its limits and where next to nothing is left.
struct Histogram {
  static constexpr int bins = 2000;
  static constexpr double tail = 8;  // standard deviations
  double low, width;
  std::vector<double> share;  // [bins], sum 1

  explicit Histogram(const SizeDistribution& distribution) : low(distribution.low), width(0), share(bins) {
    const double c = distribution.centre, d = tail * distribution.deviation;
    double high = distribution.high;
    if (distribution.kind == Kind::normal) low = std::max(low, c - d), high = std::min(high, c + d);
    if (distribution.kind == Kind::lognormal)
      low = std::max(low, c * std::exp(-d)), high = std::min(high, c * std::exp(d));
    width = (high - low) / bins;
    for (int i = 0; i < bins; ++i) share[i] = density(distribution, middle(i));
    const double sum = std::accumulate(share.begin(), share.end(), 0.0);
    for (double& s : share) s /= sum;
  }

  double middle(int bin) const { return low + (bin + 0.5) * width; }
};

/// Quantiles (i + 1/2)/count, in growing order.
std::vector<double> quantiles(const Histogram& histogram, int count) {
  std::vector<double> sizes;
  int bin = 0;
  double before = 0;
  for (int i = 0; i < count; ++i) {
    const double wanted = (i + 0.5) / count;
    while (bin + 1 < Histogram::bins && before + histogram.share[bin] < wanted) before += histogram.share[bin++];
    const double within = std::clamp((wanted - before) / histogram.share[bin], 0.0, 1.0);
    sizes.push_back(histogram.low + (bin + within) * histogram.width);
  }
  return sizes;
}

}  // namespace

std::vector<double> draw_sizes(const SizeDistribution& distribution, int count, std::uint64_t seed) {
  std::mt19937_64 random = random_stream(seed, 1);
  if (distribution.kind == Kind::list) {
    std::vector<double> sizes;
    for (const int entry : assign_shares(distribution.shares, count, random))
      sizes.push_back(distribution.factors[entry]);
    return sizes;
  }
  std::vector<double> sizes = quantiles(Histogram(distribution), count);
  shuffle(sizes, random);
  return sizes;
}

double mean_square_size(const SizeDistribution& distribution) {
  double sum = 0;
  if (distribution.kind == Kind::list) {
    for (std::size_t i = 0; i < distribution.factors.size(); ++i)
      sum += distribution.shares[i] * distribution.factors[i] * distribution.factors[i];
    return sum;
  }
  const Histogram histogram(distribution);
  for (int i = 0; i < Histogram::bins; ++i) sum += histogram.share[i] * histogram.middle(i) * histogram.middle(i);
  return sum;
}

double largest_size(const SizeDistribution& distribution) {
  return distribution.kind == Kind::list ? *std::max_element(distribution.factors.begin(), distribution.factors.end())
                                         : distribution.high;
}

double equivalent_diameter(const ShapeSpec& shape) {
  return shape.kind == ShapeKind::disc ? shape.diameter : 2 * std::sqrt(signed_area(shape.points) / std::numbers::pi);
}

}  // namespace pliant
