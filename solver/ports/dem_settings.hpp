#pragma once
/// \file Settings of the DEM: contact law, walls, domain, fluid. solver/foam fills it from section `rock` of
/// constant/couplingProperties (and constant/g, constant/transportProperties); solver/liggghts works from it.
#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/vec3.hpp"
#include "solver/ports/settings.hpp"

namespace cutterflow::coupling {

/// What two materials have in common when they touch.
struct PairSettings {
    double friction = 0.5;          ///< Coulomb [-]
    double restitution = 0.97;      ///< dry [-], 0.14 to 1
    double rolling_friction = 0.1;  ///< largest rolling couple over normal force and rolling radius [-]
};

inline constexpr const char* k_pair_with_rock = "rock_";  ///< in front of a material, the name of its pair
inline constexpr const char* k_steel = "steel";
inline constexpr const char* k_soil = "soil";

/// Contact law of rock on rock and on the materials of walls (docs/theory/contact.md). All materials have the same Young's modulus, soil
/// has the rock's Poisson ratio, the others steel's.
struct ContactSettings {
    double youngs_modulus = 0.0;  ///< [Pa]
    double poisson_rock = 0.24;   ///< [-]
    double poisson_steel = 0.27;  ///< [-]
    PairSettings rock_rock;
    PairSettings rock_steel{0.35, 0.97, 0.1};
    PairSettings rock_soil{0.6, 0.97, 0.15};
    std::map<std::string, PairSettings> rock_on_others{};  ///< by material
    std::string rolling_law = "spring";                    ///< or "constant"
    bool wet_restitution = true;                           ///< e after Legendre from the impact speed
    double time_step_fraction = 0.1;                       ///< of the smaller of Rayleigh and Hertz time
    double max_speed = 0.0;                                ///< impact speed for the Hertz time [m/s]

    void set_every_pair(const PairSettings& pair) {
        rock_rock = rock_steel = rock_soil = pair;
        for (auto& [material, other] : rock_on_others) other = pair;
    }
    /// Rock on a wall of that material; null when nothing is known of it.
    const PairSettings* pair_on(const std::string& material) const;
};

/// A pair of materials that can touch, rock and another one, of which the values are known without being given.
struct MaterialPair {
    const char* name;   ///< of its section of couplingProperties
    const char* other;  ///< material
    PairSettings ContactSettings::*settings;
};
inline constexpr std::array<MaterialPair, 3> k_material_pairs{{{"rock_rock", "rock", &ContactSettings::rock_rock},
                                                               {"rock_steel", "steel", &ContactSettings::rock_steel},
                                                               {"rock_soil", "soil", &ContactSettings::rock_soil}}};

/// Coefficients of every pair under one name.
struct PairPreset {
    const char* name;
    PairSettings rock_rock, rock_steel, rock_soil;
};
inline constexpr const char* k_gravel_pairs = "gravel";  ///< angular gravel; the default
inline constexpr const char* k_paper_pairs = "paper";    ///< [NieuwboerVanRheeKeetels2023]

const std::array<PairPreset, 2>& pair_presets();

/// Takes the pairs of that preset. \pre there is one of that name
void use_preset(ContactSettings& settings, const std::string& name);

template <>
const SettingTable<PairSettings>& setting_table<PairSettings>();
template <>
const SettingTable<ContactSettings>& setting_table<ContactSettings>();

/// Linear spring and dashpot with a stiffness that follows from weight [Chen2019] [Zhang2009]; see liggghts/contacts/contact_law.hpp.
struct LinearContactSettings {
    double theta = 0.01;              ///< overlap under the own weight over the reference length [-]
    double reference_length = 5e-4;   ///< l [m]; a length of its own, so that a finer fluid mesh does not stiffen the contacts
    double gravity = 9.81;            ///< in the stiffness [m/s2]
    double damping = 0.4;             ///< a [-], below sqrt(1/2)
    double poisson = 0.3;             ///< psi [-]
    double steps_per_period = 150.0;  ///< gamma: steps in 2 pi sqrt(m/k_n)
    bool accumulated_shear = true;    ///< false: the slip of one step alone stretches the tangential spring
    bool may_pull = false;            ///< the normal force may become negative while the bodies part
};

enum class ContactLaw { hertz, linear };
enum class RockShape { sphere, cylinder };

/// Constant velocity of a wall from one time to another; before and after it stands.
struct WallTravel {
    Vec3 velocity = Vec3::Zero();   ///< [m/s]
    double begin = 0.0, end = 0.0;  ///< [s]
    Vec3 way(double time) const { return velocity * std::clamp(time - begin, 0.0, end - begin); }
    Vec3 velocity_at(double time) const { return time > begin && time <= end ? velocity : Vec3(Vec3::Zero()); }
};

/// Way of a wall until a time, the integral of its velocity [m]. \param travels  one after the other
Vec3 way_until(const std::vector<WallTravel>& travels, double time);
/// That of the travel that lasts; zero between two [m/s].
Vec3 velocity_at(const std::vector<WallTravel>& travels, double time);

/// Constant rotation of a wall about an axis of its own from one time to another; before and after it stands.
struct WallTurn {
    RotationAxis axis;
    double speed = 0.0;             ///< [rad/s], right-handed about the axis; 0: it does not turn
    double begin = 0.0, end = 0.0;  ///< [s]
    double angle(double time) const { return speed * std::clamp(time - begin, 0.0, end - begin); }
    Vec3 spin_at(double time) const { return time > begin && time <= end ? Vec3(speed * axis.direction) : Vec3(Vec3::Zero()); }
};

/// A wall that rock holds up: it moves along `direction` with the speed v_max (1 - N/F), within +-v_max, where N is rock's force against
/// that direction, and so comes to bear F. It is a weightless plate with a damper of F/v_max.
struct WallPress {
    Vec3 direction = -Vec3::UnitZ();  ///< of length 1
    double force = 0.0;               ///< F [N]
    double largest_speed = 0.0;       ///< v_max [m/s]

