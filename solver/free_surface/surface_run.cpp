#include "solver/free_surface/surface_run.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "solver/free_surface/gap_damping.hpp"

namespace cutterflow::free_surface {

namespace {

constexpr int k_steps_between_sorts = 20;
constexpr double k_mixing_cells = 50.0;    // tau_mix = 50 h / sqrt(g H)
constexpr double k_gravity_courant = 0.7;  // dt <= 0.7 sqrt(h/g)
constexpr double k_same_time = 1e-12;      // [s]
constexpr double k_fastest_water = 50.0;   // sqrt(g H)
constexpr int k_extended_layers = 2;
constexpr double k_off_walls = 1e-6;        // cells: particles put out of a wall belong to the cell before it
constexpr double k_first_tolerance = 1e-4;  // of the tolerance: water that rests from the start stays at rest

/// Height of the water over its lowest particle [m], at least a cell.
double water_height(const StaggeredGrid& grid, const WaterParticles& particles) {
    if (particles.size() == 0) return grid.extent(2);
    const auto [low, high] = std::minmax_element(particles.position[2].begin(), particles.position[2].end());
    return std::max(grid.spacing(), *high - *low);
}

std::vector<Body> bodies_of(const coupling::DemEngine* engine, const SceneSettings& settings) {
    std::vector<Body> bodies;
    if (!engine) return bodies;
    const coupling::Rocks& rocks = engine->rocks();
    for (std::size_t n = 0; n < rocks.size(); ++n) {
        bodies.push_back(body_of(rocks, n, settings.spheres, settings.tank.depth));
        bodies.back().held = settings.bodies_held;
    }
    return bodies;
}

}  // namespace

Body body_of(const coupling::Rocks& rocks, std::size_t index, bool sphere, double depth) {
    Body body;
    body.position = rocks.position[index];
    body.velocity = rocks.velocity[index];
    body.spin = rocks.angular_velocity[index];
    body.radius = 0.5 * rocks.diameter[index];
    body.sphere = sphere;
    const double section = k_pi * body.radius * body.radius;
    body.mass = rocks.density[index] * section * (sphere ? 4.0 / 3.0 * body.radius : depth);
    body.inertia = (sphere ? 0.4 : 0.5) * body.mass * body.radius * body.radius;
    return body;
}

WaterParticles fill_water(const SceneSettings& settings, gsl::span<const Body> bodies) {
    const StaggeredGrid grid = settings.tank.grid();
    WaterParticles particles;
    particles.volume = particle_volume(grid);
    const auto is_open = [&](const Vec3& place) {
        for (const StillSolid& solid : settings.solids) {
            if (is_inside(solid, place)) return false;
        }
        for (const Gate& gate : settings.gates) {
            if (is_inside(gate.at(0.0), place)) return false;
        }
        for (const Body& body : bodies) {
            Vec3 arm = place - body.position;
            if (!body.sphere) arm.y() = 0.0;
            if (arm.norm() < body.radius) return false;
        }
        return true;
    };
    std::uint8_t dye = 0;
    for (const WaterBox& box : settings.water.filled) fill_box(grid, box.from, box.to, dye++, is_open, particles);
    return particles;
}

int enclosed_waters(const SceneSettings& settings, gsl::span<const Body> bodies) {
    const StaggeredGrid grid = settings.tank.grid();
    CellCutter cutter(grid, settings.solids);
    std::vector<SolidBox> gates;
    for (const Gate& gate : settings.gates) gates.push_back(gate.at(0.0));
    cutter.set_gates(gates);
    CutCells cells;
    cutter.cut(bodies, cells);
    CellField fraction;
    map_fraction(grid, fill_water(settings, bodies), fraction);
    WaterFraction water;
    find_water(grid, fraction, cells, water);
    PressureSystem system(grid);
    system.assemble(water, cells, bodies, settings.water.density * grid.cell_volume());
    return system.enclosed_waters();
}

SurfaceRun::SurfaceRun(const SceneSettings& settings, coupling::DemEngine* bodies)
    : SurfaceRun(settings, bodies, fill_water(settings, bodies_of(bodies, settings))) {}

SurfaceRun::SurfaceRun(const SceneSettings& settings, coupling::DemEngine* bodies, WaterParticles water)
    : settings_(settings),
      grid_(settings.tank.grid()),
      engine_(bodies),
      cutter_(grid_, settings.solids),
      even_out_(grid_, settings.run.even_out_tolerance),
      system_(grid_),
      particles_(std::move(water)),
      mapped_(grid_),
      velocity_(grid_.face_field()),
      increment_(grid_.face_field()),
      pressure_(grid_.cell_field()),
      potential_(grid_.cell_field()),
      values_(grid_.size()) {
    const double speed = std::sqrt(settings.gravity.norm() * water_height(grid_, particles_));
    mixing_time_ = settings.run.mixing_time < 0.0 ? k_mixing_cells * grid_.spacing() / speed : settings.run.mixing_time;
    fastest_allowed_ = k_fastest_water * speed;
    take_over_bodies();
    contact_force_.assign(bodies_.size(), Vec3::Zero());
    place_gates(0.0);
    cutter_.cut(bodies_, cells_);
    find_surface();
    initial_volume_ = particles_.volume * static_cast<double>(particles_.size());
    report_.occupied_volume = occupied_volume(grid_, cells_, water_);
}

SurfaceState SurfaceRun::state() const {
    return {time_,      steps_,    initial_volume_,       mixing_time_,   fastest_allowed_,
            particles_, pressure_, even_out_.potential(), contact_force_, failed_solves_};
}

void SurfaceRun::restore(SurfaceState state) {
    time_ = state.time;
    steps_ = state.steps;
    initial_volume_ = state.initial_volume;
    mixing_time_ = state.mixing_time;
    fastest_allowed_ = state.fastest_allowed;
    particles_ = std::move(state.particles);
    pressure_ = std::move(state.pressure);
    even_out_.begin_with(std::move(state.spreading));
    contact_force_ = std::move(state.contact_force);
    failed_solves_ = state.failed_solves;
    take_over_bodies();
    place_gates(time_);
    cutter_.cut(bodies_, cells_);
    find_surface();
}

void SurfaceRun::take_over_bodies() {
    bodies_ = bodies_of(engine_, settings_);
}

void SurfaceRun::place_gates(double time) {
    if (settings_.gates.empty()) return;
    gates_.clear();
    for (const Gate& gate : settings_.gates) gates_.push_back(gate.at(time));
    cutter_.set_gates(gates_);
}

void SurfaceRun::find_surface() {
    map_fraction(grid_, particles_, fraction_);
    find_water(grid_, fraction_, cells_, water_);
}

double SurfaceRun::choose_step(double longest) const {
    const double h = grid_.spacing();
    double step =
        std::min({longest, settings_.run.longest_step, k_gravity_courant * std::sqrt(h / std::max(1e-12, settings_.gravity.norm()))});
    const double speed = largest_speed(particles_);
    if (speed > 0.0) step = std::min(step, settings_.run.max_courant * h / speed);
    for (const Body& body : bodies_) {
        if (body.velocity.norm() > 0.0) step = std::min(step, k_solid_travel * h / body.velocity.norm());
    }
    for (const Gate& gate : settings_.gates) {
        for (const double event : {gate.start, gate.end}) {
            if (event > time_ + k_same_time) step = std::min(step, event - time_);
        }
        if (gate.rise(time_ + step) > gate.rise(time_)) step = std::min(step, k_solid_travel * h / gate.speed);
    }
    const double viscosity = settings_.water.kinematic_viscosity;
    if (viscosity > 0.0) step = std::min(step, h * h / (4.0 * viscosity * static_cast<double>(grid_.directions().size())));
    return step;
}

const StepReport& SurfaceRun::step(double longest) {
    report_ = StepReport{};
    const double step = choose_step(longest);
    report_.step = step;
    lift_.clear();
    for (const Gate& gate : settings_.gates) lift_.push_back((gate.rise(time_ + step) - gate.rise(time_)) / step);
    const bool gates_move = std::any_of(lift_.begin(), lift_.end(), [](double speed) { return speed > 0.0; });
    if (steps_++ % k_steps_between_sorts == 0) sort_by_cell(grid_, particles_);
    map_to_grid(grid_, cutter_.slip_walls(), particles_, mapped_);
    find_water(grid_, mapped_.fraction, cells_, water_);
    fill_unmapped_faces();
    add_body_forces(step);
    predict_bodies(step);
    solve_pressure(step);
    require_pressure();
    push_bodies(step);
    push_water();
    book_walls(step);
    extend_velocity(step);
    std::array<std::vector<double>, 3> before;
    if (!settings_.watched_walls.empty()) before = particles_.position;
    const double kept = 1.0 - (mixing_time_ > 0.0 ? std::min(1.0, step / mixing_time_) : 1.0);
    move_particles(grid_, cutter_.slip_walls(), {velocity_, increment_, step, kept}, particles_);
    move_bodies(step);
    if (settings_.damping.remaining < 1.0)
        report_.gap_impulse =
            damp_gaps(settings_.damping, grid_, {bodies_, settings_.solids, gates_, lift_}, step, settings_.water.density, particles_);
    if (gates_move) place_gates(time_ + step);
    if (gates_move || !bodies_.empty()) cutter_.cut(bodies_, cells_);
    push_out();
    find_surface();
    if (settings_.run.even_out) {
        report_.even_out = even_out_.apply(cells_, cutter_.slip_walls(), water_, particles_);
        push_out();
    }
    if (!settings_.watched_walls.empty()) report_.through_walls = count_through_walls(before);
    report_.occupied_volume = occupied_volume(grid_, cells_, water_);
    time_ += step;
    report_.time = time_;
    check();
    return report_;
}

/// Faces of water that no particle reaches take the mean of their neighbours.
void SurfaceRun::fill_unmapped_faces() {
    for (const int d : grid_.directions()) {
        const int stride = grid_.stride(d);
        for (const int cell : water_.water) {
            for (const int face : {cell, cell + stride}) {
                if (mapped_.share[d][face] > 0.0 || cells_.open[d][face] <= 0.0) continue;
                double sum = 0.0;
                int count = 0;
                for (const int e : grid_.directions()) {
                    for (const int neighbour : {face - grid_.stride(e), face + grid_.stride(e)}) {
                        if (mapped_.share[d][neighbour] <= 0.0) continue;
                        sum += mapped_.velocity[d][neighbour];
                        ++count;
                    }
                }
                mapped_.velocity[d][face] = count > 0 ? sum / count : 0.0;
            }
        }
    }
}

void SurfaceRun::add_body_forces(double step) {
    for (const int d : grid_.directions()) {
        velocity_[d] = mapped_.velocity[d];
        const double change = step * settings_.gravity[d];
        if (change == 0.0) continue;
        grid_.for_each_face(d, [&](int face, int, int, int) {
            if (cells_.open[d][face] > 0.0) velocity_[d][face] += change;
        });
    }
    if (settings_.water.kinematic_viscosity > 0.0) add_viscosity(step, velocity_);
}

/// nu div(grad u + grad u^T) of the mapped velocity, stresses in water alone: the surface and the tank's walls bear none, solids hold the
/// water in their covered faces.
void SurfaceRun::add_viscosity(double step, FaceField& change) const {
    const double scale = step * settings_.water.kinematic_viscosity / (grid_.spacing() * grid_.spacing());
    const auto velocity = [&](int d, int face) {
        if (cells_.open[d][face] > 0.0) return mapped_.velocity[d][face];
        const int owner = cells_.owner[d][face];
        if (owner <= k_first_gate) return d == 2 ? lift_[k_first_gate - owner] : 0.0;
        return owner == k_no_body ? 0.0 : bodies_[owner].velocity[d];
    };
    const auto is_wet = [&](int cell) { return water_.kind[cell] != CellKind::air; };
    const auto add = [&](int d, int face, double value) {
        if (cells_.open[d][face] > 0.0) change[d][face] += value;
    };
    for (const int d : grid_.directions()) {
        const int along = grid_.stride(d);
        for (const int cell : water_.water) {
            const double normal = 2.0 * scale * (velocity(d, cell + along) - velocity(d, cell));
            add(d, cell, normal);
            add(d, cell + along, -normal);
        }
        for (const int e : grid_.directions()) {
            if (e <= d) continue;
            const int across = grid_.stride(e);
            grid_.for_each_cell([&](int cell, int i, int j, int k) {
                const std::array<int, 3> place{i, j, k};
                if (place[d] == 0 || place[e] == 0) return;  // the tank's walls are free of shear
                const int left = cell - along, low = cell - across, both = left - across;
                if (!is_wet(cell) || !is_wet(left) || !is_wet(low) || !is_wet(both)) return;
                const double shear = scale * (velocity(d, cell) - velocity(d, low) + velocity(e, cell) - velocity(e, left));
                add(d, cell, -shear);
                add(d, low, shear);
                add(e, cell, -shear);
                add(e, left, shear);
            });
        }
    }
}

void SurfaceRun::predict_bodies(double step) {
    predicted_ = bodies_;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        if (!bodies_[b].held) predicted_[b].velocity += step * (settings_.gravity + contact_force_[b] / bodies_[b].mass);
    }
}

