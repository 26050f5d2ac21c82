#include "solver/ports/setting_table.hpp"

#include <cstdint>
#include <type_traits>
#include <utility>

#include "geometry/base/parameters/parameter_row.hpp"
#include "solver/physics/catalogue.hpp"
#include "solver/physics/contact.hpp"
#include "solver/ports/dem_settings.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {
namespace {

using physics::ClosureKind;

/// Type with which a ParameterValue holds a member's type.
template <class T>
using Stored = std::conditional_t<std::is_same_v<std::decay_t<T>, int>, std::int64_t, std::decay_t<T>>;

/// A row and its member. The default is the one that the struct gives the member.
template <class Settings>
class Rows {
public:
    Rows& add(typename Setting<Settings>::Member member, Parameter parameter) {
        static const Settings defaults;
        const Setting<Settings> setting{parameter, member};
        parameter.default_value = setting.value_in(defaults);
        table_.push_back({std::move(parameter), member});
        return *this;
    }
    /// Has no default.
    Rows& require(typename Setting<Settings>::Member member, Parameter parameter) {
        table_.push_back({std::move(parameter), member});
        return *this;
    }
    SettingTable<Settings> take() { return std::move(table_); }

private:
    SettingTable<Settings> table_;
};

ParameterRow number(const char* key, const char* unit, const char* help) {
    return {key, ParameterKind::number, unit, help};
}

ParameterRow yes_or_no(const char* key, const char* help) {
    return {key, ParameterKind::boolean, "-", help};
}

ParameterRow closure(const char* key, ClosureKind kind, const char* help) {
    return ParameterRow(key, ParameterKind::choice, "-", help).one_of(physics::closure_choices(kind));
}

SettingTable<KernelSettings> kernel_rows() {
    using S = KernelSettings;
    return Rows<S>()
        .add(&S::map, ParameterRow("map", ParameterKind::choice, "-",
                                   "How rock is laid over cells: by kernels that know distance and steel; as a whole in the cell of its "
                                   "centre; evenly over the cells of a cube. The last two are there for comparison with other programs: "
                                   "they jump from cell to cell and reach through steel. cluster needs a mesh that stands still.")
                          .one_of({k_gaussian_map, k_centroid_map, k_cluster_map})
                          .source("WasserfallCoetzeeMeyer2024"))
        .add(&S::sampling,
             ParameterRow("sampling", ParameterKind::choice, "-",
                          "From where a rock samples the fluid, with map gaussian: with a Gaussian half as wide as that by which it is "
                          "laid, less what it does there itself; or, quadratic, mostly 1.5 to 2.8 kernel widths away, clear of what it "
                          "does to the fluid itself. Beside a mouth or a gap of few kernel widths the second sees far too little.")
                 .one_of({k_gaussian_sampling, k_quadratic_sampling})
                 .source("NieuwboerVanRheeKeetels2023"))
        .add(
            &S::cluster_size,
            number("clusterSize", "m", "Side of the cubes of map cluster, a cell or more; with that map only.").at_least(0.0).at_most(10.0))
        .add(&S::gamma, number("gamma", "-",
                               "Width of the Gaussian kernel over the rock's diameter. Narrower than half a rock, the fluid would see "
                               "more solid than there is room for.")
                            .at_least(0.5)
                            .at_most(5.0))
        .add(
            &S::min_width_in_cells,
            number("minWidthInCells", "-", "Smallest width of the kernel over the local cell size. A kernel narrower than a cell is noise.")
                .at_least(1.0)
                .at_most(5.0))
        .add(
            &S::max_solid_fraction,
            number("maxSolidFraction", "-", "Solid fraction above which volume is moved to neighbouring cells.").at_least(0.1).at_most(0.9))
        .take();
}

SettingTable<ClosureSettings> closure_rows() {
    using S = ClosureSettings;
    return Rows<S>()
        .add(&S::drag, closure("drag", ClosureKind::drag,
                               "Drag law of a rock. gidaspow and koch_hill hold the effect of other rocks themselves: they need "
                               "hindrance none."))
        .add(&S::hindrance, closure("hindrance", ClosureKind::hindrance, "How other rocks raise the drag."))
        .add(&S::added_mass, number("addedMass", "-", "Added-mass coefficient; 0.5 is a sphere's.").at_least(0.0).at_most(2.0))
        .add(&S::drag_modifier, number("dragModifier", "-", "Factor on the drag force.").above(0.0).at_most(10.0))
        .add(&S::sphericity, number("sphericity", "-",
                                    "Surface of the sphere of equal volume over that of the rock; haider_levenspiel asks for it, the other "
                                    "drag laws do not.")
                                 .above(0.0)
                                 .at_most(1.0))
        .add(&S::lift, closure("lift", ClosureKind::lift,
                               "Lift on rock in sheared flow. The source of mei holds for grains with Reynolds numbers up to 1."))
        .add(&S::viscous_force, yes_or_no("viscousForce",
                                          "Whether the undisturbed flow's stress on rock counts its viscous part (rho V Du/Dt), or the "
                                          "pressure gradient alone.")
                                    .source("NieuwboerVanRheeKeetels2023"))
        .take();
}

SettingTable<PairSettings> pair_rows() {
    using S = PairSettings;
    return Rows<S>()
        .add(&S::friction, number("friction", "-", "Coefficient of friction.").at_least(0.0).at_most(10.0))
        .add(&S::restitution,
             number("restitution", "-", "Restitution of a dry impact.").at_least(physics::k_smallest_restitution).at_most(1.0))
        .add(&S::rolling_friction,
             number("rollingFriction", "-",
                    "Largest couple against rolling over normal force and rolling radius: the tangent of the slope on "
                    "which a sphere starts to roll. 0: none.")
                 .at_least(0.0)
                 .at_most(10.0)
                 .source("Ai2011"))
        .take();
}

SettingTable<ContactSettings> contact_rows() {
    using S = ContactSettings;
    return Rows<S>()
        .require(&S::youngs_modulus, number("youngsModulus", "Pa",
                                            "Young's modulus of rock and steel in contacts. Soft contacts allow longer steps of the DEM.")
                                         .at_least(1e3)
                                         .at_most(1e12))
        .add(&S::poisson_rock, number("poissonRock", "-", "Poisson's ratio of rock.").at_least(0.0).at_most(0.5))
        .add(&S::poisson_steel, number("poissonSteel", "-", "Poisson's ratio of steel.").at_least(0.0).at_most(0.5))
        .add(&S::rolling_law,
             ParameterRow("rollingLaw", ParameterKind::choice, "-",
                          "What resists rolling: a spring that gives way at the largest couple, so that rock comes to rest, "
                          "or that couple alone.")
                 .one_of({"spring", "constant"})
                 .source("Ai2011"))
        .add(&S::wet_restitution, yes_or_no("wetRestitution", "Whether water damps impacts by their Stokes number.").source("Legendre2006"))
        .add(&S::time_step_fraction,
             number("timeStepFraction", "-", "DEM time step over the smaller of Rayleigh time and Hertz time at the largest impact speed.")
                 .at_least(1e-3)
                 .at_most(0.5))
        .require(&S::max_speed, number("maxSpeed", "m/s", "Impact speed for the Hertz time, the largest that is expected.").above(0.0))
        .take();
}

SettingTable<OutflowSettings> outflow_rows() {
    using S = OutflowSettings;
    return Rows<S>()
        .require(&S::offset,
                 number("offset", "m", "Distance outside the contour at which the radial outflow is sampled.").above(0.0).at_most(100.0))
        .require(&S::start_time,
                 number("startTime", "s", "Time from which the radial outflow, and the velocity at points, is averaged.").at_least(0.0))
        .take();
}

SettingTable<StopSettings> stop_rows() {
    return Rows<StopSettings>()
        .require(
            &StopSettings::undecided,
            number("undecided", "-",
                   "The run ends earlier when the share of rock that is neither spilled nor sucked up is at most this; 0 waits for the "
                   "last rock. Above 0 the run ends sooner where rock is decided sooner, and spilling is quicker than suction: keep 0, "
                   "and the same time in all runs, to compare speeds.")
                .at_least(0.0)
                .at_most(0.99))
        .add(&StopSettings::target_half_width,
             number("targetHalfWidth", "-",
                    "Rock from a cut face: the run ends earlier when production is steady and half its 95 % interval, as a share of what "
                    "was fed, is at most this; 0 goes on to the end.")
                 .at_least(0.0)
                 .at_most(1.0))
        .take();
}

SettingTable<QueueSettings> queue_rows() {
    using S = QueueSettings;
    return Rows<S>()
        .require(&S::interval, number("interval", "s", "Time between packets of rock that comes in.").above(0.0).at_most(1.0))
        .require(&S::retry_interval,
                 number("retryInterval", "s", "Time after which rock that found no place is due again, at its first place.").above(0.0))
        .require(&S::reach,
                 number("reach", "rad", "How far ahead of its place, in the sense of rotation, rock may go in where its place is taken.")
                     .at_least(0.0)
                     .at_most(3.2))
        .take();
}

SettingTable<CalmingSettings> calming_rows() {
    using S = CalmingSettings;
    return Rows<S>()
        .require(&S::speed,
                 number("speed", "m/s", "Root mean square of the velocities of rock from which down rock is slowed down.").above(0.0))
        .require(&S::time, number("time", "s", "Time in which that takes away the share 1 - 1/e of a velocity.").above(0.0))
        .take();
}

SettingTable<SoilSettings> soil_rows() {
    return Rows<SoilSettings>()
        .add(&SoilSettings::permeability,
             number("permeability", "m2", "Permeability of the soil by Darcy's law; sand 1e-11, gravel 1e-8. 0: no water moves in it.")
                 .at_least(0.0)
                 .at_most(1e-3))
        .take();
}

SettingTable<CheckpointSettings> checkpoint_rows() {
    using S = CheckpointSettings;
    return Rows<S>()
        .require(&S::interval,
                 number("interval", "s", "Simulated time between checkpoints, from which a killed run is resumed.").above(0.0))
        .add(&S::keep, ParameterRow("keep", ParameterKind::integer, "-", "Newest checkpoints that stay.").at_least(1.0))
        .take();
}

SettingTable<RecordSettings> record_rows() {
    using S = RecordSettings;
    return Rows<S>()
        .require(&S::start_time, number("startTime", "s", "Time from which the flow is recorded.").at_least(0.0))
        .require(&S::end_time,
                 number("endTime", "s", "Time at which the recording ends: a turn of the rotor after its start, or later.").above(0.0))
        .add(&S::phases,
             ParameterRow("phases", ParameterKind::integer, "-",
                          "Angles at which the flow is kept: over one turn for cells of the rotor, over one passing of a blade for "
                          "the others.")
                 .at_least(2.0)
                 .at_most(720.0))
        .add(&S::blades, ParameterRow("blades", ParameterKind::integer, "-", "Equal blades of the rotor.").at_least(1.0).at_most(100.0))
        .take();
}

}  // namespace

