#include "solver/foam/session/foam_session.hpp"

#include <mpi.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <string>

#include <fmt/format.h>

#include "geometry/base/checkpoint_folders.hpp"
#include "geometry/base/error.hpp"
#include "solver/foam/session/case_errors.hpp"
#include "solver/foam/session/foam_conversions.hpp"

#include "IFstream.H"
#include "IOdictionary.H"
#include "Pstream.H"
#include "Time.H"
#include "argList.H"
#include "dynamicFvMesh.H"
#include "sigFpe.H"

namespace cutterflow::foam {
namespace {

void finish_mpi() {
    int finished = 0;
    MPI_Finalized(&finished);
    if (!finished) MPI_Finalize();
}

/// OpenFOAM leaves MPI alone in serial and LIGGGHTS needs it, so it is always started here.
void start_mpi() {
    int started = 0;
    MPI_Initialized(&started);
    if (started) return;
    MPI_Init(nullptr, nullptr);
    std::atexit(finish_mpi);
}

void start_parallel_run_without_command_line() {
    start_mpi();
    int ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (ranks == 1 || Foam::UPstream::parRun()) return;
    int argc = 0;
    char** argv = nullptr;
    Foam::UPstream::init(argc, argv, false);
}

/// The arguments live to the end of the process: argList's destructor would end it.
const Foam::argList& parse_arguments(int argc, char** argv) {
    start_mpi();
    Foam::argList::addNote(
        "Transient flow and rock in a rotating cutter head: volume-averaged incompressible flow on a moving mesh, coupled with a DEM when "
        "constant/couplingProperties has a rock section.");
    auto* arguments = new Foam::argList(argc, argv);
    if (!arguments->checkRootCase()) Foam::FatalError.exit();
    return *arguments;
}

/// The name of the folder at the start, of whatever digits. OpenFOAM tries 18, 17, ... and gives up where two names are equal
/// (Time::setControls): 3.109868444137758 is 3.1098684441377582 with 18 digits and with 17.
Foam::word folder_of_start(const Foam::Time& time) {
    Foam::word name = time.timeName();
    for (const Foam::instant& folder : time.times()) {
        if (folder.name() == time.timeName()) return folder.name();
        if (folder.name() != time.constant() && folder.value() == time.startTime().value()) name = folder.name();
    }
    return name;
}

struct PreviousStep : Foam::Time {
    /// What a restart takes for the step before its first one.
    static void set(Foam::Time& time, double step) { time.*(&PreviousStep::deltaTSave_) = step; }
};

/// A directory name has few digits of the time; the exact value and time step are in uniform/time. Without them a restarted rotor
/// would have another angle than before.
void restore_exact_time(Foam::Time& time) {
    const Foam::word folder = folder_of_start(time);
    const Foam::IOdictionary saved(
        Foam::IOobject("time", folder, "uniform", time, Foam::IOobject::READ_IF_PRESENT, Foam::IOobject::NO_WRITE, false));
    Foam::string name;
    Foam::scalar value = time.startTime().value();
    if (saved.readIfPresent("name", name) && name == folder) saved.readIfPresent("value", value);
    if (folder == time.timeName() && value == time.value()) return;
    time.setTime(Foam::instant(value, folder), time.timeIndex());
    PreviousStep::set(time, time.deltaTValue());
}

std::string latest_times_to_refuse(const std::filesystem::path& case_folder) {
    Foam::IFstream stream(Foam::fileName((case_folder / "system" / "controlDict").string()));
    const Foam::dictionary control(stream);
    if (control.getOrDefault<Foam::word>("startFrom", "latestTime") != "latestTime") return {};
    std::vector<std::string> names;
    for (const std::filesystem::path& folder : times_after_checkpoint(case_folder)) names.push_back(folder.string());
    return fmt::format("{}", fmt::join(names, ", "));
}

/// A run resumes from its newest checkpoint. Its latest time must be that of the checkpoint: what lies behind it is the user's. Collective.
void require_checkpoint_is_latest(const std::filesystem::path& case_folder) {
    Foam::string later;
    if (Foam::UPstream::master()) later = latest_times_to_refuse(case_folder);
    Foam::Pstream::scatter(later);
    if (later.empty()) return;
    const std::filesystem::path newest = newest_checkpoint(case_folder);
    throw UserError(fmt::format("startFrom latestTime, and {} is later than the newest checkpoint {}", std::string(later), newest.string()),
                    "A run resumes from its newest checkpoint, and cutterFoam deletes no time folder",
                    fmt::format("Move the later folders away, or set in system/controlDict: startFrom startTime; startTime {}; (later "
                                "folders are then overwritten as the run reaches their times), or remove the folder {} to start without it",
                                newest.filename().string(), newest.parent_path().string()));
}

}  // namespace

struct FoamSession::Parts {
    std::filesystem::path case_folder;
    std::unique_ptr<Foam::Time> time;
    Foam::autoPtr<Foam::dynamicFvMesh> mesh;

    void open_mesh() {
        Foam::Info << "Create mesh for time = " << time->timeName() << Foam::nl << Foam::endl;
        mesh = Foam::dynamicFvMesh::New(Foam::IOobject(Foam::polyMesh::defaultRegion, time->timeName(), *time, Foam::IOobject::MUST_READ));
    }
};

FoamSession::FoamSession(int argc, char** argv) : parts_(std::make_unique<Parts>()) {
    const Foam::argList& arguments = parse_arguments(argc, argv);
    parts_->case_folder = to_path(arguments.rootPath() / arguments.globalCaseName());
    with_case_errors(ThrownErrors::all, [&] {
        require_checkpoint_is_latest(parts_->case_folder);
        Foam::Info << "Create time\n" << Foam::endl;
        parts_->time = std::make_unique<Foam::Time>(Foam::Time::controlDictName, arguments);
        restore_exact_time(*parts_->time);
    });
}

FoamSession::FoamSession(const std::filesystem::path& case_folder) : parts_(std::make_unique<Parts>()) {
    start_parallel_run_without_command_line();
    Foam::sigFpe::set();
    parts_->case_folder = std::filesystem::absolute(case_folder);
    const Foam::fileName root(parts_->case_folder.parent_path().string());
    Foam::fileName name(parts_->case_folder.filename().string());
    if (Foam::UPstream::parRun()) name = name / ("processor" + std::to_string(Foam::UPstream::myProcNo()));
    with_case_errors(ThrownErrors::all, [&] {
        parts_->time = std::make_unique<Foam::Time>(Foam::Time::controlDictName, root, name);
        restore_exact_time(*parts_->time);
    });
}

FoamSession::~FoamSession() {
    if (std::uncaught_exceptions() == 0) Foam::Info << "End\n" << Foam::endl;
}

Foam::Time& FoamSession::time() {
    return *parts_->time;
}
Foam::dynamicFvMesh& FoamSession::mesh() {
    if (!parts_->mesh.valid()) with_case_errors(ThrownErrors::all, [&] { parts_->open_mesh(); });
    return parts_->mesh();
}
const std::filesystem::path& FoamSession::case_folder() const {
    return parts_->case_folder;
}

}  // namespace cutterflow::foam