void SurfaceRun::solve_pressure(double step) {
    const double h = grid_.spacing(), density = settings_.water.density;
    const double cell_mass = density * grid_.face_area() * h;
    system_.assemble(water_, cells_, bodies_, cell_mass);
    right_side_.assign(system_.unknowns(), 0.0);
    q_.resize(system_.unknowns());
    for (std::size_t r = 0; r < right_side_.size(); ++r) {
        const int cell = system_.cell(r);
        double outflow = 0.0;
        for (const int d : grid_.directions()) {
            const int above = cell + grid_.stride(d);
            outflow += cells_.open[d][above] * velocity_[d][above] - cells_.open[d][cell] * velocity_[d][cell];
        }
        right_side_[r] = -h * outflow;
        q_[r] = pressure_[cell] * step / density;
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const Body& body = predicted_[b];
        for (const BodyCell& entry : cells_.bodies[b]) {
            const int row = system_.row(entry.cell);
            if (row < 0) continue;
            right_side_[row] -= h * entry.k.dot(body.velocity);
        }
    }
    for (std::size_t n = 0; n < lift_.size(); ++n) {
        for (const BodyCell& entry : cells_.gates[n]) {
            const int row = system_.row(entry.cell);
            if (row >= 0) right_side_[row] -= h * entry.k.z() * lift_[n];
        }
    }
    const double tolerance = settings_.run.pressure_tolerance * (steps_ == 1 ? k_first_tolerance : 1.0);
    report_.pressure = system_.solve(right_side_, tolerance, q_);
    failed_solves_ = report_.pressure.converged ? 0 : failed_solves_ + 1;
    report_.enclosed_waters = system_.enclosed_waters();
    std::fill(potential_.begin(), potential_.end(), 0.0);
    for (std::size_t r = 0; r < q_.size(); ++r) potential_[system_.cell(r)] = q_[r];
}