    /// \param reaction  N [N]
    double speed(double reaction) const { return largest_speed * std::clamp(1.0 - reaction / force, -1.0, 1.0); }
};

/// A wall given as STL [m, run frame]. A rotating one turns with the moving zone and is given at angle 0; one that travels, or turns by
/// itself, is given where it stands at first. Its material says which pair its contacts with rock follow. A wall whose surface runs, as a
/// belt's, is at rest but for the velocity along it.
struct WallSettings {
    std::string name;
    std::filesystem::path file;
    bool rotating = false;
    std::vector<WallTravel> travels{};  ///< one after the other
    WallTurn turn{};
    std::optional<WallPress> press{};
    std::string material = k_steel;
    double removed_at = std::numeric_limits<double>::infinity();  ///< from then on it exerts nothing [s]
    Vec3 surface_velocity = Vec3::Zero();                         ///< of which the part along the surface counts [m/s]
};

enum class DomainShape { box, cylinder };

/// Plane sides of a domain, in the order of k_domain_sides. A cylinder has only the last two.
enum class DomainSide { x_min, x_max, y_min, y_max, z_min, z_max };
inline constexpr std::array<const char*, 6> k_domain_sides{"xMin", "xMax", "yMin", "yMax", "zMin", "zMax"};

/// Rock leaves the run when its centre is outside the domain: a box along the axes, or an upright cylinder. Plane sides may be walls.
struct DomainSettings {
    DomainShape shape = DomainShape::box;
    Vec3 lower = Vec3::Zero();                   ///< corner of a box [m]; of a cylinder z counts
    Vec3 upper = Vec3::Zero();                   ///< the opposite corner [m]; of a cylinder z counts
    Vec3 axis_point = Vec3::Zero();              ///< a point on a cylinder's axis [m]; the axis is parallel to z
    double radius = 0.0;                         ///< of a cylinder [m]
    std::array<bool, 6> side_is_wall{};          ///< by DomainSide
    std::array<bool, 6> side_is_frictionless{};  ///< of the sides that are walls
    std::string material = k_steel;              ///< of the sides that are walls

    bool is_wall(DomainSide side) const { return side_is_wall[static_cast<std::size_t>(side)]; }
    void make_wall(DomainSide side) { side_is_wall[static_cast<std::size_t>(side)] = true; }
    /// Position [m] of a plane side along its axis (0 x, 1 y, 2 z).
    double position_of(std::size_t side) const { return (side % 2 == 0 ? lower : upper)[static_cast<Eigen::Index>(side / 2)]; }
};

/// How far a rock that is a clump may reach from its centre of mass, over half the domain's larger horizontal width. One that reaches
/// farther finds no room.
inline constexpr double k_largest_reach = 0.25;

/// Whether rock with its centre there [m] belongs to the run.
bool contains(const DomainSettings& domain, const Vec3& centre);

/// A cylinder about the z axis.
inline DomainSettings cylinder_domain(double radius, double z_min, double z_max) {
    DomainSettings domain;
    domain.shape = DomainShape::cylinder;
    domain.radius = radius;
    domain.lower.z() = z_min;
    domain.upper.z() = z_max;
    return domain;
}

struct DemSettings {
    ContactSettings contact;
    std::vector<WallSettings> walls;
    std::vector<ClumpShape> shapes;  ///< of rock that is no sphere
    DomainSettings domain;
    FluidProperties fluid;
    double added_mass = 0.5;  ///< C_AM [-]
    ContactLaw law = ContactLaw::hertz;
    LinearContactSettings linear;         ///< of the linear law; friction is that of the pairs of `contact`; nothing resists rolling
    RockShape shape = RockShape::sphere;  ///< cylinders lie along y and stay in their plane
    double cylinder_length = 0.0;         ///< [m]
    double contact_gap = 0.0;             ///< surfaces touch at this distance, at half of it on walls [m]
    Vec3 gravity = Vec3::Zero();          ///< [m/s2]
    std::filesystem::path log;            ///< LIGGGHTS' own log; empty: none
};

/// Every mistake of the settings (not of the files they name).
std::vector<Mistake> check_settings(const DemSettings& settings, const std::string& where);

}  // namespace cutterflow::coupling
