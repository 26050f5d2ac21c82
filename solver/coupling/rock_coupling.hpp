#pragma once
/// \file What CoupledRun asks of a coupling method: rock in, rock moved, rock out, and what the fluid gets of it.
#include <string>
#include <vector>

#include <gsl/span>

#include "solver/coupling/feed/rock_feed.hpp"
#include "solver/observe/limiter_counts.hpp"
#include "solver/ports/dem_engine.hpp"
#include "solver/ports/fluid_engine.hpp"

namespace cutterflow::coupling {

/// Conservation errors and maximum solid fraction of one step.
struct ExchangeBalance {
    double solid_volume_error = 0.0;  ///< |solid volume of mapping and of the fluid's cells - volume of rock| / volume of rock
    double deposit_error = 0.0;  ///< |momentum laid into cells - that of the rocks| / (sum |impulse| + carry); says nothing of the fluid
    double solid_fraction_max = 0.0;
    int overfull_cells = 0;  ///< of the whole mesh, with more than kernel.maxSolidFraction: no cell in reach had room
    LimiterCounts limited;
};

/// Fluid displaced at insertion of rock, less fluid that replaced removed rock; no source in the fluid's equations.
struct BookedExchange {
    double volume = 0.0;           ///< [m3]
    Vec3 momentum = Vec3::Zero();  ///< of that fluid [N s]
};

/// One step's exchange. Call in order: insert (when rock is due), sample, move, map, book.
class RockCoupling {
public:
    virtual ~RockCoupling() = default;

    /// Puts rock into the run at the present time. \return ids of `due` that found no place
    virtual std::vector<int> insert(const std::vector<FeedRock>& due) = 0;
    /// Whether rock of the feed has room in the DEM.
    virtual std::vector<bool> room_for(const std::vector<FeedRock>& rocks) const = 0;
    /// Rock of another run is in the DEM: displaces fluid without a source.
    virtual void adopt_present_rock() = 0;
    /// Takes rock out of the run.
    virtual void remove(gsl::span<const int> ids) = 0;

    /// Samples the flow at every rock.
    virtual void sample() = 0;
    /// Longest step [s] that the rock's motion allows; infinity: any.
    virtual double travel_limit() const = 0;
    /// Moves the rocks over the fluid's time step with the sampled flow.
    virtual const DemStep& move() = 0;
    /// Builds both void fractions and the momentum exchange on the moved mesh.
    virtual void map() = 0;
    virtual gsl::span<const double> void_fraction_old() const = 0;
    virtual gsl::span<const double> void_fraction_new() const = 0;
    virtual MomentumExchange exchange() const = 0;
    /// Updates the carry from the momentum that the fluid received.
    virtual ExchangeBalance book() = 0;

    /// New warnings since the last call.
    virtual std::vector<std::string> take_warnings() = 0;

    /// What a checkpoint keeps: momentum per mixture volume over the fluid's density that this rank's cells have yet to receive [m/s], and
    /// the booked exchange.
    virtual const std::vector<Vec3>& carry() const = 0;
    virtual const BookedExchange& booked() const = 0;
    virtual void restore(std::vector<Vec3> carry, const BookedExchange& booked) = 0;
};

}  // namespace cutterflow::coupling
