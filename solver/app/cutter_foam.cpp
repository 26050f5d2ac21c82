/// \file cutterFoam: the coupled solver, an ordinary OpenFOAM application. On a case without constant/couplingProperties, or without its
/// section `rock`, it is a pure flow solver.
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>

#include <mpi.h>

#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/versions.hpp"
#include "solver/app/models_in_use.hpp"
#include "solver/coupling/coupled_run.hpp"
#include "solver/coupling/feed/rock_feed.hpp"
#include "solver/foam/dictionary/coupling_dictionary.hpp"
#include "solver/foam/foam_fluid_engine.hpp"
#include "solver/foam/session/case_errors.hpp"
#include "solver/foam/session/foam_session.hpp"
#include "solver/foam/session/openfoam_installation.hpp"
#include "solver/foam/session/pstream_communicator.hpp"
#include "solver/liggghts/liggghts_engine.hpp"
#include "solver/observe/csv_recorder.hpp"

namespace {

using namespace cutterflow;

void print_models(const std::vector<coupling::ModelNote>& models) {
    std::cout << "Models that are on:\n";
    for (const coupling::ModelNote& model : models) std::cout << "    " << model.name << "  (" << model.why << ")\n";
    std::cout << std::endl;
}

/// The feed alone does not know the domain, which ends what can be placed.
void require_feed_in_domain(const foam::CouplingDictionary& dictionary) {
    if (!dictionary.dem) return;
    coupling::read_rock_feed(dictionary.coupling.rock_feed,
                             [&](const Vec3& place) { return coupling::contains(dictionary.dem->domain, place); });
}

/// Of the rank that writes.
std::unique_ptr<coupling::RunRecorder> make_recorder(const foam::FoamSession& session, const foam::CouplingDictionary& dictionary,
                                                     const foam::FoamFluidEngine& fluid) {
    auto recorder = std::make_unique<coupling::CsvRecorder>(session.case_folder(), dictionary.coupling, fluid.time());
    const auto versions = build_versions();
    const std::vector<coupling::ModelNote> models = models_in_use(dictionary, fluid);
    recorder->describe(models, {versions.begin(), versions.end()});
    print_models(models);
    return recorder;
}

void run(int argc, char** argv) {
    foam::require_openfoam_of_build();
    foam::FoamSession session(argc, argv);
    foam::PstreamCommunicator communicator;
    foam::CouplingDictionary dictionary = foam::read_coupling_dictionary(session);
    require_feed_in_domain(dictionary);

    foam::FoamFluidEngine fluid(session, dictionary.coupling.has_rock, dictionary.coupling.patches);
    std::unique_ptr<liggghts::LiggghtsEngine> dem;
    if (dictionary.dem) {
        dictionary.dem->log = session.case_folder() / "log.liggghts";
        const auto moving = fluid.moving_zones();
        dem = std::make_unique<liggghts::LiggghtsEngine>(*dictionary.dem, std::vector(moving.begin(), moving.end()), MPI_COMM_WORLD);
    }
    std::unique_ptr<coupling::RunRecorder> recorder = std::make_unique<coupling::SilentRecorder>();
    if (communicator.rank() == 0) recorder = make_recorder(session, dictionary, fluid);

    coupling::CoupledRun coupled(dictionary.coupling, fluid.fluid_properties(), fluid, dem.get(), communicator, *recorder,
                                 session.case_folder());
    const auto checkpoint = newest_checkpoint(session.case_folder());
    if (!checkpoint.empty()) coupled.resume(checkpoint);

    while (fluid.running() && !coupled.finished()) coupled.step();
    coupled.finish();
}

/// Reports why the run ends, and ends all ranks with the failure's code. Failures are thrown on every rank and told once; what OpenFOAM
/// finds in a file, and a defect, may have struck one rank alone, so that the others must be stopped.
int explain(const std::exception& error) {
    int started = 0;
    MPI_Initialized(&started);
    int rank = 0, ranks = 1;
    if (started != 0) {
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    }
    const auto* failure = dynamic_cast<const Failure*>(&error);
    const int code = static_cast<int>(failure != nullptr ? failure->code() : ExitCode::defect);
    const bool on_all_ranks = failure != nullptr && dynamic_cast<const foam::CaseFileError*>(&error) == nullptr;
    if (rank == 0 || !on_all_ranks) std::cerr << "cutterFoam: " << error.what() << std::endl;
    if (!on_all_ranks && (ranks > 1 || (failure == nullptr && started != 0))) MPI_Abort(MPI_COMM_WORLD, code);
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 2 && std::string(argv[1]) == "-version") {
        std::cout << build_versions_text();
        return static_cast<int>(ExitCode::done);
    }
    int code = static_cast<int>(ExitCode::done);
    try {
        run(argc, argv);
    } catch (const std::exception& error) {
        code = explain(error);
    }
    return code;
}
