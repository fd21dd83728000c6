#include "bench/statistics/statistics.h"

#include "core/base/error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

namespace tetrace {

double quantile(std::vector<double> samples, double p)
{
    if (samples.empty()) throw Error(ErrorKind::internal, "quantile of no samples");
    std::ranges::sort(samples);
    const double position = p * static_cast<double>(samples.size() - 1);
    const auto below = static_cast<std::size_t>(position);
    const auto above = std::min(below + 1, samples.size() - 1);
    return std::lerp(samples[below], samples[above], position - static_cast<double>(below));
}

Statistics statistics_of(const std::vector<double>& samples)
{
    if (std::ranges::any_of(samples, [](double s) { return !(std::isfinite(s) && s > 0); }))
        throw Error(ErrorKind::internal, "a sample that is not positive and finite");
    return {quantile(samples, 0.5), quantile(samples, 0.25), quantile(samples, 0.75)};
}

namespace {

constexpr int resamples = 2000;
constexpr std::uint64_t seed = 0x7e77ace;
constexpr double tail = (1 - reproduce_confidence) / 2;
constexpr double normal_quantile = 1.959964; // of 1 - tail

bool bounds_anything(std::size_t views, Sampling sampling)
{
    return views >= min_views && sampling != Sampling::chosen;
}

/// How many of n numbers are left out on each side of their median's interval: the most that a fair coin, thrown n
/// times, gives heads at most in no more than the tail of all cases.
std::size_t left_out_of_median(std::size_t n)
{
    const auto count = static_cast<double>(n);
    double probability = 0;
    for (std::size_t heads = 0; heads < n; ++heads) {
        const auto k = static_cast<double>(heads);
        probability +=
            std::exp(std::lgamma(count + 1) - std::lgamma(k + 1) - std::lgamma(count - k + 1) - count * std::log(2.0));
        if (probability > tail) return std::max<std::size_t>(heads, 1) - 1;
    }
    return 0;
}

/// statistic: of the views with these indices.
Estimate bootstrap(std::size_t views, Sampling sampling,
                   const std::function<double(const std::vector<std::size_t>&)>& statistic)
{
    std::vector<std::size_t> indices(views);
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    Estimate estimate{statistic(indices), {}, {}, false};
    if (!bounds_anything(views, sampling)) return estimate;
    std::mt19937_64 random(seed);
    std::vector<double> values;
    for (int i = 0; i < resamples; ++i) {
        // The standard's distributions draw differently in each library.
        for (std::size_t& index : indices)
            index = random() % views;
        values.push_back(statistic(indices));
    }
    estimate.low = quantile(values, tail);
    estimate.high = quantile(values, 1 - tail);
    return estimate;
}

double sum_of(const std::vector<double>& values, const std::vector<std::size_t>& indices)
{
    double sum = 0;
    for (const std::size_t index : indices)
        sum += values[index];
    return sum;
}

void check_pairs(const char* what, const std::vector<double>& a, const std::vector<double>& b)
{
    if (a.size() != b.size() || a.empty())
        throw Error(ErrorKind::internal, std::string(what) + ": values of other views, or of none");
}

/// Sums of squares and products about the means.
struct Moments {
    double mean_x = 0, mean_y = 0, xx = 0, yy = 0, xy = 0;
};

Moments moments_of(const std::vector<double>& x, const std::vector<double>& y)
{
    check_pairs("a correlation", x, y);
    Moments m;
    const auto n = static_cast<double>(x.size());
    m.mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
    m.mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double dx = x[i] - m.mean_x, dy = y[i] - m.mean_y;
        m.xx += dx * dx;
        m.yy += dy * dy;
        m.xy += dx * dy;
    }
    return m;
}

} // namespace

bool is_even(const std::vector<std::uint32_t>& views, std::size_t population)
{
    if (views.empty()) return false;
    const double most = 2 * static_cast<double>(population) / static_cast<double>(views.size());
    double before = -1;
    for (const std::uint32_t view : views) {
        if (view - before > most) return false;
        before = view;
    }
    return static_cast<double>(population) - before <= most;
}

Estimate mean_count(const std::vector<double>& counts, Sampling sampling)
{
    if (counts.empty()) throw Error(ErrorKind::internal, "the mean of counts of no views");
    const auto views = static_cast<double>(counts.size());
    const double sum = std::accumulate(counts.begin(), counts.end(), 0.0);
    if (sampling == Sampling::whole) return {sum / views, {}, {}, true};
    if (sum == 0) return {0, 0, {}, false};
    return bootstrap(counts.size(), sampling, [&](const auto& indices) { return sum_of(counts, indices) / views; });
}

Estimate median_of_views(const std::vector<double>& values, Sampling sampling)
{
    if (values.empty()) throw Error(ErrorKind::internal, "the median of numbers of no views");
    Estimate estimate{quantile(values, 0.5), {}, {}, false};
    if (!bounds_anything(values.size(), sampling)) return estimate;
    std::vector<double> sorted = values;
    std::ranges::sort(sorted);
    const std::size_t outside = left_out_of_median(sorted.size());
    estimate.low = sorted[outside];
    estimate.high = sorted[sorted.size() - 1 - outside];
    return estimate;
}

Estimate ratio_of_sums(const std::vector<double>& numerator, const std::vector<double>& denominator, Sampling sampling)
{
    check_pairs("a ratio", numerator, denominator);
    if (std::ranges::any_of(denominator, [](double value) { return !(value > 0); }))
        throw Error(ErrorKind::internal, "a ratio to what is not positive");
    return bootstrap(numerator.size(), sampling,
                     [&](const auto& indices) { return sum_of(numerator, indices) / sum_of(denominator, indices); });
}

std::optional<Estimate> correlation(const std::vector<double>& x, const std::vector<double>& y, Sampling sampling)
{
    const Moments m = moments_of(x, y);
    if (x.size() < min_views || !(m.xx > 0) || !(m.yy > 0)) return std::nullopt;
    const double r = std::clamp(m.xy / std::sqrt(m.xx * m.yy), -1.0, 1.0);
    if (!bounds_anything(x.size(), sampling)) return Estimate{r, {}, {}, false};
    if (std::abs(r) == 1) return Estimate{r, r, r, false}; // its z is infinite
    const double reach = normal_quantile / std::sqrt(static_cast<double>(x.size()) - 3);
    return Estimate{r, std::tanh(std::atanh(r) - reach), std::tanh(std::atanh(r) + reach), false};
}

Estimate intercept_share(const std::vector<double>& x, const std::vector<double>& y, Sampling sampling)
{
    return bootstrap(x.size(), sampling, [&](const auto& indices) {
        std::vector<double> xs, ys;
        for (const std::size_t index : indices) {
            xs.push_back(x[index]);
            ys.push_back(y[index]);
        }
        const Moments m = moments_of(xs, ys);
        return m.xx > 0 ? 1 - m.xy / m.xx * m.mean_x / m.mean_y : 1;
    });
}

Line fit_line(const std::vector<double>& x, const std::vector<double>& y)
{
    const Moments m = moments_of(x, y);
    const double slope = m.xy / m.xx;
    return {slope, m.mean_y - slope * m.mean_x};
}

} // namespace tetrace
