#include "postproc/analysis/exits/last_exits.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::postproc {
namespace {

/// Number of the part that an azimuth [rad] lies in, of `count` equal ones, the first of which begins at `start` [turns].
std::size_t part_of_turn(double azimuth, double start, std::size_t count) {
    const double turns = azimuth / (2.0 * k_pi) - start;
    const auto part = static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(count));
    return std::min(part, count - 1);
}

void add(RockAmount& amount, const RockHistory& rock) {
    ++amount.count;
    amount.mass += rock.mass;
}

ExitQuarters quarters_of(const std::map<int, RockHistory>& rocks, bool bank_at_90) {
    ExitQuarters quarters;
    quarters.bank_at_90 = bank_at_90;
    RockAmount& at_90 = bank_at_90 ? quarters.bank_side : quarters.trailing_side;
    RockAmount& at_270 = bank_at_90 ? quarters.trailing_side : quarters.bank_side;
    RockAmount* const by_part[] = {&quarters.bottom, &at_90, &quarters.top, &at_270};
    for (const auto& [id, rock] : rocks) add(*by_part[part_of_turn(rock.last_exit_azimuth, -0.125, 4)], rock);
    return quarters;
}

}  // namespace

std::optional<bool> bank_is_at_90(const OperatingPoint& point) {
    if (point.swing_direction.empty()) return std::nullopt;
    return (point.swing_direction == "under_cut") == (point.rotor_direction == "right_handed");
}

LastExits last_exits_of(const Table& events, const std::vector<geometry::AxialBin>& bins, const OperatingPoint& point, double from,
                        double to, double supplied) {
    RockHistories histories;
    histories.advance(events, to);
    std::map<int, RockHistory> left;
    for (const auto& [id, rock] : histories.rocks())
        if (rock.is_spilled() && rock.last_exit_time > from) left[id] = rock;
    LastExits exits{from, to, supplied, bin_spilled_rock(left, bins), {}, {}};
    for (const auto& [id, rock] : left) add(exits.sectors[part_of_turn(rock.last_exit_azimuth, 0.0, k_last_exit_sectors)], rock);
    if (const std::optional<bool> at_90 = bank_is_at_90(point)) exits.quarters = quarters_of(left, *at_90);
    return exits;
}

}  // namespace cutterflow::postproc