template <class Settings>
ParameterValue Setting<Settings>::value_in(const Settings& settings) const {
    ParameterValue value;
    std::visit([&](auto pointer) { value.emplace<Stored<decltype(settings.*pointer)>>(settings.*pointer); }, member);
    return value;
}

template <class Settings>
void Setting<Settings>::assign(Settings& settings, const ParameterValue& value) const {
    std::visit(
        [&](auto pointer) {
            auto& target = settings.*pointer;
            target = static_cast<std::decay_t<decltype(target)>>(std::get<Stored<decltype(target)>>(value));
        },
        member);
}

template struct Setting<OutflowSettings>;
template struct Setting<StopSettings>;
template struct Setting<QueueSettings>;
template struct Setting<CalmingSettings>;
template struct Setting<SoilSettings>;
template struct Setting<CheckpointSettings>;
template struct Setting<RecordSettings>;
template struct Setting<KernelSettings>;
template struct Setting<ClosureSettings>;
template struct Setting<PairSettings>;
template struct Setting<ContactSettings>;

template <>
const SettingTable<OutflowSettings>& setting_table<OutflowSettings>() {
    static const SettingTable<OutflowSettings> table = outflow_rows();
    return table;
}

template <>
const SettingTable<StopSettings>& setting_table<StopSettings>() {
    static const SettingTable<StopSettings> table = stop_rows();
    return table;
}