void SurfaceRun::push_bodies(double step) {
    const double density = settings_.water.density;
    for (std::size_t c = 0; c < grid_.size(); ++c) pressure_[c] = potential_[c] * density / step;
    report_.body_force.assign(bodies_.size(), Vec3::Zero());
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        for (const BodyCell& entry : cells_.bodies[b]) report_.body_force[b] += pressure_[entry.cell] * grid_.face_area() * entry.k;
        if (!bodies_[b].held) predicted_[b].velocity += step / bodies_[b].mass * report_.body_force[b];
    }
}

/// The impulse is summed over what the faces' velocities gain, not over the pressure.
void SurfaceRun::push_water() {
    const double cell_mass = settings_.water.density * grid_.cell_volume();
    for (const int d : grid_.directions()) {
        const int stride = grid_.stride(d);
        for_each_gradient(grid_, cells_, water_, potential_, d, [&](int face, double change) {
            velocity_[d][face] -= change;
            const bool wet_below = water_.kind[face - stride] == CellKind::water, wet = water_.kind[face] == CellKind::water;
            const double distance = wet && wet_below ? 1.0
                                    : wet            ? surface_distance(water_.fraction[face], water_.fraction[face - stride])
                                                     : surface_distance(water_.fraction[face - stride], water_.fraction[face]);
            report_.impulses.water[d] -= cell_mass * distance * cells_.open[d][face] * change;
        });
    }
}

