#pragma once
/// \file The coupled step of water with a free surface and solids that it carries.
#include "solver/free_surface/even_out.hpp"
#include "solver/free_surface/scene.hpp"
#include "solver/ports/dem_engine.hpp"

namespace cutterflow::free_surface {

/// Impulses of the pressure in one step [N s]. Their sum is 0: what the water gets, bodies and walls lose.
struct PressureImpulses {
    Vec3 water = Vec3::Zero();
    Vec3 bodies = Vec3::Zero();
    Vec3 walls = Vec3::Zero();
    Vec3 sum() const { return water + bodies + walls; }
};

/// What one step did and found.
struct StepReport {
    double time = 0.0;  ///< at its end [s]
    double step = 0.0;  ///< [s]
    SolveReport pressure, even_out;
    PressureImpulses impulses;
    std::vector<Vec3> body_force;     ///< of the pressure on each body [N]; it has no torque on round bodies
    std::vector<Vec3> contact_force;  ///< mean over the step [N]
    double body_impulse_error = 0.0;  ///< of the pressure's impulse that the DEM reports, largest over bodies, share of its size
    double occupied_volume = 0.0;     ///< at its end [m3]
    int pushed_out = 0;               ///< particles that were found in a solid
    double deepest = 0.0;             ///< the farthest way out of one [m]
    double gap_impulse = 0.0;         ///< momentum that the damping of gaps took out, sum of sizes [N s]
    int enclosed_waters = 0;
    int through_walls = 0;  ///< particles that passed the middle of a watched wall: none may
};

/// All that the next steps depend on, beside the settings and the DEM's own state.
struct SurfaceState {
    double time = 0.0;
    long steps = 0;
    double initial_volume = 0.0;
    double mixing_time = 0.0;
    double fastest_allowed = 0.0;
    WaterParticles particles;
    CellField pressure, spreading;    ///< where the solvers begin
    std::vector<Vec3> contact_force;  ///< of the last step [N]
    int failed_solves = 0;            ///< of the pressure, in the last steps
};

class SurfaceRun {
public:
    /// \param bodies  moves the solids; null: none. It must bring the weight of its rocks itself and know no fluid.
    SurfaceRun(const SceneSettings& settings, coupling::DemEngine* bodies);
    /// With water of another shape than boxes.
    SurfaceRun(const SceneSettings& settings, coupling::DemEngine* bodies, WaterParticles water);

    /// \param longest  [s]: ends no later than this (an output's time)
    /// \throws CheckFailure  when a number is none, water flies at over 50 sqrt(g H), volume is lost or the pressure did not converge twice
    const StepReport& step(double longest = std::numeric_limits<double>::infinity());

    SurfaceState state() const;
    /// Goes on from a state; the DEM must stand where it stood then.
    void restore(SurfaceState state);

    double time() const { return time_; }
    const StepReport& last() const { return report_; }
    const StaggeredGrid& grid() const { return grid_; }
    const WaterParticles& particles() const { return particles_; }
    const WaterFraction& water() const { return water_; }
    const CutCells& cells() const { return cells_; }
    const FaceField& velocity() const { return velocity_; }
    const CellField& pressure() const { return pressure_; }  ///< [Pa], over that of the air
    const std::vector<Body>& bodies() const { return bodies_; }
    double initial_volume() const { return initial_volume_; }  ///< that the particles are: what the occupied volume is held against [m3]
    double energy() const;                                     ///< of the water: kinetic and in gravity from the origin on [J]

private:
    double choose_step(double longest) const;
    void add_body_forces(double step);
    void add_viscosity(double step, FaceField& change) const;
    void fill_unmapped_faces();
    void predict_bodies(double step);
    void solve_pressure(double step);
    void push_bodies(double step);
    void push_water();
    void book_walls(double step);
    void extend_velocity(double step);
    void hold_solid_faces(int direction);
    void move_bodies(double step);
    void take_over_bodies();
    void place_gates(double time);
    void push_out();
    int count_through_walls(const std::array<std::vector<double>, 3>& before) const;
    void find_surface();
    void require_pressure() const;
    void check() const;
    int worst_filled_cell(bool lost) const;
    std::string moment() const;
    std::string text_of(const Vec3& place) const;
    std::string text_of(int cell) const;

    const SceneSettings settings_;
    StaggeredGrid grid_;
    coupling::DemEngine* engine_;
    CellCutter cutter_;
    EvenOut even_out_;
    PressureSystem system_;

    WaterParticles particles_;
    std::vector<Body> bodies_;
    std::vector<Body> predicted_;  // with contacts and weight, then with the pressure
    std::vector<SolidBox> gates_;  // where they stand
    std::vector<double> lift_;     // mean upward speed of each gate in the step at hand [m/s]
    std::vector<Vec3> contact_force_;

    MappedWater mapped_;
    FaceField velocity_, increment_;
    CutCells cells_;
    WaterFraction water_;
    CellField fraction_;  // share of particles in cells
    CellField pressure_;
    CellField potential_;  // dt p / rho of the step at hand
    std::vector<double> right_side_, q_;
    std::vector<FaceValue> values_;

    double time_ = 0.0;
    double mixing_time_ = 0.0;
    double fastest_allowed_ = 0.0;
    double initial_volume_ = 0.0;
    long steps_ = 0;
    int failed_solves_ = 0;
    StepReport report_;
};

/// The water of a scene's boxes, where neither solids nor bodies stand.
WaterParticles fill_water(const SceneSettings& settings, gsl::span<const Body> bodies);

/// How many waters of a scene's start neither touch air nor a body that gives way: of their pressure only differences are known.
int enclosed_waters(const SceneSettings& settings, gsl::span<const Body> bodies);

/// A rock as a body: cylinder of the tank's depth or sphere.
Body body_of(const coupling::Rocks& rocks, std::size_t index, bool sphere, double depth);

}  // namespace cutterflow::free_surface
