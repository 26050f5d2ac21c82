/// \file The one declaration of every key of a study.
#include <algorithm>
#include <iterator>

#include "cases/study/study.hpp"
#include "meshing/cutter/mesh_plan.hpp"
#include "solver/physics/catalogue.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::cases {
namespace {

/// A row under construction: Row(k_case_stage, "rotor.speed_rpm", ParameterKind::number, "rpm", "Help.").above(0).at_most(600).
class Row {
public:
    Row(const char* stage, std::string key, ParameterKind kind, std::string unit, std::string help) {
        parameter_.stage = stage;
        parameter_.key = std::move(key);
        parameter_.kind = kind;
        parameter_.unit = std::move(unit);
        parameter_.help = std::move(help);
        parameter_.repeated = parameter_.key.rfind("feed.", 0) == 0;
    }
    Row& above(double bound) {
        parameter_.minimum = bound;
        parameter_.minimum_excluded = true;
        return *this;
    }
    Row& at_least(double bound) {
        parameter_.minimum = bound;
        return *this;
    }
    Row& at_most(double bound) {
        parameter_.maximum = bound;
        return *this;
    }
    Row& standard(ParameterValue value) {
        parameter_.default_value = std::move(value);
        return *this;
    }
    /// May be absent; `rule` says what is used then.
    Row& derived(std::string rule) {
        parameter_.optional = true;
        parameter_.derived_from = std::move(rule);
        return *this;
    }
    Row& one_of(std::vector<std::string> choices) {
        parameter_.choices = std::move(choices);
        return *this;
    }
    Row& source(std::string reference) {
        parameter_.reference = std::move(reference);
        return *this;
    }
    operator Parameter() const { return parameter_; }

private:
    Parameter parameter_;
};

Row number(const char* stage, const char* key, const char* unit, const char* help) {
    return {stage, key, ParameterKind::number, unit, help};
}
Row integer(const char* stage, const char* key, const char* help) {
    return {stage, key, ParameterKind::integer, "-", help};
}
Row text(const char* stage, const char* key, const char* help) {
    return {stage, key, ParameterKind::text, "-", help};
}
Row choice(const char* stage, const char* key, std::vector<std::string> choices, const char* help) {
    return Row(stage, key, ParameterKind::choice, "-", help).one_of(std::move(choices));
}

ParameterTable head_rows() {
    return {
        text(k_report_stage, "name", "Name of the study, shown in its report.").standard(std::string("study")),
        Row(k_geometry_stage, "cutter.file", ParameterKind::path, "-",
            "Surface of the cutter (STL, OBJ or PLY), relative to this file; closed and facing outwards."),
        choice(k_geometry_stage, "cutter.unit", {"m", "mm", "cm", "inch", "ft"}, "Unit of length in the cutter's file.")
            .derived("metres, millimetres or inches, the first that gives a plausible size"),
        number(k_case_stage, "rotor.speed_rpm", "rpm", "Rotation speed of the cutter.").above(0.0).at_most(600.0),
        choice(k_case_stage, "rotor.direction", {"right_handed", "left_handed"},
               "Sense of rotation about the axis from hub to ring. Seen from the suction side, right_handed turns counterclockwise.")
            .standard(std::string("right_handed")),
        number(k_case_stage, "suction.discharge_m3_s", "m3/s", "Volume flow of the mixture through the suction pipe.").above(0.0),
        number(k_geometry_stage, "suction.mouth_azimuth_deg", "deg",
               "Azimuth of the mouth's centre: 0 is lowest, positive by the right hand about the axis.")
            .at_least(-360.0)
            .at_most(360.0)
            .standard(0.0),
        number(k_geometry_stage, "suction.mouth_offset_m", "m", "Distance of the mouth's centre from the rotor's axis.")
            .at_least(0.0)
            .derived("0.55 ring radius"),
        number(k_geometry_stage, "suction.mouth_radius_m", "m", "Inner radius of mouth and suction pipe.")
            .above(0.0)
            .derived("0.25 ring radius"),
        number(k_geometry_stage, "suction.gap_m", "m", "Gap between ring plane and backplate.").above(0.0).derived("0.075 ring radius"),
        number(k_geometry_stage, "suction.backplate_radius_m", "m", "Radius of the backplate.").above(0.0).derived("the ring radius"),
        number(k_geometry_stage, "suction.backplate_thickness_m", "m", "Thickness of the backplate.")
            .above(0.0)
            .derived("0.05 ring radius"),
        number(k_geometry_stage, "suction.pipe_wall_m", "m", "Wall thickness of the suction pipe.").above(0.0).derived("0.025 ring radius"),
        number(k_case_stage, "ladder.inclination_deg", "deg",
               "Rotor axis below horizontal; gravity stands at 90 degrees minus it from the axis.")
            .at_least(0.0)
            .at_most(90.0)
            .standard(45.0),
        choice(k_case_stage, "swing.direction", {"over_cut", "under_cut"},
               "Whether blades cut the bank on their way down (over_cut) or up (under_cut); sets the side on which rock is released.")
            .standard(std::string("over_cut")),
    };
}

ParameterTable water_rows() {
    return {
        number(k_geometry_stage, "tank.radius_m", "m", "Radius of the water's cylinder about the axis.")
            .above(0.0)
            .derived("6.25 ring radius"),
        number(k_geometry_stage, "tank.bed_clearance_m", "m", "Distance of the head's lowest point from the bed, along the axis.")
            .above(0.0)
            .derived("0.975 ring radius"),
        number(k_geometry_stage, "tank.height_m", "m", "Height of the water's cylinder along the axis.")
            .above(0.0)
            .derived("bed clearance + the head's height + 1.0875 ring radius"),
        choice(k_mesh_stage, "mesh.preset", meshing::mesh_preset_names(),
               "Resolution: draft has 40,000 to 70,000 cells, paper about 1,000,000 with 0.01 ring radius at the blades.")
            .standard(std::string("draft")),
        number(k_case_stage, "fluid.density_kg_m3", "kg/m3", "Density of the water.").above(0.0).standard(998.2),
        number(k_case_stage, "fluid.kinematic_viscosity_m2_s", "m2/s", "Kinematic viscosity of the water.").above(0.0).standard(1.0034e-6),
    };
}

ParameterTable rock_rows() {
    return {
        number(k_case_stage, "rock.youngs_modulus_pa", "Pa",
               "Young's modulus of rock and steel in contacts. Soft contacts allow longer steps of the DEM.")
            .at_least(1e3)
            .at_most(1e12)
            .derived("so that rock at tip speed overlaps steel by 5 % of its radius"),
        number(k_case_stage, "rock.poisson_rock", "-", "Poisson's ratio of rock.").at_least(0.0).at_most(0.49).standard(0.24),
        number(k_case_stage, "rock.poisson_steel", "-", "Poisson's ratio of steel.").at_least(0.0).at_most(0.49).standard(0.27),
        number(k_case_stage, "rock.friction", "-", "Coefficient of friction, rock on rock and on steel.")
            .at_least(0.0)
            .at_most(2.0)
            .standard(0.15),
        number(k_case_stage, "rock.restitution", "-", "Restitution of a dry impact.")
            .at_least(physics::k_smallest_restitution)
            .at_most(1.0)
            .standard(0.97),
        Row(k_case_stage, "rock.wet_restitution", ParameterKind::boolean, "-", "Whether water damps impacts by their Stokes number.")
            .standard(true)
            .source("Legendre2006"),
        number(k_case_stage, "rock.time_step_fraction", "-", "DEM time step over the smaller of Rayleigh time and Hertz time at tip speed.")
            .at_least(1e-3)
            .at_most(0.3)
            .standard(0.1),
        choice(k_case_stage, "closures.drag", physics::closure_choices(physics::ClosureKind::drag),
               "Drag law of a rock. gidaspow and koch_hill hold the effect of other rocks themselves: they need closures.hindrance = "
               "\"none\".")
            .standard(std::string("brown_lawler")),
        choice(k_case_stage, "closures.hindrance", physics::closure_choices(physics::ClosureKind::hindrance),
               "How other rocks raise the drag.")
            .standard(std::string("di_felice")),
        number(k_case_stage, "closures.added_mass", "-", "Added-mass coefficient.").at_least(0.0).at_most(2.0).standard(0.5),
        number(k_case_stage, "closures.drag_modifier", "-", "Factor on the drag force.").above(0.0).at_most(10.0).standard(1.0),
        number(k_case_stage, "closures.sphericity", "-",
               "Surface of the sphere of equal volume over that of the rock; haider_levenspiel asks for it, the other drag laws do not.")
            .above(0.0)
            .at_most(1.0)
            .standard(1.0),
        choice(k_case_stage, "closures.lift", physics::closure_choices(physics::ClosureKind::lift),
               "Lift on rock in sheared flow. The source of mei holds for grains with Reynolds numbers up to 1.")
            .standard(std::string("none")),
        Row(k_case_stage, "closures.viscous_force", ParameterKind::boolean, "-",
            "Whether the undisturbed flow's stress on rock counts its viscous part (rho V Du/Dt), or the pressure gradient alone.")
            .standard(true)
            .source("NieuwboerVanRheeKeetels2023"),
        number(k_case_stage, "kernel.gamma", "-", "Width of the Gaussian kernel over the rock's diameter.")
            .above(0.0)
            .at_most(5.0)
            .standard(1.0),
        number(k_case_stage, "kernel.min_width_in_cells", "-", "Smallest width of the kernel over the local cell size.")
            .at_least(0.5)
            .at_most(5.0)
            .standard(1.5),
        number(k_case_stage, "kernel.max_solid_fraction", "-", "Solid fraction above which volume is moved to neighbouring cells.")
            .at_least(0.1)
            .at_most(0.74)
            .standard(0.7),
    };
}

ParameterTable run_rows() {
    return {
        number(k_report_stage, "scale.length_ratio", "-",
               "Length of the prototype over that of this head; the report adds columns scaled by Froude's law.")
            .above(0.0)
            .standard(1.0),
        number(k_case_stage, "run.flow_revolutions", "-", "Revolutions of the flow alone before rock is released.")
            .at_least(0.0)
            .standard(1.0),
        number(k_case_stage, "run.max_revolutions", "-", "Revolutions after which the run ends, those of the flow alone included.")
            .above(0.0)
            .standard(4.0),
        number(
            k_case_stage, "run.stop_undecided", "-",
            "The run ends earlier when the share of rock that is neither spilled nor sucked up is at most this; 0 waits for the last rock.")
            .at_least(0.0)
            .at_most(1.0)
            .standard(0.05),
        number(k_case_stage, "run.max_courant", "-", "Largest Courant number of the flow relative to the mesh.")
            .above(0.0)
            .at_most(5.0)
            .standard(0.9),
        number(k_case_stage, "run.checkpoint_interval_s", "s", "Simulated time between checkpoints, from which a killed run is resumed.")
            .above(0.0)
            .derived("a quarter of a revolution"),
        number(k_case_stage, "run.write_interval_s", "s", "Simulated time between fields and rock positions for ParaView.")
            .above(0.0)
            .derived("a quarter of a revolution"),
        number(k_case_stage, "report.bin_width_m", "m", "Width of the axial bins of spillage and outflow.")
            .above(0.0)
            .derived("0.075 ring radius"),
        number(k_case_stage, "report.outflow_offset_m", "m", "Distance outside the contour at which the radial outflow is sampled.")
            .above(0.0)
            .derived("0.0375 ring radius"),
        number(k_case_stage, "report.outflow_start_s", "s", "Time from which the radial outflow, and the velocity at points, is averaged.")
            .at_least(0.0)
            .derived("the end of run.flow_revolutions, or half the run when that is not before its end"),
        Row(k_case_stage, "report.adv_points", ParameterKind::path, "-",
            "CSV file of points at which velocities were measured; the run averages the velocity there. `cutterflow report --adv-template` "
            "prints one.")
            .derived("no points"),
        number(k_case_stage, "report.adv_probe_diameter_m", "m",
               "Diameter of the volume, a cylinder along the axis, in which the instrument measures.")
            .above(0.0)
            .derived("0.006 m"),
        number(k_case_stage, "report.adv_probe_length_m", "m", "Length of that volume.").above(0.0).derived("0.009 m"),
        number(k_case_stage, "report.adv_position_error_m", "m", "How far the instrument may have been from where it is said to have been.")
            .above(0.0)
            .derived("0.025 ring radius"),
    };
}

ParameterTable feed_rows() {
    return {
        integer(k_case_stage, "feed.count", "Number of rocks; give this or mass_kg.").at_least(1.0).derived("from mass_kg"),
        number(k_case_stage, "feed.mass_kg", "kg", "Mass of the rocks; give this or count.").above(0.0).derived("from count"),
        number(k_case_stage, "feed.start_revolution", "-", "Revolution at which the rock is released.")
            .at_least(0.0)
            .derived("run.flow_revolutions"),
        number(k_case_stage, "feed.duration_s", "s", "0 releases all at once, as a batch. Other values are kept for continuous feed.")
            .at_least(0.0)
            .standard(0.0),
        integer(k_case_stage, "feed.seed", "Seed of the placement; repeats of a run differ by it.").at_least(0.0).standard(std::int64_t{1}),
        number(k_case_stage, "feed.spacing_diameters", "-",
               "Distance between neighbouring rocks, centre to centre, over the largest diameter.")
            .at_least(1.01)
            .at_most(20.0)
            .standard(1.5),
        number(k_case_stage, "feed.azimuth_centre_deg", "deg",
               "Middle of the wedge in which rock is placed, in the fixed frame when it is released.")
            .at_least(-360.0)
            .at_most(360.0)
            .derived("the bank's side, from swing.direction and rotor.direction"),
        number(k_case_stage, "feed.azimuth_width_deg", "deg", "Width of the wedge; rock fills it from its middle.")
            .above(0.0)
            .at_most(360.0)
            .standard(120.0),
        number(k_case_stage, "feed.depth_from_m", "m", "Upper end of the wedge, below the ring plane.").at_least(0.0).standard(0.0),
        number(k_case_stage, "feed.depth_to_m", "m", "Lower end of the wedge, below the ring plane.")
            .above(0.0)
            .derived("the head's lowest point"),
        number(k_case_stage, "feed.class.diameter_m", "m", "Diameter of the rocks of this class.").above(0.0),
        number(k_case_stage, "feed.class.density_kg_m3", "kg/m3", "Density of the rock.").above(0.0).standard(2650.0),
        number(k_case_stage, "feed.class.mass_share", "-", "Share of this class in the feed's mass, relative to the sum of all shares.")
            .above(0.0)
            .standard(1.0),
    };
}

}  // namespace

const ParameterTable& study_table() {
    static const ParameterTable table = [] {
        ParameterTable all;
        for (const ParameterTable& rows : {head_rows(), water_rows(), rock_rows(), run_rows(), feed_rows()})
            std::copy(rows.begin(), rows.end(), std::back_inserter(all));
        return all;
    }();
    return table;
}

}  // namespace cutterflow::cases
