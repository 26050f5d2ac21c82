#pragma once
/// \file The study file: one operating point of one cutter. Its keys are declared once (study_table); reading, checks, the commented
/// template, `cutterflow params` and the manual page come from there.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cases/study/shape_file.hpp"
#include "geometry/base/axial_cylinder.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/parameters/parameter.hpp"
#include "postproc/run/adv_points.hpp"
#include "solver/ports/dem_settings.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::cases {

/// Stages of a run that keys of the study belong to (Parameter::stage). A stage depends on the ones before it as a whole.
inline constexpr const char* k_geometry_stage = "geometry";
inline constexpr const char* k_mesh_stage = "mesh";
inline constexpr const char* k_case_stage = "case";
inline constexpr const char* k_report_stage = "report";

/// Values of bank.model.
inline constexpr const char *k_no_bank = "none", *k_wall_bank = "wall";

/// What derived defaults follow: sizes of the head in the run's frame.
struct HeadSize {
    double ring_radius = 0.0;           ///< [m]
    double tip_radius = 0.0;            ///< largest radius of the head [m]
    double depth = 0.0;                 ///< from the ring plane to the head's lowest point [m], > 0
    std::optional<double> passage{};    ///< diameter of the largest sphere that passes between the blades [m]; none without blades
    std::optional<double> thickness{};  ///< of the thinnest steel [m]
    int blades = 1;
};

/// Size of the smallest cells that rock meets at the cutter, over that of the background's (docs/design/003-meshing.md).
inline constexpr double k_cell_at_rock = 0.387;

/// One size of rock in a feed.
struct FeedClass {
    double diameter = 0.0;             ///< of the sphere of its volume [m]
    double density = 0.0;              ///< [kg/m3]
    double mass_share = 0.0;           ///< of the feed, > 0; shares are relative to their sum
    std::optional<ShapeFile> shape{};  ///< none: a sphere

    /// Diameter of the sphere around it [m].
    double extent() const { return shape ? shape->girth() * diameter : diameter; }
};

enum class FeedKind {
    batch,     ///< placed on a lattice inside a wedge of the head, at once
    cut_face,  ///< comes all the time from where the head cuts the bank
};

/// One feed of rock.
struct FeedRequest {
    FeedKind kind = FeedKind::batch;
    std::optional<std::int64_t> count;  ///< one of count and mass
    std::optional<double> mass;         ///< [kg]
    double start = 0.0;                 ///< [s]
    double end = 0.0;                   ///< [s] of a cut face
    double velocity_share = 0.0;        ///< of a cut face: speed of rock over the blade's
    double disintegration = 0.0;        ///< of a cut face: share of the ground that becomes rock
    std::int64_t seed = 0;
    double spacing = 0.0;            ///< between centres, over the largest diameter
    double azimuth_centre = 0.0;     ///< [rad], in the fixed frame when it is released
    double azimuth_width = 0.0;      ///< [rad]
    double radius_from = 0.0;        ///< [m]
    double radius_to = 0.0;          ///< [m]
    double depth_from = 0.0;         ///< [m] below the ring plane
    double depth_to = 0.0;           ///< [m]
    std::vector<FeedClass> classes;  ///< by a law: of equal mass, and the density of the soil's grains
};

