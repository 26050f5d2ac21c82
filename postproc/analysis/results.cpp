#include "postproc/analysis/results.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/statistics/sample.hpp"
#include "postproc/analysis/dredging.hpp"
#include "postproc/analysis/not_modelled.hpp"
#include "postproc/analysis/steel/steel_work.hpp"

namespace cutterflow::postproc {
namespace {

using nlohmann::json;

/// Time steps do not fall on the mark: a twentieth of a passing more or less still counts as whole.
constexpr double k_passing_slack = 0.05;

/// Time between the passing of two blades [s].
double blade_period(const RunData& run) {
    return run.operating_point.revolution_s() / run.blades;
}

std::vector<BinOutflow> average_outflow(const RunData& run) {
    std::vector<BinOutflow> outflow;
    if (run.outflow.empty()) return outflow;
    const std::vector<double>& times = run.outflow.number("time_s");
    double start = run.operating_point.outflow_start, end = times.back();
    if (run.flow) {  // as the recording ends, before a coupled run's own rock moves the water
        start = run.flow->end;
        end = start + (1.0 + k_passing_slack) * blade_period(run);
    }
    for (const geometry::AxialBin& bin : run.bins) {
        outflow.push_back({bin, time_average(times, run.outflow.number(bin.name), start, end, blade_period(run)), {}});
        if (!run.outflow_flux.empty())
            outflow.back().flux =
                time_average(run.outflow_flux.number("time_s"), run.outflow_flux.number(bin.name), start, end, blade_period(run));
    }
    return outflow;
}

Mixing mixing_of(double outflow, double discharge) {
    const double q = outflow / discharge;
    return {q, q / (1.0 + q), {}};
}

/// Of all bins together. \return none when a bin has no mean flux
std::optional<Mixing> mixing_of_fluxes(double discharge, const std::vector<BinOutflow>& outflow) {
    double out = 0.0, sum = 0.0;
    for (const BinOutflow& item : outflow) {
        if (!item.flux) return std::nullopt;
        out += std::max(0.0, item.flux->mean);
        sum += item.flux->mean;
    }
    Mixing mixing = mixing_of(out, discharge);
    mixing.balance_error = std::abs(sum + discharge) / discharge;
    return mixing;
}

/// Of the bins beside the head, from the gap to the hub: below it the flow across the contour is not radial.
std::optional<Mixing> mixing_of_radial_velocities(const RunData& run, const std::vector<BinOutflow>& outflow) {
    constexpr int slices = 20;  // of a bin, over which the contour's radius is summed
    double out = 0.0;
    for (const BinOutflow& item : outflow) {
        if (!std::isfinite(item.bin.z_min)) continue;
        if (!item.radial_velocity) return std::nullopt;
        const double slice = (item.bin.z_max - item.bin.z_min) / slices;
        double area = 0.0;
        for (int i = 0; i < slices; ++i) area += 2.0 * k_pi * run.contour.radius_at(item.bin.z_min + (i + 0.5) * slice) * slice;
        out += std::max(0.0, item.radial_velocity->mean) * area;
    }
    return mixing_of(out, run.operating_point.discharge);
}

std::optional<Mixing> mixing_of(const RunData& run, const std::vector<BinOutflow>& outflow) {
    if (outflow.empty()) return std::nullopt;
    return run.outflow_flux.empty() ? mixing_of_radial_velocities(run, outflow) : mixing_of_fluxes(run.operating_point.discharge, outflow);
}

std::vector<double> sum_of(const Table& table, const std::vector<const char*>& columns) {
    std::vector<double> sum(table.rows(), 0.0);
    for (const char* column : columns) {
        const std::vector<double>& values = table.number(column);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += values[i];
    }
    return sum;
}

/// Over whole revolutions, or passings of a blade, from `start` to `last` [s] at most.
RotorLoads average_loads(const RunData& run, double start, double last) {
    RotorLoads rotor;
    const std::vector<double>& times = run.loads.number("time_s");
    rotor.revolutions = std::abs(run.loads.number("rotor_angle_rad").back()) / (2.0 * k_pi);
    double passings = std::max(0.0, std::floor((last - start) / blade_period(run) + k_passing_slack));
    if (passings > run.blades) passings = run.blades * std::floor(passings / run.blades);
    rotor.averaged_revolutions = passings / run.blades;
    if (passings == 0.0) return rotor;
    const double end = start + passings * blade_period(run);
    std::vector<double> torque_flow = run.loads.number("torque_pressure_n_m");
    const std::vector<double>& viscous = run.loads.number("torque_viscous_n_m");
    for (std::size_t i = 0; i < torque_flow.size(); ++i) torque_flow[i] += viscous[i];
    rotor.torque_flow = time_average(times, torque_flow, start, end, blade_period(run));
    rotor.torque_rock = time_average(times, run.loads.number("torque_rock_n_m"), start, end, blade_period(run));
    rotor.power = time_average(times, run.loads.number("power_w"), start, end, blade_period(run));
    return rotor;
}

/// In the window of its production where a head is fed all the time, else from the first rock on.
RotorLoads loads_of_run(const RunData& run, const Results& results) {
    if (results.fed) return average_loads(run, results.fed->production.from, results.fed->production.to);
    return average_loads(run, results.spillage ? results.spillage->feed_start : run.operating_point.outflow_start, results.end_time);
}

/// The recorded flow's own torque; what rock does to the rotor, and with it the power of the drive, is not known.
RotorLoads loads_of_replay(const RunData& run, double end_time) {
    RotorLoads rotor = average_loads(run, run.flow->start, run.flow->end);
    rotor.revolutions = end_time / run.operating_point.revolution_s();
    rotor.torque_rock.reset();
    rotor.power.reset();
    return rotor;
}

/// In the window of its production where a head is fed all the time, else from the first rock on.
LastExits exits_of_run(const Results& results, const RunData& run) {
    const auto between = [&](double from, double to, double supplied) {
        return last_exits_of(run.rock->events, run.bins, run.operating_point, from, to, supplied);
    };
    if (results.fed) return between(results.fed->production.from, results.fed->production.to, results.fed->production.fed);
    const Fates& fates = results.spillage->fates;
    return between(results.spillage->feed_start, fates.time, fates.placed.mass);
}

/// Concentration and density since the first rock; of a head that is fed all the time in the window of its production.
Delivery compute_delivery(const OperatingPoint& point, const Results& results) {
    Delivery delivery;
    delivery.pipe_velocity = point.discharge / (k_pi * point.mouth_radius * point.mouth_radius);
    if (results.dredging) {
        delivery.concentration = results.dredging->concentration;
        delivery.mixture_density = results.dredging->mixture_density;
    }
    const std::optional<Spillage>& spillage = results.spillage;
    if (!spillage || point.fed_by_cutting) return delivery;
    const double duration = spillage->fates.time - spillage->feed_start;
    if (!(duration > 0.0)) return delivery;
    const double concentration = spillage->sucked_volume / (point.discharge * duration);
    const double mass_rate = spillage->fates.sucked_up.mass / (point.discharge * duration);  // per volume of mixture
    delivery.concentration = concentration;
    delivery.mixture_density = point.fluid_density * (1.0 - concentration) + mass_rate;
    return delivery;
}

std::optional<double> largest_magnitude(const std::vector<double>& values) {
    std::optional<double> largest;
    for (const double value : values) {
        if (!std::isnan(value)) largest = std::max(largest.value_or(0.0), std::abs(value));
    }
    return largest;
}

/// In the middle of the steps with rock: contacts are no part of a step's exchange, so that a hit makes single values large.
std::optional<double> median_carried(const Table& balance) {
    std::vector<double> values;
    for (std::size_t i = 0; i < balance.rows(); ++i) {
        const double carried = balance.number("momentum_carried")[i];
        if (balance.number("rocks")[i] > 0.0 && !std::isnan(carried)) values.push_back(carried);
    }
    if (values.empty()) return std::nullopt;
    return median(std::move(values));
}

Conservation worst_balance(const Table& balance, bool with_rock) {
    Conservation worst;
    worst.flow_balance = largest_magnitude(balance.number("flow_balance_error"));
    worst.interface_imbalance = largest_magnitude(balance.number("interface_imbalance"));
    worst.interface_mismatch = largest_magnitude(balance.number("interface_mismatch"));
    worst.domain_surplus = largest_magnitude(balance.number("domain_surplus"));
    worst.clipped_cells = largest_magnitude(balance.number("clipped_cells"));
    if (!with_rock) return worst;
    worst.overfull_cells = largest_magnitude(balance.number("overfull_cells"));
    worst.solid_volume = largest_magnitude(balance.number("solid_volume_error"));
    worst.momentum = largest_magnitude(balance.number("momentum_error"));
    worst.momentum_interface = largest_magnitude(balance.number("momentum_interface_error"));
    worst.momentum_carried = largest_magnitude(balance.number("momentum_carried"));
    worst.momentum_carried_median = median_carried(balance);
    const auto largest_if_told = [&](const char* column) {
        return balance.has(column) ? largest_magnitude(balance.number(column)) : std::nullopt;
    };
    worst.swept_limited_cells = largest_if_told(k_swept_limited_cells);
    worst.wake_limited_rocks = largest_if_told(k_wake_limited_rocks);
    worst.hidden_rocks = largest_if_told(k_hidden_rocks);
    worst.cramped_rocks = largest_if_told(k_cramped_rocks);
    return worst;
}

double sum(const std::vector<double>& values) {
    double total = 0.0;
    for (const double value : values) total += value;
    return total;
}

std::optional<int> whole_number(const json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number()) return std::nullopt;
    return found->get<int>();
}

/// prediction.json has rates with and without rock, applied to the simulated time. While the flow develops steps are longer, and as many
/// times fewer and cheaper.
std::optional<PredictedCost> predicted_cost(const json& prediction, double end_time, double revolutions) {
    if (prediction.empty()) return std::nullopt;
    const double flow_time = std::min(end_time, prediction.at("first_release_s").get<double>());
    const double development = std::min(flow_time, prediction.value("development_end_s", 0.0));
    const double by_steps = flow_time - development + development / prediction.value("development_step_ratio", 1.0);
    const double rock_time = end_time - flow_time, turns = end_time > 0.0 ? revolutions / end_time : 0.0;
    const double core_hours = turns * (by_steps * prediction.at("core_hours_per_revolution").get<double>() +
                                       rock_time * prediction.at("core_hours_per_revolution_with_rock").get<double>());
    return PredictedCost{
        prediction.at("cells").get<double>(),
        by_steps / prediction.at("time_step_s").get<double>() + rock_time / prediction.at("time_step_with_rock_s").get<double>(),
        3600.0 * core_hours};
}

Cost sum_cost(const RunData& run, double end_time, double revolutions) {
    Cost cost;
    cost.wall_s = sum(run.cost.number("step_s"));
    cost.steps = run.cost.rows();
    cost.ranks = whole_number(run.cost_summary, "ranks");
    cost.cells = whole_number(run.mesh, "cells");
    if (!cost.cells) cost.cells = whole_number(run.cost_summary, "cells");
    cost.core_s = run.core_s;
    cost.predicted = predicted_cost(run.prediction, end_time, revolutions);
    if (cost.core_s && revolutions > 0.0) cost.core_s_per_revolution = *cost.core_s / revolutions;
    for (const char* part : {"fluid", "mesh_motion", "mapping", "dem", "output"}) {
        cost.share[part] = cost.wall_s > 0.0 ? sum(run.cost.number(std::string(part) + "_s")) / cost.wall_s : 0.0;
    }
    return cost;
}

template <typename T>
json or_null(const std::optional<T>& value) {
    return value ? json(*value) : json(nullptr);
}

json mean_or_null(const std::optional<TimeAverage>& average) {
    return average ? json(average->mean) : json(nullptr);
}

json error_or_null(const std::optional<TimeAverage>& average) {
    return average ? or_null(average->standard_error) : json(nullptr);
}

json amount_json(const RockAmount& amount) {
    return {{"count", amount.count}, {"mass_kg", amount.mass}};
}

json fates_json(const Fates& fates) {
    return {{"sucked_up", amount_json(fates.sucked_up)},
            {"spilled", amount_json(fates.spilled)},
            {"in_cutter", amount_json(fates.in_cutter)},
            {"never_entered", amount_json(fates.never_entered)}};
}

json ratios_json(const SpillageRatios& ratios) {
    json object{{"ratio", or_null(ratios.ratio)},
                {"ratio_min", or_null(ratios.ratio_min)},
                {"ratio_max", or_null(ratios.ratio_max)},
                {"undecided", or_null(ratios.undecided)}};
    if (!ratios.reason.empty()) object["ratio_reason"] = ratios.reason;
    return object;
}

json series_json(const std::vector<RatiosAt>& series, const char* key) {
    json list = json::array();
    for (const RatiosAt& point : series) {
        json object = ratios_json(point.ratios);
        object[key] = point.since_feed;
        object["time_s"] = point.time;
        object["fates"] = fates_json(point.fates);
        list.push_back(object);
    }
    return list;
}

json fed_json(const FedHead& head, const Dredging& dredging) {
    const Production& production = head.production;
    const double duration = production.to - production.from;
    json object{{"start_s", or_null(production.start)},
                {"window_start_s", production.from},
                {"window_end_s", production.to},
                {"fed_kg_s", production.fed / duration},
                {"delivered_kg_s", production.delivered / duration},
                {"delivered_in_situ_m3_h", dredging.delivered_in_situ ? json(3600.0 * *dredging.delivered_in_situ) : json(nullptr)},
                {"share", production.delivered / production.fed},
                {"share_half_interval", production.share ? json(production.share->half_interval) : json(nullptr)},
                {"hold_up_kg", production.held},
                {"hold_up_change_share", production.held_change / production.fed},
                {"is_steady", production.is_steady},
                {"spillage", production.is_steady ? json(production.undelivered) : json(nullptr)},
                {"spillage_min", production.spillage_min},
                {"spillage_max", production.spillage_max},
                {"head_is_full", head.is_full},
                {"owed_over_cut_per_revolution", head.owed_share}};
    if (!production.is_steady) object["spillage_reason"] = "hold-up still changes: only the bounds are known";
    return object;
}

json dredging_json(const Dredging& dredging, const Losses& losses) {
    json object{{"cut_in_situ_m3_h", dredging.cut_in_situ ? json(3600.0 * *dredging.cut_in_situ) : json(nullptr)},
                {"left_by_swing_before_share", dredging.layer_share},
                {"spilled_mixing_share", losses.mixing},
                {"spilled_cutting_share", losses.cutting},
                {"left_behind_share", losses.left_behind},
                {"left_behind_cutting_share", or_null(losses.left_behind_cutting)},
                {"concentration", or_null(dredging.concentration)},
                {"mixture_density_kg_m3", or_null(dredging.mixture_density)},
                {"spill_layer_m", or_null(dredging.spill_layer)},
                {"next_layer_m", or_null(dredging.next_layer)},
                {"cutting_power_w", or_null(dredging.cutting_power)},
                {"energy_j_m3", or_null(dredging.energy)},
                {"cutting_energy_j_m3", or_null(dredging.cutting_energy)},
                {"spillage_with_fines", or_null(dredging.spillage_with_fines)},
                {"residence_time_s", or_null(dredging.residence_time)},
                {"waiting_time_s", dredging.waiting_time},
                {"largest_delivered_m", or_null(dredging.largest_delivered)}};
    object["ways_out"] = nullptr;
    if (const auto& ways = dredging.ways_out)
        object["ways_out"] = {{"with_outflow_share", ways->with_outflow},
                              {"against_inflow_share", ways->against_inflow},
                              {"by_cutting_share", or_null(ways->by_cutting)},
                              {"cause_known_share", ways->cause_known}};
    return object;
}

json spillage_json(const Spillage& spillage, const std::vector<BinOutflow>& outflow) {
    json object = ratios_json(spillage.ratios);
    object["replicates"] = "no replicate";
    object["bins"] = json::array();
    for (std::size_t i = 0; i < spillage.bins.size(); ++i) {
        json bin = axial_bin_json(spillage.bins[i].bin);
        bin.update(amount_json(spillage.bins[i].spilled));
        bin["radial_velocity_mean_m_s"] = outflow.empty() ? json(nullptr) : mean_or_null(outflow[i].radial_velocity);
        object["bins"].push_back(bin);
    }
    object["time_s"] = spillage.fates.time;
    object["feed_start_s"] = spillage.feed_start;
    object["at_equal_revolutions"] = series_json(spillage.at_revolutions, "revolutions_since_feed");
    object["at_equal_time"] = series_json(spillage.at_seconds, "seconds_since_feed");
    return object;
}

json exits_json(const LastExits& exits) {
    json object{{"window_start_s", exits.from}, {"window_end_s", exits.to}, {"supplied_kg", exits.supplied}, {"bins", json::array()}};
    for (const BinSpillage& bin : exits.bins) {
        object["bins"].push_back(amount_json(bin.spilled));
        object["bins"].back()["name"] = bin.bin.name;
    }
    constexpr double width = 360.0 / k_last_exit_sectors;
    object["sectors"] = json::array();
    for (std::size_t s = 0; s < exits.sectors.size(); ++s) {
        object["sectors"].push_back(amount_json(exits.sectors[s]));
        object["sectors"].back()["azimuth_from_deg"] = width * static_cast<double>(s);
        object["sectors"].back()["azimuth_to_deg"] = width * static_cast<double>(s + 1);
    }
    object["quarters"] = nullptr;
    if (const auto& quarters = exits.quarters)
        object["quarters"] = {{"bank_azimuth_deg", quarters->bank_at_90 ? 90 : 270},
                              {"bank_side", amount_json(quarters->bank_side)},
                              {"top", amount_json(quarters->top)},
                              {"trailing_side", amount_json(quarters->trailing_side)},
                              {"bottom", amount_json(quarters->bottom)}};
    return object;
}

json rock_json(const Results& results) {
    const Fates& fates = results.spillage->fates;
    return {{"requested", results.rock_requested},
            {"placed", fates.placed.count},
            {"rejected", results.rock_rejected},
            {"fates", fates_json(fates)}};
}

json outflow_json(const std::vector<BinOutflow>& outflow) {
    json object{{"bins", json::array()}};
    for (const BinOutflow& item : outflow) {
        json bin = axial_bin_json(item.bin);
        bin["radial_velocity_mean_m_s"] = mean_or_null(item.radial_velocity);
        bin["radial_velocity_standard_error_m_s"] = error_or_null(item.radial_velocity);
        bin["flux_mean_m3_s"] = mean_or_null(item.flux);
        object["bins"].push_back(bin);
        if (item.radial_velocity) {
            object["window_start_s"] = item.radial_velocity->start;
            object["window_end_s"] = item.radial_velocity->end;
        }
    }
    return object;
}

/// Predicted over actual, less 1.
json prediction_error(double predicted, std::optional<double> actual) {
    return actual && *actual > 0.0 ? json(predicted / *actual - 1.0) : json();
}

json predicted_json(const Cost& cost) {
    if (!cost.predicted) return {};
    const PredictedCost& predicted = *cost.predicted;
    return {{"cells", predicted.cells},
            {"steps", predicted.steps},
            {"core_s", predicted.core_s},
            {"error",
             {{"cells", prediction_error(predicted.cells, cost.cells ? std::optional<double>(*cost.cells) : std::nullopt)},
              {"steps", prediction_error(predicted.steps, static_cast<double>(cost.steps))},
              {"core_s", prediction_error(predicted.core_s, cost.core_s)}}}};
}

json cost_json(const Cost& cost) {
    return {{"wall_s", cost.wall_s},        {"core_s", or_null(cost.core_s)},
            {"steps", cost.steps},          {"cells", or_null(cost.cells)},
            {"ranks", or_null(cost.ranks)}, {"core_s_per_revolution", or_null(cost.core_s_per_revolution)},
            {"share", cost.share},          {"predicted", predicted_json(cost)}};
}

json rotor_json(const Results& results, const RunData& run) {
    json object{{"speed_rpm", run.operating_point.speed_rpm},
                {"revolutions", results.rotor.revolutions},
                {"torque_flow_mean_n_m", mean_or_null(results.rotor.torque_flow)},
                {"torque_rock_mean_n_m", results.spillage ? mean_or_null(results.rotor.torque_rock) : json(nullptr)},
                {"power_mean_w", mean_or_null(results.rotor.power)},
                {"averaged_revolutions", results.rotor.averaged_revolutions}};
    if (results.rotor.averaged_revolutions == 0.0) object["mean_reason"] = "no blade has passed yet since the start of the window";
    return object;
}

json scale_json(const ScaleNumbers& scale) {
    return {{"flow_number", scale.flow_number},
            {"froude", scale.froude},
            {"settling_ratio", or_null(scale.settling_ratio)},
            {"size_ratio", or_null(scale.size_ratio)},
            {"settling_number", or_null(scale.settling_number)},
            {"fall_through", or_null(scale.fall_through)},
            {"swing_over_rotor_speed", or_null(scale.swing_ratio)},
            {"bite_over_blade_depth", or_null(scale.bite_ratio)},
            {"cut_over_discharge", or_null(scale.cut_ratio)},
            {"blade_angle_less_ladder_deg", or_null(scale.blade_angle_less_ladder)},
            {"friction_rock", or_null(scale.friction_rock)},
            {"friction_steel", or_null(scale.friction_steel)},
            {"friction_soil", or_null(scale.friction_soil)}};
}

json recorded_flow_json(const RecordedFlow& flow) {
    return {{"run", flow.run.string()}, {"start_s", flow.start}, {"end_s", flow.end}, {"change", or_null(flow.change)}};
}

json not_modelled_json(const RunData& run) {
    json list = json::array();
    for (const NotModelled& item : not_modelled(scope_of(run))) list.push_back(item.name);
    return list;
}

json versions_json(const RunData& run) {
    json versions = run.manifest.value("versions", json::object());
    versions.update(run.cost_summary.value("versions", json::object()));
    return versions;
}

}  // namespace