template <>
const SettingTable<QueueSettings>& setting_table<QueueSettings>() {
    static const SettingTable<QueueSettings> table = queue_rows();
    return table;
}

template <>
const SettingTable<CalmingSettings>& setting_table<CalmingSettings>() {
    static const SettingTable<CalmingSettings> table = calming_rows();
    return table;
}

template <>
const SettingTable<SoilSettings>& setting_table<SoilSettings>() {
    static const SettingTable<SoilSettings> table = soil_rows();
    return table;
}

template <>
const SettingTable<CheckpointSettings>& setting_table<CheckpointSettings>() {
    static const SettingTable<CheckpointSettings> table = checkpoint_rows();
    return table;
}

template <>
const SettingTable<RecordSettings>& setting_table<RecordSettings>() {
    static const SettingTable<RecordSettings> table = record_rows();
    return table;
}

template <>
const SettingTable<KernelSettings>& setting_table<KernelSettings>() {
    static const SettingTable<KernelSettings> table = kernel_rows();
    return table;
}

template <>
const SettingTable<ClosureSettings>& setting_table<ClosureSettings>() {
    static const SettingTable<ClosureSettings> table = closure_rows();
    return table;
}

template <>
const SettingTable<PairSettings>& setting_table<PairSettings>() {
    static const SettingTable<PairSettings> table = pair_rows();
    return table;
}

template <>
const SettingTable<ContactSettings>& setting_table<ContactSettings>() {
    static const SettingTable<ContactSettings> table = contact_rows();
    return table;
}

}  // namespace cutterflow::coupling
