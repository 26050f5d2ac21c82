#pragma once
/// \file From a study to its report: the work of every stage of a run directory.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases/runner/prediction.hpp"
#include "cases/runner/run_directory.hpp"
#include "cases/runner/stages.hpp"
#include "cases/study/study.hpp"
#include "geometry/head/contour.hpp"
#include "geometry/head/revolution_contour.hpp"
#include "meshing/cutter/mesh_report.hpp"

namespace cutterflow::cases {

/// How a study is computed; no part of what is computed.
struct PipelineSettings {
    std::filesystem::path study_file;
    int ranks = 1;
    std::filesystem::path solver;      ///< cutterFoam
    std::filesystem::path start_from;  ///< a run directory whose frozen-rotor flow is taken if it is the same; empty: none
};

/// What a run directory's geometry stage left behind.
struct RunHead {
    HeadSize size;
    geometry::RevolutionContour profile;
    geometry::Contour with_backplate(double z_backplate) const;
};

/// \throws UserError  when geometry/geometry.json or contour.csv is missing or not as the geometry stage writes them
RunHead read_run_head(const RunDirectory& directory);

/// The stages of one study in one run directory.
class Pipeline {
public:
    using Say = std::function<void(const std::string&)>;

    /// \param say  receives lines for the user (warnings, results of a stage)
    /// \throws UserError  with every mistake of the study file
    Pipeline(const RunDirectory& directory, PipelineSettings settings, Say say);

    /// geometry, mesh, case, start, run, report. They refer to this object.
    std::vector<Stage> stages();

    /// Message of a stage that failed because the disk is full; none when it is not.
    std::optional<Mistake> full_disk() const;

private:
    StageOutcome make_geometry();
    StageOutcome make_mesh();
    /// One attempt. `outputs` receives the files of the mesh's case.
    meshing::MeshReport make_mesh_of(const meshing::MeshPlan& plan, const std::vector<meshing::MeshRetry>& retries,
                                     std::vector<std::string>& outputs);
    StageOutcome make_case();
    StageOutcome make_start();
    StageOutcome run_solver();
    StageOutcome make_report();
    void make_adv_report(const std::filesystem::path& points) const;

    /// \throws UserError  when check_study finds mistakes
    ParameterValues checked_values(const HeadSize& head) const;
    Study resolved_study(const HeadSize& head) const;
    void write_resolved_study(const HeadSize& head) const;
    Prediction predicted(const Study& study, const HeadSize& head) const;
    void say_cost(double core_s) const;  ///< actual beside predicted

    const RunDirectory& directory_;
    PipelineSettings settings_;
    Say say_;
    ParameterValues values_;
};

/// The keys of a study that a stage depends on, by name and value; the cutter's file by its content.
std::map<std::string, std::string> stage_inputs(const ParameterValues& values, const std::filesystem::path& study_folder,
                                                const std::string& stage);

}  // namespace cutterflow::cases
