#include "postproc/analysis/not_modelled.hpp"

#include <map>

namespace cutterflow::postproc {

Scope scope_of(const RunData& run) {
    const OperatingPoint& point = run.operating_point;
    return {run.rock.has_value(), point.fed_by_cutting,    point.has_bank,
            point.hauls,          point.spill_layer > 0.0, run.flow ? Replays::all : Replays::none};
}

std::vector<NotModelled> not_modelled(const Scope& scope) {
    std::vector<NotModelled> table{
        {"cutting process",
         scope.fed_by_cutting
             ? "rock comes loose from the cut face ahead of the blades, as fast as the head swings; forces of cutting are not computed"
             : "rock is released loose between the blades; spillage by cutting (rock never taken into the head) is not counted"},
        {"bank and breach", scope.feels_bank
                                ? "the bank is as the swings before left it; it does not breach"
                                : "no face confines the flow on the cut side; the open side lets rock out that a bank would hold back"},
        {"bed", scope.fed_by_layer
                    ? "what the swing before left comes in as a level layer of given thickness; it is not the rock that this run leaves"
                : scope.feels_bank ? "rock that is left on what the swings cut stays there; the next swing does not pick it up"
                                   : "the bed is a flat wall; spilled rock stays spilled and is not picked up again by a later cut"},
        {"hauling (swing motion)",
         scope.hauls ? "the head travels along a straight line at constant speed; the swing's arc and its ends are left out"
                     : "the head turns but does not travel; rock is not swept into the head by the swing"},
        {"pick points and adapters",
         "water meets what the cutter's surface file contains; beside a bank rock does not pass between picks that it lacks "
         "(bank.pick_length_m), without a bank it does"},
        {"lift and rock spin forces",
         "no rotation lift and no fluid torque on rock; shear lift only with closures.lift, whose source is valid for grains"},
        {"rock shape and breakage", "rocks are spheres or rigid clumps of them that do not break; sizes are those of the feed"},
        {"unresolved wakes", "rock is a smoothed body force on the flow; the wake of a single rock is only in the drag law"},
        {"pump and pipeline", "the discharge is imposed; it does not drop when the mixture becomes heavier"},
    };
    if (!scope.fed_by_cutting)
        table.insert(table.begin() + 4, {"continuous feed",
                                         "one batch of rock; production and spillage do not reach a steady state as in continuous "
                                         "dredging"});
    if (scope.replays != Replays::none)
        table.insert(table.begin(), {"reaction of rock on the water",
                                     "of a replay rock goes through a recorded flow and does not change it; torque and power with rock "
                                     "are not known. Coupled runs of the same rock tell what that leaves out (cutterflow replay)"});
    return table;
}

namespace {

const std::string& sentence_of_scene(const Scope& scope) {
    static const std::string cutting =
        "Rock comes from the cut face as fast as the head swings, beside a bank that stands still. Hauling is not modelled, nor what a "
        "later swing picks up of the bed.";
    static const std::string hauled =
        "Rock comes from the cut face as fast as the head swings, and bank, bed and water move past it. Forces of cutting, a bank that "
        "breaches and the arc of the swing are not modelled.";
    static const std::string rock =
        "This is spillage by mixing of loose rock in a turning head with imposed discharge: cutting, bank, hauling and continuous feed are "
        "not modelled, so there is no optimum over speed here as there is in practice, and this report names no best speed.";
    static const std::string rock_at_bank =
        "This is spillage by mixing of loose rock in a turning head with imposed discharge beside a bank that stands still: cutting, "
        "hauling and continuous feed are not modelled, so this report names no best speed.";
    static const std::string hauled_rock =
        "This is spillage by mixing of loose rock in a turning head with imposed discharge that travels along its bank: cutting and "
        "continuous feed are not modelled, so this report names no best speed.";
    static const std::string flow =
        "This is the flow of clear water through a turning head with imposed discharge, without bank, hauling and rock; it shows where "
        "water leaves the head, not how much rock would, and this report names no best speed.";
    static const std::string flow_at_bank =
        "This is the flow of clear water through a turning head with imposed discharge beside a bank that stands still, without hauling "
        "and rock; it shows where water leaves the head, not how much rock would, and this report names no best speed.";
    static const std::string hauled_flow =
        "This is the flow of clear water through a turning head with imposed discharge that travels along its bank, without rock; it shows "
        "where water leaves the head, not how much rock would, and this report names no best speed.";
    if (!scope.feels_bank) return scope.with_rock ? rock : flow;
    if (!scope.with_rock) return scope.hauls ? hauled_flow : flow_at_bank;
    if (scope.fed_by_cutting) return scope.hauls ? hauled : cutting;
    return scope.hauls ? hauled_rock : rock_at_bank;
}

}  // namespace

std::string scope_sentence(const Scope& scope) {
    const std::map<Replays, std::string> of_replays{
        {Replays::none, ""},
        {Replays::some, "In settings named replayed rock goes through a recorded flow and does not change it. "},
        {Replays::all, scope.of_one_run ? "This is a replay: rock goes through a recorded flow and does not change it. "
                                        : "These are replays: rock goes through recorded flows and does not change them. "}};
    return of_replays.at(scope.replays) + sentence_of_scene(scope) +
           (scope.of_one_run && scope.fed_by_cutting && scope.feels_bank ? " One run names no best speed." : "");
}

}  // namespace cutterflow::postproc