void SurfaceRun::book_walls(double step) {
    for (const int d : grid_.directions()) {
        const int stride = grid_.stride(d);
        for (const int cell : water_.water) {
            const double covered = cells_.open[d][cell] - cells_.open[d][cell + stride];
            report_.impulses.walls[d] += step * pressure_[cell] * grid_.face_area() * covered;
        }
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        report_.impulses.bodies += step * report_.body_force[b];
        for (const BodyCell& entry : cells_.bodies[b]) {
            report_.impulses.walls -= step * pressure_[entry.cell] * grid_.face_area() * entry.k;
        }
    }
}

/// Beyond the faces on which pressure acted: two layers are extrapolated, what flies farther out is under gravity alone, and one layer more
/// has the values that particles meet within a step. Faces that a solid covers wholly hold its velocity: no slip.
void SurfaceRun::extend_velocity(double step) {
    std::vector<int> front;
    for (const int d : grid_.directions()) {
        mark_held_faces(grid_, cells_, d, values_);
        front.clear();
        const auto pressed = [&](int face) {
            if (values_[face] != FaceValue::none) return;
            values_[face] = FaceValue::present;
            increment_[d][face] = velocity_[d][face] - mapped_.velocity[d][face];
            front.push_back(face);
        };
        for (const int cell : water_.water) {
            pressed(cell);
            pressed(cell + grid_.stride(d));
        }
        extrapolate(grid_, k_extended_layers, values_, front, {&velocity_[d], &increment_[d]});
        front.clear();
        grid_.for_each_face(d, [&](int face, int, int, int) {
            if (values_[face] == FaceValue::none && mapped_.share[d][face] > 0.0) {
                values_[face] = FaceValue::present;
                increment_[d][face] = step * settings_.gravity[d];
            }
            if (values_[face] == FaceValue::present) front.push_back(face);
        });
        extrapolate(grid_, 1, values_, front, {&velocity_[d], &increment_[d]});
        hold_solid_faces(d);
    }
    mirror_faces(grid_, velocity_);
    mirror_faces(grid_, increment_);
}

