#include "postproc/analysis/spillage.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gsl/assert>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"

namespace cutterflow::postproc {
namespace {

constexpr double k_mass_tolerance = 1e-6;  ///< relative; the tables are text with a limited number of digits
constexpr const char* k_remedy = "Keep the run directory and report this as a defect of the fates";

RockAmount amount(const Table& fates, const std::string& fate, std::size_t row) {
    return {static_cast<int>(fates.number(fate + "_count")[row]), fates.number(fate + "_kg")[row]};
}

/// Rows at or before `time`; a thousandth of a step more is the rounding of text.
double with_tolerance(double time) {
    return time + 1e-9 * std::max(1.0, std::abs(time));
}

/// The last row of fates that agrees with the events.
std::size_t last_agreed_row(const Table& fates, const Table& events, bool finished) {
    RockHistories histories;
    std::optional<std::size_t> agreed;
    for (std::size_t row = 0; row < fates.rows(); ++row) {
        const Fates now = fates_at(fates, row);
        histories.advance(events, now.time);
        if (histories.spilled() == now.spilled.count && histories.sucked_up() == now.sucked_up.count) agreed = row;
    }
    const std::size_t last = fates.rows() - 1;
    // A killed run may have written one table further than the other; a finished one has not.
    if (!agreed || (finished && *agreed != last)) {
        const Fates end = fates_at(fates, last);
        throw CheckFailure({"postProcessing/rock",
                            fmt::format("events.csv has {} spilled and {} sucked up rocks, fates.csv {} and {} at t = {:.6g} s",
                                        histories.spilled(), histories.sucked_up(), end.spilled.count, end.sucked_up.count, end.time),
                            "Both are written from the same crossings", k_remedy});
    }
    return *agreed;
}

void require_same_mass(const std::vector<BinSpillage>& bins, const Fates& fates) {
    double mass = 0.0;
    for (const BinSpillage& bin : bins) mass += bin.spilled.mass;
    if (std::abs(mass - fates.spilled.mass) <= k_mass_tolerance * fates.placed.mass) return;
    throw CheckFailure({"postProcessing/rock", fmt::format("the bins contain {:.9g} kg, spilled are {:.9g} kg", mass, fates.spilled.mass),
                        "Bins add up to the spilled rock", k_remedy});
}

/// Ratios after 1, 2, 3 ... `interval`s [s] since `start`, up to row `last`. The run may end 0.5 % of an interval early: time steps do
/// not fall on the mark. A table tells no more of them apart than it has rows.
std::vector<RatiosAt> ratios_every(const Table& fates, std::size_t last, double start, double interval) {
    std::vector<RatiosAt> series;
    const std::vector<double>& times = fates.number("time_s");
    const double end = times[last] + 0.005 * interval;
    for (int k = 1; start + k * interval <= end && series.size() <= last; ++k) {
        RatiosAt at = ratios_after(fates, start, k * interval);
        at.since_feed = k;
        series.push_back(at);
    }
    return series;
}

/// Time of the first rock, for runs whose events lack it.
double first_placed_time(const Table& fates) {
    for (std::size_t row = 0; row < fates.rows(); ++row) {
        if (fates.number("placed_count")[row] > 0.0) return fates.number("time_s")[row];
    }
    return fates.number("time_s").back();
}

}  // namespace

Fates fates_at(const Table& fates, std::size_t row) {
    const Fates now{fates.number("time_s")[row],   amount(fates, "placed", row),    amount(fates, "sucked_up", row),
                    amount(fates, "spilled", row), amount(fates, "in_cutter", row), amount(fates, "never_entered", row)};
    const std::int64_t count = std::int64_t{now.sucked_up.count} + now.spilled.count + now.in_cutter.count + now.never_entered.count;
    const double mass = now.sucked_up.mass + now.spilled.mass + now.in_cutter.mass + now.never_entered.mass;
    if (count != now.placed.count || std::abs(mass - now.placed.mass) > k_mass_tolerance * now.placed.mass) {
        throw CheckFailure({"postProcessing/rock/fates.csv",
                            fmt::format("at t = {:.6g} s the four fates contain {} rocks and {:.9g} kg, placed are {} and {:.9g} kg",
                                        now.time, count, mass, now.placed.count, now.placed.mass),
                            "The four fates add up to the placed rock", k_remedy});
    }
    return now;
}

RatiosAt ratios_after(const Table& fates, double feed_start, double since_feed) {
    const std::vector<double>& times = fates.number("time_s");
    const auto after = std::upper_bound(times.begin(), times.end(), with_tolerance(feed_start + since_feed));
    Expects(after != times.begin());
    const Fates now = fates_at(fates, static_cast<std::size_t>(after - times.begin()) - 1);
    return {since_feed, now.time, now, ratios_of(now)};
}

SpillageRatios ratios_of(const Fates& fates) {
    if (!(fates.placed.mass > 0.0)) return {std::nullopt, std::nullopt, std::nullopt, std::nullopt, "no rock was placed"};
    SpillageRatios ratios;
    ratios.ratio_min = fates.spilled.mass / fates.placed.mass;
    ratios.ratio_max = 1.0 - fates.sucked_up.mass / fates.placed.mass;
    const bool all_decided = fates.in_cutter.count + fates.never_entered.count == 0;
    ratios.undecided = all_decided ? 0.0 : *ratios.ratio_max - *ratios.ratio_min;  // masses are rounded in their file
    const double decided = fates.spilled.mass + fates.sucked_up.mass;
    if (decided > 0.0) {
        ratios.ratio = fates.spilled.mass / decided;
    } else {
        ratios.reason = "no rock was spilled or sucked up yet";
    }
    return ratios;
}

std::vector<BinSpillage> bin_spilled_rock(const std::map<int, RockHistory>& rocks, const std::vector<geometry::AxialBin>& bins) {
    std::vector<BinSpillage> result;
    for (const geometry::AxialBin& bin : bins) result.push_back({bin, {}});
    for (const auto& [id, rock] : rocks) {
        if (!rock.is_spilled()) continue;
        const auto found =
            std::find_if(result.begin(), result.end(), [&](const BinSpillage& b) { return b.bin.name == rock.last_exit_bin; });
        if (found == result.end()) {
            throw CheckFailure({"postProcessing/rock/events.csv", fmt::format("rock {} left through bin \"{}\"", id, rock.last_exit_bin),
                                "The bins are those of report.bin_width_m and the head's contour", "Keep the bin width of the run"});
        }
        ++found->spilled.count;
        found->spilled.mass += rock.mass;
    }
    return result;
}

void RockHistories::advance(const Table& events, double time) {
    while (next_ < events.rows() && events.number("time_s")[next_] <= with_tolerance(time)) take(events, next_++);
}

void RockHistories::take(const Table& events, std::size_t row) {
    RockHistory& rock = rocks_[static_cast<int>(events.number("id")[row])];
    const double diameter = events.number("diameter_m")[row];
    rock.volume = sphere_volume(diameter);
    rock.mass = rock.volume * events.number("density_kg_m3")[row];
    const std::string& surface = events.text("surface")[row];
    const bool out = events.text("direction")[row] == "out";
    const bool was_spilled = rock.is_spilled();
    if (surface == "feed" && !feed_start_) feed_start_ = events.number("time_s")[row];
    if (surface == "head") {
        rock.outside = out;
        if (out) {
            rock.last_exit_bin = events.text("bin")[row];
            rock.last_exit_time = events.number("time_s")[row];
            rock.last_exit_azimuth = events.number("azimuth_rad")[row];
            if (!rock.first_exit_azimuth) rock.first_exit_azimuth = rock.last_exit_azimuth;
        }
    }
    if (surface == "mouth" && !out && !rock.sucked_up) {
        rock.sucked_up = true;
        ++sucked_up_;
    }
    spilled_ += static_cast<int>(rock.is_spilled()) - static_cast<int>(was_spilled);
}

std::string top_bin(const std::vector<geometry::AxialBin>& bins, const std::function<double(const std::string&)>& share_through) {
    std::string at_ring;
    for (const geometry::AxialBin& bin : bins) {
        if (bin.z_max > 0.0) continue;
        if (at_ring.empty()) at_ring = bin.name;
        if (share_through(bin.name) >= k_open_to_rock) return bin.name;
    }
    return at_ring;
}

Spillage evaluate_spillage(const Table& fates, const Table& events, const std::vector<geometry::AxialBin>& bins, double revolution,
                           bool finished) {
    Spillage result;
    const std::size_t last = last_agreed_row(fates, events, finished);
    result.fates = fates_at(fates, last);
    result.ratios = ratios_of(result.fates);
    RockHistories histories;
    histories.advance(events, result.fates.time);
    result.bins = bin_spilled_rock(histories.rocks(), bins);
    require_same_mass(result.bins, result.fates);
    result.feed_start = histories.feed_start().value_or(first_placed_time(fates));
    result.at_revolutions = ratios_every(fates, last, result.feed_start, revolution);
    result.at_seconds = ratios_every(fates, last, result.feed_start, 1.0);
    for (const auto& [id, rock] : histories.rocks()) {
        if (rock.sucked_up) {
            result.sucked_volume += rock.volume;
        } else if (rock.first_exit_azimuth) {
            result.first_exit_azimuths.push_back(*rock.first_exit_azimuth);
        }
    }
    return result;
}

}  // namespace cutterflow::postproc