std::optional<FedHead> fed_head_of(const Table& ledger, double revolution, double blade_period) {
    constexpr double full_share = 0.05;  // of what a blade passing cuts
    const ProductionSeries series{ledger.number("time_s"), ledger.number("fed_kg"), ledger.number("delivered_kg"),
                                  sum_of(ledger, {"spilled_mixing_kg", "spilled_cutting_kg", "left_behind_kg"}),
                                  sum_of(ledger, {"owed_kg", "in_head_kg", "on_bed_kg"})};
    const std::optional<Production> production = production_of(series, revolution);
    if (!production) return std::nullopt;
    const double rate = production->fed / (production->to - production->from);
    const double longest = longest_time_above(series.time, ledger.number("owed_kg"), full_share * rate * blade_period);
    const auto lost = [&](const char* column) {
        return gain_over(series.time, ledger.number(column), production->from, production->to) / production->fed;
    };
    Losses losses{lost("spilled_mixing_kg"), lost("spilled_cutting_kg"), lost("left_behind_kg"), {}};
    if (ledger.has(k_left_behind_cutting)) losses.left_behind_cutting = lost(k_left_behind_cutting);
    const double owed = mean_over(series.time, ledger.number("owed_kg"), production->from, production->to);
    return FedHead{*production, losses, longest >= revolution, owed / (rate * revolution)};
}