void SurfaceRun::hold_solid_faces(int d) {
    grid_.for_each_face(d, [&](int face, int i, int j, int k) {
        if (cells_.open[d][face] > 0.0) return;
        double held = 0.0;
        if (const int owner = cells_.owner[d][face]; owner >= 0) {
            Vec3 place = grid_.centre(i, j, k);
            place[d] -= 0.5 * grid_.width(d);
            if (!predicted_[owner].sphere) place.y() = predicted_[owner].position.y();
            held = velocity_at(predicted_[owner], place)[d];
        } else if (owner <= k_first_gate && d == 2) {
            held = lift_[k_first_gate - owner];
        }
        velocity_[d][face] = held;
        increment_[d][face] = held - mapped_.velocity[d][face];
    });
}

void SurfaceRun::move_bodies(double step) {
    report_.contact_force.assign(bodies_.size(), Vec3::Zero());
    if (!engine_ || bodies_.empty()) return;
    const std::vector<Vec3>& force = report_.body_force;
    const coupling::DemStep moved = engine_->advance(step, [&](std::size_t index, const Vec3&) { return force[index]; });
    if (moved.left.size() > 0)
        throw CheckFailure({"", fmt::format("Body {} left the tank at {} {}", moved.left.id[0], text_of(moved.left.position[0]), moment()),
                            "Bodies stay between the tank's walls", "Give it less velocity, or look for what presses it through a wall"});
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        contact_force_[b] = moved.contact_impulse[b] / step;
        const double size = step * force[b].norm();
        const double error = size > 0.0 ? (moved.impulse[b] - step * force[b]).norm() / size : 0.0;
        if (!(error <= report_.body_impulse_error)) report_.body_impulse_error = error;  // keeps what is no number
    }
    report_.contact_force = contact_force_;
    take_over_bodies();
}

/// Particles in solids go to the surface. What still walls and gates stop, loses its velocity into them: a face that is open in part drives
/// water against the closed part, and what is put back there step by step would gain velocity in each.
void SurfaceRun::push_out() {
    if (cells_.cut.empty() && bodies_.empty()) return;
    for (std::size_t p = 0; p < particles_.size(); ++p) {
        Vec3 place = particles_.place(p);
        if (cells_.open_volume[cell_of(grid_, place)] >= 1.0) continue;
        bool inside = false;
        Vec3 velocity = particles_.speed(p);
        const auto leave = [&](const StillSolid& solid, double lift) {
            if (const auto way = way_out(solid, place)) {
                inside = true;
                const double depth = (*way - place).norm();
                const Vec3 outward = (*way - place) / depth;
                report_.deepest = std::max(report_.deepest, depth);
                place = *way + k_off_walls * grid_.spacing() * outward;
                velocity += std::max(0.0, lift * outward.z() - velocity.dot(outward)) * outward;
            }
        };
        for (const StillSolid& solid : settings_.solids) leave(solid, 0.0);
        for (std::size_t n = 0; n < gates_.size(); ++n) leave(gates_[n], n < lift_.size() ? lift_[n] : 0.0);
        cells_.covering.for_each(cell_of(grid_, place), [&](int number) {
            const Body& body = bodies_[number];
            Vec3 arm = place - body.position;
            if (!body.sphere) arm.y() = 0.0;
            const double distance = arm.norm();
            if (distance >= body.radius || distance == 0.0) return;
            inside = true;
            report_.deepest = std::max(report_.deepest, body.radius - distance);
            place += arm * (body.radius / distance - 1.0);
        });
        if (!inside) continue;
        ++report_.pushed_out;
        keep_in_tank(grid_, place);
        for (const int d : grid_.directions()) {
            particles_.position[d][p] = place[d];
            particles_.velocity[d][p] = velocity[d];
        }
    }
}

