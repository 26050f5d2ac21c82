#pragma once
/// \file The DEM port on LIGGGHTS, in the same process.
#include <memory>

#include <mpi.h>

#include "solver/ports/dem_engine.hpp"
#include "solver/ports/dem_settings.hpp"
#include "solver/ports/fluid_engine.hpp"

namespace cutterflow::liggghts {

/// Rocks with contacts, walls and added mass (see rock_motion.hpp for the equation of motion, contacts/ for the contact law).
/// MPI must have been initialised. LIGGGHTS ends the process itself when one of its own checks fails; everything that comes from the user
/// is therefore checked before.
class LiggghtsEngine final : public coupling::DemEngine {
public:
    /// \param moving  of the fluid's mesh, one at most; rotating walls turn with it by its speed times the time
    /// \throws UserError  with every mistake of the settings: bounds, walls that cannot be read
    LiggghtsEngine(const coupling::DemSettings& settings, std::vector<coupling::ZoneMotion> moving, MPI_Comm communicator);
    ~LiggghtsEngine() override;

    const coupling::Rocks& rocks() const override;
    double largest_time_step() const override;
    std::vector<bool> room_for(const coupling::Rocks& rocks) const override;
    std::vector<int> insert(const coupling::Rocks& rocks) override;
    void remove(gsl::span<const int> ids) override;
    std::vector<int> frozen() const override;
    void freeze(gsl::span<const int> ids) override;
    void thaw(gsl::span<const int> ids) override;
    double walls_change_until() const override;
    coupling::DemStep advance(double duration, const coupling::HydrodynamicForce& force) override;
    std::vector<coupling::WallWork> wall_work() const override;
    std::vector<double> zone_angles() const override;
    void write_checkpoint(const std::filesystem::path& folder) override;
    void read_checkpoint(const std::filesystem::path& folder) override;
    void start_from(const std::filesystem::path& folder) override;

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace cutterflow::liggghts
