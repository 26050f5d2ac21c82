#include "postproc/analysis/dredging.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "geometry/base/at_work/usual_ranges.hpp"
#include "geometry/base/sphere.hpp"
#include "postproc/analysis/text.hpp"

namespace cutterflow::postproc {
namespace {

/// Of delivered rock: how long it was on its way, and its sizes. Events tell of it once it has found a place. \pre dredging.waiting_time
void follow_delivered(const Table& events, const Production& window, Dredging& dredging) {
    std::map<int, double> fed;
    double mass = 0.0, mass_time = 0.0, largest = 0.0;
    for (std::size_t row = 0; row < events.rows(); ++row) {
        const int id = static_cast<int>(events.number("id")[row]);
        const double time = events.number("time_s")[row];
        const std::string& surface = events.text("surface")[row];
        if (surface == "feed") fed[id] = time;
        const auto start = fed.find(id);
        if (surface != "mouth" || start == fed.end() || time < window.from || time > window.to) continue;
        const double diameter = events.number("diameter_m")[row], of_rock = sphere_mass(diameter, events.number("density_kg_m3")[row]);
        mass += of_rock;
        mass_time += of_rock * (time - start->second);
        largest = std::max(largest, diameter);
        fed.erase(start);
    }
    if (!(mass > 0.0)) return;
    dredging.residence_time = dredging.waiting_time + mass_time / mass;
    dredging.largest_delivered = largest;
}

/// What is lost by cutting over what is lost from a known cause: of rock that is left behind runs of earlier programs have none. Gains of
/// columns are net, so that one may be negative.
void add_cause(const Losses& losses, WaysOut& ways) {
    const double lost = losses.mixing + losses.cutting + losses.left_behind;
    const double known = losses.left_behind_cutting ? lost : losses.mixing + losses.cutting;
    if (!(known > 0.0) || !(lost > 0.0)) return;
    ways.by_cutting = std::clamp((losses.cutting + losses.left_behind_cutting.value_or(0.0)) / known, 0.0, 1.0);
    ways.cause_known = std::min(1.0, known / lost);
}

/// By the mean flux through the bin's part of the head's boundary, all around it, which counts what crosses a tapering contour along the
/// axis too; in runs of earlier programs by the mean radial velocity.
std::optional<WaysOut> ways_out_of(const Results& results) {
    const std::vector<BinSpillage>& bins = results.exits->bins;
    double with = 0.0, against = 0.0;
    for (std::size_t i = 0; i < bins.size() && i < results.outflow.size(); ++i) {
        const BinOutflow& bin = results.outflow[i];
        const std::optional<TimeAverage>& flow = bin.flux ? bin.flux : bin.radial_velocity;
        if (!flow) return std::nullopt;
        (flow->mean > 0.0 ? with : against) += bins[i].spilled.mass;
    }
    if (!(with + against > 0.0)) return std::nullopt;
    WaysOut ways{with / (with + against), against / (with + against), std::nullopt};
    add_cause(results.fed->losses, ways);
    return ways;
}

/// What the mouth takes: rock, and fines where it is known how many.
void set_mixture(const Production& window, const RunData& run, Dredging& dredging) {
    double mass = 0.0, volume = 0.0;  // of the feed
    if (run.feed)
        for (const RockClass& rock : run.feed->classes) {
            mass += rock.count * sphere_mass(rock.diameter, rock.density);
            volume += rock.count * sphere_volume(rock.diameter);
        }
    if (!(volume > 0.0) || !dredging.delivered_fines) return;
    const OperatingPoint& point = run.operating_point;
    const double grains = point.grain_density > 0.0 ? point.grain_density : mass / volume;
    const double mixture = point.discharge * (window.to - window.from);
    dredging.concentration = (window.delivered * volume / mass + *dredging.delivered_fines / grains) / mixture;
    dredging.mixture_density =
        point.fluid_density * (1.0 - *dredging.concentration) + (window.delivered + *dredging.delivered_fines) / mixture;
}

/// The thickness h that spilled rock has on all that the head passed: h s where the next swing does not come, and the section A_s(h) that
/// it takes. \param section  of spilled rock, h s + A_s(h) [m2] \param step  s [m]
/// \return nothing when no layer lower than the bank holds so much, or the feed is of an earlier program
std::optional<double> layer_for_the_next_swing(double section, double step, const FeedSummary& feed) {
    double thinner = 0.0, below = 0.0;
    for (std::size_t i = 0; i < feed.layer_thickness.size(); ++i) {
        const double thickness = feed.layer_thickness[i], held = thickness * step + feed.layer_section[i];
        if (held >= section) return thinner + (section - below) / (held - below) * (thickness - thinner);
        thinner = thickness;
        below = held;
    }
    return std::nullopt;
}

/// "31.0 % of what was spilled", and of which part where not of all.
std::string cause_text(const WaysOut& ways) {
    if (ways.cause_known == 1.0) return text::percent(*ways.by_cutting) + " of what was spilled";
    return fmt::format(
        "{} of the part of what was spilled whose cause is known, {} of it (an earlier program’s ledger lost the cause of what "
        "is left behind),",
        text::percent(*ways.by_cutting), text::percent(ways.cause_known));
}

/// Of a head before whose blades rock waits all the time.
std::string fullness_text(const FedHead& head) {
    constexpr double k_much = 0.05;  // of what a revolution cuts
    if (head.owed_share > k_much) return "the head is full, it cannot take what it cuts";
    return fmt::format("rock always waits for a place before a blade, though little: in the mean {} of what a revolution cuts",
                       text::percent(head.owed_share));
}

bool has_spilled(const Results& results) {
    const std::vector<BinSpillage>& bins = results.exits->bins;
    return std::any_of(bins.begin(), bins.end(), [](const BinSpillage& bin) { return bin.spilled.mass > 0.0; });
}

}  // namespace

Dredging dredging_of(const Results& results, const RunData& run) {
    const Production& window = results.fed->production;
    const OperatingPoint& point = run.operating_point;
    const double duration = window.to - window.from;

    Dredging dredging;
    dredging.layer_share = run.feed ? run.feed->left_share : 0.0;
    dredging.waiting_time = results.fed->owed_share * point.revolution_s();
    follow_delivered(run.rock->events, window, dredging);
    dredging.ways_out = ways_out_of(results);

    const double of_soil = (1.0 - dredging.layer_share) * window.fed / point.rock_share;  // cut, rock and fines [kg]
    dredging.fines = of_soil * (1.0 - point.rock_share);
    if (dredging.fines == 0.0) dredging.delivered_fines = 0.0;
    if (dredging.fines > 0.0 && results.mixing) dredging.delivered_fines = (1.0 - results.mixing->well_mixed_spillage) * dredging.fines;
    set_mixture(window, run, dredging);

    const double fed = window.fed + dredging.fines;
    if (window.is_steady && results.mixing)
        dredging.spillage_with_fines = (window.undelivered * window.fed + results.mixing->well_mixed_spillage * dredging.fines) / fed;
    if (!(point.in_situ_density > 0.0)) return dredging;
    dredging.cut_in_situ = of_soil / duration / point.in_situ_density;
    dredging.fed_in_situ = fed / duration / point.in_situ_density;
    if (dredging.delivered_fines)
        dredging.delivered_in_situ = (window.delivered + *dredging.delivered_fines) / duration / point.in_situ_density;
    if (window.is_steady && point.swing_speed > 0.0 && point.step > 0.0) {
        const double left = window.undelivered * window.fed / duration / point.in_situ_density * point.bulking / point.swing_speed;
        dredging.spill_layer = left / point.step;
        if (run.feed) dredging.next_layer = layer_for_the_next_swing(left, point.step, *run.feed);
    }
    if (point.specific_energy) dredging.cutting_power = *point.specific_energy * *dredging.cut_in_situ;
    if (!dredging.delivered_in_situ || !(*dredging.delivered_in_situ > 0.0)) return dredging;
    if (results.rotor.power) dredging.energy = results.rotor.power->mean / *dredging.delivered_in_situ;
    if (dredging.cutting_power) dredging.cutting_energy = *dredging.cutting_power / *dredging.delivered_in_situ;
    return dredging;
}

std::vector<std::string> outside_usual_practice(const Results& results, const RunData& run) {
    const OperatingPoint& point = run.operating_point;
    if (!point.has_bank && !point.fed_by_cutting) return {};
    const double diameter = 2.0 * run.contour.ring_radius();
    std::map<std::string, double> values{{at_work::k_ring_diameter, diameter},
                                         {at_work::k_rotor_speed, point.speed_rpm},
                                         {at_work::k_tip_speed, point.angular_speed() * run.tip_radius()},
                                         {at_work::k_ladder, point.inclination_deg},
                                         {at_work::k_mouth_speed, results.delivery.pipe_velocity}};
    const auto add_given = [&](const char* key, double value) {
        if (value > 0.0) values[key] = value;
    };
    add_given(at_work::k_swing_speed, 60.0 * point.swing_speed);
    add_given(at_work::k_step, point.step);
    add_given(at_work::k_cut_height, point.cut_height / diameter);
    if (results.fed && results.fed->production.is_steady) {
        values[at_work::k_spillage] = 100.0 * results.fed->production.undelivered;
        if (results.dredging) add_given(at_work::k_mixture_density, results.dredging->mixture_density.value_or(0.0));
    }
    return outside_usual_ranges(values, point.length_ratio);
}

std::string limits_text(const Results& results) {
    if (!results.dredging) return "";
    const std::optional<WaysOut>& ways = results.dredging->ways_out;
    std::string sentence = "What limits: ";
    if (results.fed->is_full) sentence += fullness_text(*results.fed);
    if (!ways && !has_spilled(results)) return sentence + (results.fed->is_full ? "." : "nothing was spilled.");
    if (results.fed->is_full) sentence += "; ";
    if (!ways) return sentence + "which way rock leaves is not known, for want of the mean flow through the head's contour.";
    sentence += fmt::format(
        "of the rock that left the head outside the mouth {} went through bins along the axis where the water flows outwards in the mean "
        "around the head (outflow), {} through bins where it flows inwards in that mean (it fell through, was thrown out, or went with an "
        "outflow on one side)",
        text::percent(ways->with_outflow), text::percent(ways->against_inflow));
    if (ways->by_cutting) sentence += fmt::format("; {} had never been taken in (lost in cutting)", cause_text(*ways));
    if (results.mixing)
        sentence += fmt::format(". Neutral rock, well mixed, would spill {}", text::percent(results.mixing->well_mixed_spillage));
    return sentence + ".";
}

}  // namespace cutterflow::postproc
