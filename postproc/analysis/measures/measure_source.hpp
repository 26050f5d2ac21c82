#pragma once
/// \file What a finished run left behind for its measures: pictures of the grains, crossings of gates, forces on walls, probes.
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "postproc/analysis/measures/grains.hpp"
#include "postproc/analysis/measures/rates.hpp"
#include "postproc/run/run_table.hpp"

namespace cutterflow::postproc {

/// Values over time.
struct Signal {
    std::vector<double> time, value;  ///< time increasing [s]
};

/// Reads files when they are asked for; the last picture that was read is kept.
class MeasureSource {
public:
    explicit MeasureSource(std::filesystem::path run_directory);

    const std::filesystem::path& directory() const { return directory_; }

    /// Times of the pictures (postProcessing/rock/vtk) that the run shows in rocks.pvd. \throws UserError  when there are none
    const std::vector<double>& picture_times() const;
    /// Index of the picture nearest to a time; the last one without a time.
    std::size_t picture_near(std::optional<double> time) const;
    /// \throws UserError  when the picture cannot be read, or lacks the grains' density (written by an earlier version)
    const Grains& grains(std::size_t picture) const;

    /// Mass through a gate along its normal less that against it. \throws UserError  when the run recorded no gates, or has none of this
    /// name
    PassedMass through_gate(const std::string& gate) const;
    /// Mass that has left a region since the start of the run. Where the run does not tell which grains there were (no events.csv) it is
    /// that since the first picture, and not whole.
    PassedMass out_of_region(const Region& region) const;

    /// Force of rock on a wall; component x, y, z or magnitude.
    /// \throws UserError  when the run recorded no forces, or none on this wall
    Signal wall_force(const std::string& wall, const std::string& component) const;
    /// A column of a table of postProcessing/ ("loads/loads.csv").
    Signal column(const std::string& table, const std::string& column) const;
    /// Difference of the first two places of a set of probes of p [m2/s2]: postProcessing/<name>/<t0>/p.
    Signal probe_difference(const std::string& name) const;

private:
    double end() const;
    std::optional<Grains> grains_at_start(double start) const;
    void require_gate(const std::string& gate) const;
    double removed_at(const std::string& wall) const;

    std::filesystem::path directory_;
    mutable std::vector<double> times_;
    mutable std::vector<std::filesystem::path> pictures_;
    mutable std::optional<std::pair<std::size_t, Grains>> last_;
};

/// The grains of a picture. \throws UserError  as MeasureSource::grains
Grains read_picture(const std::filesystem::path& file);

}  // namespace cutterflow::postproc
