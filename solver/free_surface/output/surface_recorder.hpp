#pragma once
/// \file What a free-surface run writes: rows (CSV) and fields for ParaView.
#include <filesystem>
#include <fstream>

#include "solver/free_surface/output/scene_gauges.hpp"

namespace cutterflow::free_surface {

/// Writes below <folder>/postProcessing: balance/<t0>/balance.csv, levels/<t0>/levels.csv and, with gauges, gauges/<t0>/gauges.csv (every
/// step), bodies/<t0>/bodies.csv, water/vtk/*.vti, particles/vtk/*.vtp and bodies/vtk/*.vtp with a .pvd each (at outputs). A resumed run
/// opens rows of its own start time t0.
class SurfaceRecorder {
public:
    /// \param every  of how many water particles one is written; 0: none
    SurfaceRecorder(const std::filesystem::path& folder, double start_time, std::vector<Gauge> gauges, int every);

    void step(const SurfaceRun& run, const SceneReading& reading, double core_seconds);
    void output(const SurfaceRun& run, const coupling::DemEngine* bodies);
    /// Brings all rows to the files. \throws Failure  when they cannot be written
    void flush();

private:
    void write_water(const SurfaceRun& run, const std::string& name) const;
    void write_particles(const SurfaceRun& run, const std::string& name) const;
    void write_bodies(const SurfaceRun& run, const std::string& name) const;
    void write_series(const std::string& what, const std::string& extension) const;

    std::filesystem::path folder_;
    std::vector<Gauge> gauges_;
    int every_;
    std::ofstream balance_, levels_, rows_, gauge_rows_;
};

}  // namespace cutterflow::free_surface
