/// \file cutterFoam: the coupled solver, an ordinary OpenFOAM application. On a case without constant/couplingProperties, or without its
/// section `rock`, it is a pure flow solver.
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <mpi.h>

#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/process/child_process.hpp"
#include "geometry/base/versions.hpp"
#include "solver/app/models_in_use.hpp"
#include "solver/app/stop_request.hpp"
#include "solver/coupling/coupled_run.hpp"
#include "solver/coupling/dry/no_fluid.hpp"
#include "solver/coupling/feed/rock_feed.hpp"
#include "solver/foam/dictionary/coupling_dictionary.hpp"
#include "solver/foam/foam_fluid_engine.hpp"
#include "solver/foam/session/case_errors.hpp"
#include "solver/foam/session/case_times.hpp"
#include "solver/foam/session/foam_session.hpp"
#include "solver/foam/session/openfoam_installation.hpp"
#include "solver/foam/session/pstream_communicator.hpp"
#include "solver/liggghts/liggghts_engine.hpp"
#include "solver/observe/csv_recorder.hpp"
#include "solver/replay/frozen_fluid.hpp"

namespace {

using namespace cutterflow;

void print_models(const std::vector<coupling::ModelNote>& models) {
    std::cout << "Models that are on:\n";
    for (const coupling::ModelNote& model : models) std::cout << "    " << model.name << "  (" << model.why << ")\n";
    std::cout << std::endl;
}

/// The feed alone does not know the domain, which ends what can be placed.
void require_feed_in_domain(const foam::CouplingDictionary& dictionary) {
    if (!dictionary.dem || dictionary.coupling.rock_feed.empty()) return;
    coupling::read_rock_feed(
        dictionary.coupling.rock_feed, [&](const Vec3& place) { return coupling::contains(dictionary.dem->domain, place); },
        dictionary.coupling.shapes);
}

/// Of the rank that writes.
std::unique_ptr<coupling::RunRecorder> make_recorder(const foam::FoamSession& session, const foam::CouplingDictionary& dictionary,
                                                     const std::vector<coupling::ModelNote>& flow, double start, int ranks) {
    auto recorder = std::make_unique<coupling::CsvRecorder>(session.case_folder(), dictionary.coupling, start, ranks);
    const auto versions = build_versions();
    std::vector<coupling::ModelNote> models = flow;
    const std::vector<coupling::ModelNote> rock = rock_models(dictionary);
    models.insert(models.end(), rock.begin(), rock.end());
    recorder->describe(models, {versions.begin(), versions.end()});
    print_models(models);
    return recorder;
}

/// On any rank: a launcher reaches one before the other. Collective
bool stop_is_asked(coupling::Communicator& communicator) {
    double asked = is_asked_to_stop() ? 1.0 : 0.0;
    communicator.max(gsl::span<double>(&asked, 1));
    return asked > 0.0;
}

/// Goes from the newest checkpoint, or the start, to the end of the run.
/// \param flow  models of the fluid \throws Interrupted  after a checkpoint, at a request to stop
void run_coupled(foam::FoamSession& session, foam::CouplingDictionary& dictionary, coupling::FluidEngine& fluid,
                 const coupling::FluidProperties& properties, const std::vector<coupling::ModelNote>& flow) {
    foam::PstreamCommunicator communicator;
    std::unique_ptr<liggghts::LiggghtsEngine> dem;
    if (dictionary.dem) {
        dictionary.dem->log = session.case_folder() / "log.liggghts";
        const auto moving = fluid.moving_zones();
        dem = std::make_unique<liggghts::LiggghtsEngine>(*dictionary.dem, std::vector(moving.begin(), moving.end()), MPI_COMM_WORLD);
    }
    std::unique_ptr<coupling::RunRecorder> recorder = std::make_unique<coupling::SilentRecorder>();
    if (communicator.rank() == 0) recorder = make_recorder(session, dictionary, flow, fluid.time(), communicator.size());

    coupling::CoupledRun coupled(dictionary.coupling, properties, fluid, dem.get(), communicator, *recorder, session.case_folder());
    const auto checkpoint = newest_checkpoint(session.case_folder());
    if (!checkpoint.empty())
        coupled.resume(checkpoint);
    else if (!dictionary.coupling.rock_start.empty())
        coupled.start_from(dictionary.coupling.rock_start);

    while (fluid.running() && !coupled.finished()) {
        coupled.step();
        if (stop_is_asked(communicator)) {
            coupled.keep();
            throw Interrupted(fmt::format("stopped on request at {:.9g} s", fluid.time()));
        }
    }
    coupled.finish();
}

/// Rock in a recorded flow. \throws UserError  on several ranks: a replay is cheap, and many of them run side by side
void replay(foam::FoamSession& session, foam::CouplingDictionary& dictionary) {
    if (foam::PstreamCommunicator().size() > 1)
        throw UserError("a replay on several ranks", "A recorded flow is played on one", "Start it without -parallel");
    const foam::CaseTimes times = foam::case_times(session.time());
    coupling::FrozenFluid fluid(coupling::read_recording(dictionary.coupling.replay), {times.start, times.end, times.write_interval});
    run_coupled(session, dictionary, fluid, dictionary.dem->fluid, recorded_flow_models(dictionary));
}

/// Rock without a medium. The time of a checkpoint is its own: there are no time folders.
void move_rock_alone(foam::FoamSession& session, foam::CouplingDictionary& dictionary) {
    if (foam::PstreamCommunicator().size() > 1)
        throw UserError("medium none on several ranks", "Rock without a medium moves on one", "Start it without -parallel");
    const foam::CaseTimes times = foam::case_times(session.time());
    const auto checkpoint = newest_checkpoint(session.case_folder());
    const double start = checkpoint.empty() ? times.start : coupling::read_state(checkpoint).time;
    coupling::NoFluid fluid({start, times.end, times.write_interval}, times.step);
    run_coupled(session, dictionary, fluid, {}, no_flow_models());
}

void solve(foam::FoamSession& session, foam::CouplingDictionary& dictionary) {
    foam::FoamFluidEngine fluid(session, dictionary.coupling.has_rock, dictionary.coupling.patches, dictionary.coupling.soil);
    run_coupled(session, dictionary, fluid, fluid.fluid_properties(), flow_models(fluid, dictionary.coupling.soil));
}

void run(int argc, char** argv) {
    foam::require_openfoam_of_build();
    foam::FoamSession session(argc, argv);
    listen_for_stop();
    foam::CouplingDictionary dictionary = foam::read_coupling_dictionary(session);
    require_feed_in_domain(dictionary);
    if (!dictionary.coupling.has_medium)
        move_rock_alone(session, dictionary);
    else if (dictionary.coupling.replay.empty())
        solve(session, dictionary);
    else
        replay(session, dictionary);
}

/// Reports why the run ends, and ends all ranks with the failure's code. Failures are thrown on every rank and told once; what OpenFOAM
/// finds in a file, a file that cannot be written, and a defect may have struck one rank alone, so that the others must be stopped.
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
    const bool on_all_ranks = failure != nullptr && dynamic_cast<const foam::CaseFileError*>(&error) == nullptr &&
                              dynamic_cast<const NotWritten*>(&error) == nullptr;
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
    } catch (const Interrupted& stop) {
        std::cout << "cutterFoam: " << stop.what() << std::endl;
        code = static_cast<int>(ExitCode::interrupted);
    } catch (const std::exception& error) {
        code = explain(error);
    }
    return code;
}
