#include "postproc/analysis/replays/exits.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <gsl/assert>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::postproc {
namespace {

constexpr std::size_t k_named_bins = 3;
constexpr std::size_t k_half = k_exit_sectors / 2;

constexpr double k_sector_deg = 360.0 / k_exit_sectors;

double sector_start_deg(std::size_t sector) {
    return k_sector_deg * static_cast<double>(sector);
}

double share_of_half(const Exits& exits, std::size_t first) {
    double share = 0.0;
    for (std::size_t s = first; s < first + k_half; ++s) share += exits.by_sector[s % k_exit_sectors];
    return share;
}

/// All shares of one run, bins first.
std::vector<double> shares_of(const Exits& exits) {
    std::vector<double> shares = exits.by_bin;
    shares.insert(shares.end(), exits.by_sector.begin(), exits.by_sector.end());
    return shares;
}

}  // namespace

std::optional<Exits> exits_of(const Spillage& spillage) {
    if (spillage.fates.spilled.count == 0) return std::nullopt;
    Exits exits;
    for (const BinSpillage& bin : spillage.bins) {
        exits.bins.push_back(bin.bin.name);
        exits.by_bin.push_back(bin.spilled.mass / spillage.fates.spilled.mass);
    }
    const double share = 1.0 / static_cast<double>(spillage.first_exit_azimuths.size());
    for (const double azimuth : spillage.first_exit_azimuths) {
        const auto sector = static_cast<std::size_t>(azimuth / (2.0 * k_pi) * static_cast<double>(k_exit_sectors));
        exits.by_sector[std::min(sector, k_exit_sectors - 1)] += share;
    }
    return exits;
}

Exits mean_exits(const std::vector<Exits>& exits) {
    Expects(!exits.empty());
    Exits mean = exits.front();
    const auto share = 1.0 / static_cast<double>(exits.size());
    const auto mean_of = [&](const auto& value) {
        return share * std::accumulate(exits.begin(), exits.end(), 0.0, [&](double sum, const Exits& one) { return sum + value(one); });
    };
    for (std::size_t b = 0; b < mean.by_bin.size(); ++b) mean.by_bin[b] = mean_of([b](const Exits& one) { return one.by_bin[b]; });
    for (std::size_t s = 0; s < k_exit_sectors; ++s) mean.by_sector[s] = mean_of([s](const Exits& one) { return one.by_sector[s]; });
    return mean;
}

std::string exits_csv(const std::vector<Exits>& exits) {
    const Exits mean = mean_exits(exits);
    std::vector<std::string> places;
    for (const std::string& bin : mean.bins) places.push_back("bin," + bin);
    for (std::size_t s = 0; s < k_exit_sectors; ++s)
        places.push_back(fmt::format("azimuth_deg,{:.0f}-{:.0f}", sector_start_deg(s), sector_start_deg(s + 1)));
    const std::vector<double> shares = shares_of(mean);
    std::vector<double> least = shares, most = shares;
    for (const Exits& one : exits) {
        const std::vector<double> of_one = shares_of(one);
        for (std::size_t i = 0; i < of_one.size(); ++i) {
            least[i] = std::min(least[i], of_one[i]);
            most[i] = std::max(most[i], of_one[i]);
        }
    }
    std::string csv = "where,place,share,smallest,largest\n";
    for (std::size_t i = 0; i < places.size(); ++i)
        csv += fmt::format("{},{:.6g},{:.6g},{:.6g}\n", places[i], shares[i], least[i], most[i]);
    return csv;
}

std::string exits_text(const Exits& mean) {
    std::vector<std::size_t> order(mean.bins.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return mean.by_bin[a] > mean.by_bin[b]; });
    std::string named;
    for (std::size_t i = 0; i < std::min(k_named_bins, order.size()); ++i)
        if (const double share = mean.by_bin[order[i]]; share > 0.0)
            named += fmt::format("{}{:.0f} % at {}", named.empty() ? "" : ", ", 100.0 * share, mean.bins[order[i]]);
    std::size_t half = 0;
    for (std::size_t first = 1; first < k_exit_sectors; ++first)
        if (share_of_half(mean, first) > share_of_half(mean, half)) half = first;
    return fmt::format("exits       {} of what is spilled; {:.0f} % of the rocks from azimuth {:.0f} to {:.0f} deg (0 lowest)\n", named,
                       100.0 * share_of_half(mean, half), sector_start_deg(half), sector_start_deg((half + k_half) % k_exit_sectors));
}

}  // namespace cutterflow::postproc
