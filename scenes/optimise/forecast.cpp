#include "scenes/optimise/forecast.h"

#include <algorithm>
#include <cmath>

namespace tetrace {

namespace {

constexpr double highest_ratio = 0.95; // rounds come to an end
constexpr double min_share = 0.05;     // of a round, from which its time is predicted
constexpr double first_rounds = 6;     // as many as bunny has, before the first has ended

} // namespace

void Forecast::end_round(double elapsed_s, double gain)
{
    const double round_s = elapsed_s - begin_s_;
    if (last_s_ > 0) time_ratio_ = std::min(round_s / last_s_, highest_ratio);
    if (last_gain_ > 0) gain_ratio_ = std::min(gain / last_gain_, highest_ratio);
    begin_s_ = elapsed_s;
    last_s_ = round_s;
    last_gain_ = gain;
}

double Forecast::left_s(double elapsed_s, double share_of_round, double enough, std::uint32_t max_rounds) const
{
    const double in_round_s = elapsed_s - begin_s_;
    double round_s = last_s_ * time_ratio_; // of the current round
    if (last_s_ == 0 || in_round_s > round_s) round_s = in_round_s / std::max(share_of_round, min_share);
    double rounds = first_rounds; // after the current one
    if (last_gain_ > 0 && enough > 0)
        rounds = std::ceil(std::max(0.0, std::log(enough / last_gain_) / std::log(gain_ratio_) - 1));
    rounds = std::min(rounds, static_cast<double>(max_rounds));
    const double later_s = round_s * time_ratio_ * (1 - std::pow(time_ratio_, rounds)) / (1 - time_ratio_);
    return std::max(0.0, round_s - in_round_s) + later_s;
}

} // namespace tetrace