/// A study in SI units, radians and the run's frame (docs/design/001-contracts.md), every derived default filled in.
struct Study {
    std::string name;
    struct Cutter {
        std::filesystem::path file;       ///< absolute
        std::optional<std::string> unit;  ///< none: told from the size
    } cutter;
    double rotation_speed = 0.0;  ///< [rad/s], right-handed about the axis from hub to ring
    struct Suction {
        double discharge = 0.0;                                                     ///< [m3/s]
        double mouth_azimuth = 0.0;                                                 ///< [rad]
        double mouth_offset = 0.0;                                                  ///< [m]
        double mouth_radius = 0.0;                                                  ///< [m]
        double gap = 0.0;                                                           ///< between ring plane and backplate [m]
        double backplate_radius = 0.0, backplate_thickness = 0.0, pipe_wall = 0.0;  ///< [m]
    } suction;
    double inclination = 0.0;  ///< of the axis below horizontal [rad]
    std::string swing_direction;
    struct Bank {
        double swing_speed = 0.0;                                                 ///< [m/s]
        double cut_height = 0.0, step = 0.0, clearance = 0.0, pick_length = 0.0;  ///< [m]
        /// Whether picks stand on the blades that the cutter's file does not have.
        bool adds_picks() const { return pick_length > 0.0; }
        double grain_density = 0.0;                 ///< of the soil [kg/m3]
        double porosity = 0.0;                      ///< of the soil
        std::optional<std::filesystem::path> file;  ///< the soil's surface, absolute; none: what earlier swings left
        bool hauls = false;                         ///< the run's frame travels with the head
        double bulking = 1.5;                       ///< volume of loose rock over that of soil
        double spill_layer = 0.0;                   ///< left by the swing before [m]
        double permeability = 0.0;                  ///< of the soil, by Darcy's law [m2]; 0: no water moves in it
    };
    std::optional<Bank> bank;
    struct Tank {
        double radius = 0.0, bed_clearance = 0.0, height = 0.0;  ///< [m]
    } tank;
    std::string mesh_preset;
    coupling::FluidProperties fluid;
    coupling::ContactSettings contact;  ///< max_speed is the scene's
    coupling::ClosureSettings closures;
    coupling::KernelSettings kernel;
    std::vector<FeedRequest> feeds;  ///< none: pure flow
    double length_ratio = 0.0;
    struct Run {
        double flow_revolutions = 0.0, max_revolutions = 0.0;
        coupling::StopSettings stop;
        double max_courant = 0.0;
        double checkpoint_interval = 0.0, write_interval = 0.0;  ///< [s]
        double record_revolutions = 0.0;                         ///< before the first rock
    } run;
    struct Report {
        double bin_width = 0.0, outflow_offset = 0.0, outflow_start = 0.0;  ///< [m], [m], [s]
        std::optional<std::filesystem::path> adv_points;                    ///< absolute
        postproc::AdvProbe adv_probe;
    } report;

    double period() const;         ///< of one revolution [s]
    double end_time() const;       ///< [s]
    double first_release() const;  ///< [s]; of a study with rock
    /// Until when the flow develops in longer steps [s]: one revolution before it is recorded, averaged or meets rock; 0 for never.
    double development_end() const;
    double bank_side() const;  ///< 1 with the bank at azimuth 90 degrees, -1 at -90
    bool is_fed_by_cutting() const;
    std::vector<ShapeFile> shapes() const;  ///< of all classes of rock, each once
    AxialCylinder water(const HeadSize& head) const;
};

/// Share of a blade's passing by which repeat or replay `index` of a study is released later; 0 of the study itself, index 0. It does not
/// depend on how many there are: fractional parts of multiples of the golden ratio stay spread when more are added.
double release_share(int index);

/// Revolution of the rotor at which a feed of a study begins.
double start_revolution(const ParameterValues& study, const ParameterValues& feed);

/// Another placement of every feed, released later: `seeds` are added to the feeds' seeds, `revolutions` of the rotor to their starts.
void vary_release(ParameterValues& values, std::int64_t seeds, double revolutions);

/// Every key of a study, each with its stage.
const ParameterTable& study_table();

/// Rules that values broke which a study's file gives, as far as they can be seen without the cutter. \param file  the study's
std::vector<Mistake> check_file_rules(const ParameterValues& values, const std::filesystem::path& file);

/// Whether soil stands beside the head of a study.
bool has_bank(const ParameterValues& values);

/// Whether a study has a bank without the swing that cuts it. check_file_rules refuses it.
bool lacks_swing(const ParameterValues& values);

/// Reads a study file; values as the file gives them, plain defaults filled in, derived ones still absent.
/// \throws UserError  with every mistake of the file that can be seen without the cutter
ParameterValues read_study(const std::filesystem::path& file);

/// The values with every derived default written out, for a head of that size.
ParameterValues resolve_study(const ParameterValues& values, const HeadSize& head);

/// Typed study from resolved values. \param folder  to which paths are relative: the study file's
/// \throws UserError  when a shape cannot be read
Study make_study(const ParameterValues& resolved, const std::filesystem::path& folder);

/// Rules across keys that a resolved study breaks; each names its keys and, where the file gives them, their lines.
std::vector<Mistake> check_study(const ParameterValues& resolved, const HeadSize& head);

/// What is allowed and yet deserves a look. \param study  made from the values
std::vector<Mistake> study_warnings(const ParameterValues& resolved, const Study& study, const HeadSize& head);

/// Azimuth [deg] of the side on which the bank stands: where the blades move up (under_cut) or down (over_cut).
/// Azimuth 0 is lowest and positive by the right hand about the axis from hub to ring, so that a right-handed rotor's blades rise at 90
/// degrees.
double bank_azimuth_deg(const std::string& swing_direction, const std::string& rotor_direction);

/// The text that `cutterflow new` writes: every key commented, with the model cutter's operating point, and one feed.
std::string study_template(const std::string& name, const std::string& cutter_file, const std::optional<std::string>& unit);

/// docs/user/study_file.md.
std::string study_manual_page();

}  // namespace cutterflow::cases
