#pragma once
/// \file A tiny case with its engine, and exchange arrays of the right length.
#include <functional>
#include <limits>
#include <vector>

#include "solver/foam/foam_fluid_engine.hpp"
#include "solver/foam/session/foam_session.hpp"
#include "solver/foam/session/pstream_communicator.hpp"
#include "solver/foam/tests/tiny_case.hpp"

namespace cutterflow::foam::testing {

class FluidRun {
public:
    FluidRun(const std::filesystem::path& case_folder, bool with_rock, const coupling::PatchSettings& patches = {},
             const std::optional<coupling::SoilSettings>& soil = {})
        : session_(case_folder),
          engine_(session_, with_rock, patches, soil),
          source(cells(), Vec3::Zero()),
          drag_rate(cells(), 0.0),
          inertia(cells(), 0.0) {}

    FoamSession& session() { return session_; }
    FoamFluidEngine& engine() { return engine_; }
    std::size_t cells() const { return engine_.cells().centres.size(); }

    /// Where a cell's centre stands now.
    Vec3 centre(std::size_t cell) const {
        const coupling::Cells all = engine_.cells();
        if (all.zone[cell] == coupling::k_still_zone) return all.centres[cell];
        const coupling::ZoneMotion& motion = engine_.moving_zones()[all.zone[cell] - 1u];
        return rotate_about(motion.axis, motion.angle(engine_.time()), all.centres[cell]);
    }

    std::vector<double> evaluate(const std::function<double(const Vec3&)>& field) const {
        std::vector<double> values(cells());
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = field(centre(i));
        return values;
    }

    void begin() { engine_.begin_step(std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()); }
    void end(const std::vector<double>& old_fraction, const std::vector<double>& new_fraction) {
        engine_.end_step(old_fraction, new_fraction, {source, drag_rate, inertia});
    }

    /// Largest distance of the velocity from `expected`, over all ranks.
    double deviation(const Vec3& expected) {
        double worst = 0.0;
        for (const Vec3& u : engine_.fields().velocity) worst = std::max(worst, (u - expected).norm());
        return largest(worst);
    }
    double largest(double value) {
        communicator_.max({&value, 1});
        return value;
    }
    double total(double value) {
        communicator_.sum({&value, 1});
        return value;
    }

private:
    FoamSession session_;
    FoamFluidEngine engine_;
    PstreamCommunicator communicator_;

public:
    std::vector<Vec3> source;
    std::vector<double> drag_rate;
    std::vector<double> inertia;
};

}  // namespace cutterflow::foam::testing