int SurfaceRun::count_through_walls(const std::array<std::vector<double>, 3>& before) const {
    int count = 0;
    for (const WatchedWall& wall : settings_.watched_walls) {
        for (std::size_t p = 0; p < particles_.size(); ++p) {
            const double from = before[0][p] - wall.x, to = particles_.position[0][p] - wall.x;
            if ((from < 0.0) == (to < 0.0)) continue;
            const double height = before[2][p] + from / (from - to) * (particles_.position[2][p] - before[2][p]);
            count += height > wall.from_z && height < wall.to_z;
        }
    }
    return count;
}

double SurfaceRun::energy() const {
    const double mass = settings_.water.density * particles_.volume;
    double sum = 0.0;
    for (std::size_t p = 0; p < particles_.size(); ++p) {
        sum += mass * (0.5 * particles_.speed(p).squaredNorm() - settings_.gravity.dot(particles_.place(p)));
    }
    return sum;
}

std::string SurfaceRun::text_of(const Vec3& place) const {
    if (grid_.is_plane()) return fmt::format("({:.4g}, {:.4g}) m", place.x(), place.z());
    return fmt::format("({:.4g}, {:.4g}, {:.4g}) m", place.x(), place.y(), place.z());
}

std::string SurfaceRun::text_of(int cell) const {
    const std::array<int, 3> place = grid_.place(cell);
    return text_of(grid_.centre(place[0], place[1], place[2]));
}

/// Where particles crowd most, or in water that won volume are fewest.
int SurfaceRun::worst_filled_cell(bool lost) const {
    int worst = -1;
    for (const int cell : water_.water) {
        if (!lost && is_beside_air(grid_, cells_, water_, cell)) continue;
        const double more = worst < 0 ? 1.0 : water_.fraction[cell] - water_.fraction[worst];
        if (worst < 0 || (lost ? more > 0.0 : more < 0.0)) worst = cell;
    }
    return worst;
}

std::string SurfaceRun::moment() const {
    return fmt::format("at {:.6g} s, in a step of {:.3g} s", time_, report_.step);
}

/// Before bodies take it: the DEM must not be given what is no number.
void SurfaceRun::require_pressure() const {
    if (std::isfinite(report_.pressure.residual)) return;
    throw CheckFailure({"",
                        fmt::format("The pressure of the water is no number near {} {}", text_of(report_.pressure.worst_cell), moment()),
                        "It must be finite", "Halve the Courant number, or look for a solid that squeezes water"});
}

void SurfaceRun::check() const {
    const double speed = largest_speed(particles_);
    if (!(speed <= fastest_allowed_)) {
        throw CheckFailure(
            {"",
             fmt::format("Water flies at {:.4g} m/s near {} {}", speed, text_of(particles_.place(fastest_particle(particles_))), moment()),
             fmt::format("It must stay below {:.4g} m/s, 50 sqrt(g H)", fastest_allowed_),
             "Halve the Courant number, or look for a solid that squeezes water"});
    }
    const double lost = initial_volume_ > 0.0 ? report_.occupied_volume / initial_volume_ - 1.0 : 0.0;
    if (!(std::abs(lost) <= settings_.run.volume_limit)) {
        const int cell = worst_filled_cell(lost < 0.0);
        throw CheckFailure({"",
                            fmt::format("The water occupies {:+.2f} % of its volume more than at the start {}{}", 100.0 * lost, moment(),
                                        cell < 0 ? "" : ", most of it near " + text_of(cell)),
                            fmt::format("At most {:g} % may be lost or won", 100.0 * settings_.run.volume_limit),
                            "Use smaller cells, or a larger contact gap"});
    }
    if (failed_solves_ > 1) {
        throw CheckFailure({"",
                            fmt::format("The pressure did not converge twice {}: residual {:.2g}, largest near {}", moment(),
                                        report_.pressure.residual, text_of(report_.pressure.worst_cell)),
                            fmt::format("It must fall to {:g}", settings_.run.pressure_tolerance), "Halve the Courant number"});
    }
}

}  // namespace cutterflow::free_surface