Results compute_results(const RunData& run) {
    Results results;
    results.finished = run.finished;
    results.end_time = run.flow ? run.rock->fates.number("time_s").back() : run.balance.number("time_s").back();
    if (run.rock) {
        results.spillage = evaluate_spillage(run.rock->fates, run.rock->events, run.bins, run.operating_point.revolution_s(), run.finished);
        // Rock from a cut face that finds no place waits for another.
        const std::int64_t rejected_in_run = run.operating_point.fed_by_cutting ? 0 : static_cast<std::int64_t>(run.rock->rejected_in_run);
        results.rock_requested = run.feed ? run.feed->requested : results.spillage->fates.placed.count + rejected_in_run;
        results.rock_rejected = (run.feed ? run.feed->rejected : 0) + rejected_in_run;
    }
    if (results.spillage && run.operating_point.fed_by_cutting) {  // a ratio without its hold-up would mislead
        results.spillage->ratios = {{}, {}, {}, {}, "rock comes all the time: production has its spillage and its hold-up"};
        results.spillage->at_revolutions.clear();
        results.spillage->at_seconds.clear();
    }
    results.outflow = average_outflow(run);
    results.mixing = mixing_of(run, results.outflow);
    if (run.operating_point.fed_by_cutting && run.rock && !run.rock->ledger.empty())
        results.fed = fed_head_of(run.rock->ledger, run.operating_point.revolution_s(), blade_period(run));
    results.rotor = run.flow ? loads_of_replay(run, results.end_time) : loads_of_run(run, results);
    if (results.spillage) results.exits = exits_of_run(results, run);
    if (results.fed) results.dredging = dredging_of(results, run);
    results.delivery = compute_delivery(run.operating_point, results);
    results.steel = steel_work_of(results, run);
    results.outside_usual_practice = outside_usual_practice(results, run);
    results.scale = scale_numbers_of(run, results.dredging ? results.dredging->cut_in_situ : std::nullopt);
    results.conservation = worst_balance(run.balance, results.spillage && !run.flow);
    const double before_rock = run.flow ? results.spillage->feed_start / run.operating_point.revolution_s() : 0.0;
    results.cost = sum_cost(run, results.end_time, results.rotor.revolutions - before_rock);
    return results;
}

json axial_bin_json(const geometry::AxialBin& bin) {
    return {{"name", bin.name}, {"z_min_m", std::isfinite(bin.z_min) ? json(bin.z_min) : json(nullptr)}, {"z_max_m", bin.z_max}};
}

json results_json(const Results& results, const RunData& run) {
    json document{{"schema", k_results_schema}};
    document["run"] = {{"name", run.operating_point.study_name}, {"finished", results.finished}, {"end_time_s", results.end_time}};
    document["warnings"] = run.warnings;
    document["rock"] = results.spillage ? rock_json(results) : json(nullptr);
    document["spillage"] = results.spillage ? spillage_json(*results.spillage, results.outflow) : json(nullptr);
    document["exits"] = results.exits ? exits_json(*results.exits) : json(nullptr);
    document["outflow"] = results.outflow.empty() ? json(nullptr) : outflow_json(results.outflow);
    document["conservation"] = {{"solid_volume_max_error", or_null(results.conservation.solid_volume)},
                                {"momentum_max_error", or_null(results.conservation.momentum)},
                                {"momentum_interface_max_error", or_null(results.conservation.momentum_interface)},
                                {"momentum_carried_max", or_null(results.conservation.momentum_carried)},
                                {"momentum_carried_median", or_null(results.conservation.momentum_carried_median)},
                                {"flow_balance_max_error", or_null(results.conservation.flow_balance)},
                                {"interface_imbalance_max", or_null(results.conservation.interface_imbalance)},
                                {"interface_mismatch_max", or_null(results.conservation.interface_mismatch)},
                                {"domain_surplus_max", or_null(results.conservation.domain_surplus)},
                                {"overfull_cells_max", or_null(results.conservation.overfull_cells)},
                                {"clipped_cells_max", or_null(results.conservation.clipped_cells)},
                                {"swept_limited_cells_max", or_null(results.conservation.swept_limited_cells)},
                                {"wake_limited_rocks_max", or_null(results.conservation.wake_limited_rocks)},
                                {"hidden_rocks_max", or_null(results.conservation.hidden_rocks)},
                                {"cramped_rocks_max", or_null(results.conservation.cramped_rocks)}};
    document["rotor"] = rotor_json(results, run);
    const auto of_mixing = [&](double Mixing::*member) { return results.mixing ? json((*results.mixing).*member) : json(nullptr); };
    document["mixing"] = {{"outflow_over_discharge", of_mixing(&Mixing::outflow_over_discharge)},
                          {"well_mixed_spillage", of_mixing(&Mixing::well_mixed_spillage)},
                          {"balance_error", results.mixing ? or_null(results.mixing->balance_error) : json(nullptr)}};
    document["production"] = results.fed ? fed_json(*results.fed, *results.dredging) : json(nullptr);
    document["dredging"] = results.dredging ? dredging_json(*results.dredging, results.fed->losses) : json(nullptr);
    document["steel_work"] = steel_work_json(results.steel);
    document["outside_usual_practice"] = results.outside_usual_practice;
    document["recorded_flow"] = run.flow ? recorded_flow_json(*run.flow) : json(nullptr);
    document["operation"] = {{"pipe_velocity_m_s", results.delivery.pipe_velocity},
                             {"delivered_concentration", or_null(results.delivery.concentration)},
                             {"mixture_density_kg_m3", or_null(results.delivery.mixture_density)}};
    document["scale"] = scale_json(results.scale);
    document["cost"] = cost_json(results.cost);
    document["models"] = run.cost_summary.value("models", json::array());
    document["not_modelled"] = not_modelled_json(run);
    document["mesh"] = run.mesh;
    document["versions"] = versions_json(run);
    return document;
}

}  // namespace cutterflow::postproc
